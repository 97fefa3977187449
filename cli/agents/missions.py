"""An agent's commands: given like a person's, and followed to their end without blocking the server."""

import argparse
import uuid
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from functools import partial
from typing import Literal, TypedDict, TypeVar

from anyio.to_thread import run_sync

from cli.errors import CliError
from cli.link import Link, linked
from cli.missions.conversation import KEPT, Conversation
from cli.output import state_line
from common import messages as m
from common import topics
from common.mission_log.states import under_way
from common.time.clock import monotonic

T = TypeVar("T")
Progress = Callable[[str], Awaitable[None]]
LONGEST = 200
"""Characters of a phrase or sentence; chosen: longer than any that the planner understands."""


class Mission(TypedDict):
    """State of a command: `delivered`; `asking`: the robot waits for an answer to `text`; `under_way` after the wait.

    `text`: what was done, the answer, or the question.
    """

    mission_id: str
    command: str
    outcome: Literal["delivered", "asking", "under_way"]
    text: str


class Missions:
    """Gives one agent's commands to the robot that `args` name, one at a time.

    Args:
        name: whose certificate is shown where there are keys.
        confirmed: commands count as confirmed, like those a person types; else the robot asks a person about each.
    """

    def __init__(self, args: argparse.Namespace, name: str, confirmed: bool) -> None:
        self._args, self._name, self.confirmed = args, name, confirmed

    @asynccontextmanager
    async def link(self) -> AsyncIterator[Link]:
        """Open a link for one call: the robot may come, go and change its address while the server runs.

        Raises:
            BusError: no router, or no certificate.
        """
        opened = linked(self._args, name=self._name)
        link = await run_sync(opened.__enter__)
        try:
            yield link
        finally:
            opened.__exit__(None, None, None)

    async def ask(self, work: Callable[[Link], T]) -> T:
        """Run `work` on the bus, in a thread, and return its result."""
        async with self.link() as link:
            return await run_sync(partial(work, link))

    async def command(self, text: str, wait: float, progress: Progress, question: bool = False) -> Mission:
        """Give a command, or put a `question` to the person, and wait at most `wait` seconds for its end.

        Raises:
            CliError: the robot is busy, takes it for no command, or failed; with the reason.
        """
        async with self.link() as link:
            talk = await run_sync(Conversation, link)
            if why := talk.closed():
                raise CliError(f"{why}; `wait` follows it to its end, `cancel` ends it")
            self._send(link, text, question)
            if not await run_sync(talk.accepted, KEPT):
                raise CliError("the brain started no mission from it; `status` tells how it stands")
            return await self._followed(talk, wait, progress, expected=question)

    async def answer(self, text: str, wait: float, progress: Progress) -> Mission:
        """Answer the robot's question, and go on waiting for the mission.

        Raises:
            CliError: it asks nothing, or the mission failed.
        """
        async with self.link() as link:
            talk = await run_sync(Conversation, link)
            if talk.state.state != "CONFIRMING":
                raise CliError(f"the robot asks nothing; it is {talk.state.state}")
            talk.mission_id = talk.state.mission_id
            self._send(link, text)
            return await self._followed(talk, wait, progress, answered=talk.state.step)

    async def wait(self, seconds: float, progress: Progress) -> Mission:
        """Follow the mission under way, or tell how the last one ended.

        Raises:
            CliError: there has been none, or it failed.
        """
        async with self.link() as link:
            talk = await run_sync(Conversation, link)
            state = talk.state
            talk.mission_id = state.mission_id if state.command else state.last.id if state.last else ""
            if not talk.mission_id:
                raise CliError("there has been no mission yet")
            return await self._followed(talk, seconds, progress)

    async def cancel(self) -> str:
        """End the mission under way; the robot stands still then, and its brake stays open."""
        async with self.link() as link:
            talk = await run_sync(Conversation, link)
            if not (talk.state.command and under_way(talk.state)):
                return "no mission is under way"
            talk.mission_id = talk.state.mission_id
            self._send(link, "cancel")
            ended = await run_sync(talk.outcome, KEPT)
            return f"{ended.command!r} is {ended.outcome}: {ended.reason}"

    def _send(self, link: Link, text: str, question: bool = False) -> None:
        name = f"agent-{uuid.uuid4().hex[:8]}"
        link.send(
            topics.VOICE_COMMAND,
            m.VoiceCommand(text=text, id=name, confirmed=self.confirmed or question, question=question),
        )

    async def _followed(
        self, talk: Conversation, wait: float, progress: Progress, answered: str = "", expected: bool = False
    ) -> Mission:
        """Follow a mission, each new state to `progress`. Being cancelled ends the waiting, never the mission.

        Args:
            answered: the question that has been answered already and may still be shown.
            expected: it is the person whom the robot asks, so a question is no reason to return.
        """
        end, shown = monotonic() + wait, ""
        while (ended := talk.ended()) is None:
            state = talk.state
            answered = answered if state.state == "CONFIRMING" and state.step == answered else ""
            if state.state == "CONFIRMING" and self.confirmed and not expected and not answered:
                return self._mission(talk, "asking", state.step)
            if (line := state_line(state)) != shown:
                shown = line
                await progress(line.strip())
            if monotonic() > end:
                return self._mission(talk, "under_way", line.strip())
            await run_sync(talk.refresh)
        if ended.outcome != "delivered":
            raise CliError(f"{ended.outcome}: {ended.reason} (mission {ended.id}; `explain` tells how it came about)")
        return Mission(mission_id=ended.id, command=ended.command, outcome="delivered", text=ended.reason)

    @staticmethod
    def _mission(talk: Conversation, outcome: Literal["asking", "under_way"], text: str) -> Mission:
        return Mission(mission_id=talk.mission_id, command=talk.state.command, outcome=outcome, text=text)


def sentence(text: str, what: str) -> str:
    """A text reduced to one line of printable words.

    Raises:
        CliError: empty, too long or not text.
    """
    words = " ".join(text.split())
    if not words or len(words) > LONGEST or not words.isprintable():
        raise CliError(f"{what}: expected 1 to {LONGEST} printable characters, got {text[:40]!r}")
    return words


def phrase(text: str, what: str) -> str:
    """A noun phrase without its article, as "the {phrase}" takes it.

    Raises:
        CliError: as of `sentence`.
    """
    words = sentence(text, what).rstrip(".!?")
    first, _, rest = words.partition(" ")
    return rest if rest and first.lower() in ("the", "a", "an") else words
