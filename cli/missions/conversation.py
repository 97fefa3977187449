"""One command given to the brain, by text or sound, and followed to its end."""

import uuid
from collections.abc import Callable

from cli.errors import CliError
from cli.link import FIRST, Link, Subscription
from cli.missions.audio import Player
from common import messages as m
from common import topics
from common.time.clock import monotonic

ACCEPT, KEPT, HEAR, LISTEN = 12.0, 30.0, 60.0, 90.0
"""Times [s] for a busy brain to answer (a question is given up after 10 s), for a free one to take a command up, for
sound to be understood, and until the robot listens."""
INSTEAD = 2.0
"""Time [s] for a mission to begin that takes another one's place, after that was said."""
Show = Callable[[m.BrainState], None]


class Conversation:
    """One command given to the brain and followed to its end."""

    def __init__(self, link: Link, show: Show = lambda state: None) -> None:
        self._link, self._show = link, show
        self._watch = Subscription(link, topics.BRAIN_STATE)
        self.state = first = self._watch.first()
        self._before = {first.mission_id, first.last.id if first.last else ""}
        self.mission_id = ""

    def _next(self, timeout: float) -> m.BrainState | None:
        state = self._watch.next(timeout)
        if state is not None:
            self.state = state
            self._show(state)
        return state

    def refresh(self) -> None:
        """Take the next state, if one comes soon."""
        self._next(0.2)

    def require_open(self) -> None:
        """Check that the robot takes a command now.

        Raises:
            CliError: it does not.
        """
        why = self.closed()
        if why:
            raise CliError(f"{why}; wait with `tidybot status --wait WAITING`, or end it with `tidybot say cancel`")

    def await_open(self) -> None:
        """Return when the robot takes a command.

        Raises:
            CliError: it does not in time.
        """
        end = monotonic() + LISTEN
        while why := self.closed():
            if monotonic() > end:
                raise CliError(f"after {LISTEN:.0f} s still: {why}")
            self._next(0.2)

    def closed(self) -> str:
        """Why the robot takes no command now; "" when it does."""
        if self.state.state in m.OPEN_STATES:
            return ""
        if self.state.state == "IDLE":
            return f"the robot is not ready: {self.state.detail or 'IDLE'}"
        return f"the robot is busy: {self.state.state} for {self.state.command!r}"

    def accepted(self, patience: float, refused: Callable[[], str] = lambda: "") -> str:
        """The id of the mission that the command started; "" when none did in `patience` seconds."""
        end = monotonic() + patience
        while monotonic() < end and not refused():
            state = self._next(0.2)
            if state is None:
                continue
            ended = state.last.id if state.last else ""
            for found in (state.mission_id if state.command else "", ended):
                if found and found not in self._before:
                    self.mission_id = found
                    return found
        return ""

    def answer(self, text: str, chunks: list[bytes]) -> str:
        """Answer the robot's question, in writing or aloud; the id of the mission that it asked for."""
        self.mission_id = self.state.mission_id
        if chunks:
            Player(self._link, chunks).play()
        else:
            self._link.send(topics.SPEECH_TEXT, m.TypedText(text=text))
        return self.mission_id

    def ended(self) -> m.MissionOutcome | None:
        """How the accepted mission ended, None while it is under way.

        Raises:
            CliError: another mission took its place.
        """
        last = self.state.last
        if last is not None and last.id == self.mission_id:
            return last
        if self.state.mission_id not in ("", self.mission_id):
            raise CliError(f"mission {self.state.mission_id} took the place of {self.mission_id}")
        return None

    def outcome(self, timeout: float, idle: Callable[[], None] = lambda: None) -> m.MissionOutcome:
        """How the accepted mission ended.

        Raises:
            CliError: not within `timeout` seconds, or another mission took its place.
        """
        end = monotonic() + timeout
        while True:
            ended = self.ended()
            if ended is not None:
                return ended
            if monotonic() > end:
                raise CliError(f"no outcome after {timeout:.0f} s; the robot is {self.state.state}")
            self.refresh()
            idle()


class Answer:
    """What a robot at work says to what is said to it, or that its mission has ended because of that."""

    def __init__(self, link: Link, talk: Conversation) -> None:
        self._talk, self._under_way = talk, talk.state.mission_id
        self._goals = Subscription(link, topics.SPEECH_GOAL)
        self._goals.next(FIRST)
        self.text = ""

    def given(self) -> str:
        """The answer so far; "" before there is one."""
        goal, last = self._goals.next(0.0), self._talk.state.last
        if goal is not None and goal.goal.startswith("say "):
            self.text = f"robot: {goal.goal[4:]}"
        elif last is not None and last.id == self._under_way:
            self.text = f"{last.outcome}: {last.command}"
        return self.text


def typed(text: str, source: str) -> m.VoiceCommand:
    """A command in written words, which nobody can have misheard."""
    return m.VoiceCommand(text=text, id=f"{source}-{uuid.uuid4().hex[:8]}", confirmed=True)


def speak_into(link: Link, talk: Conversation, chunks: list[bytes]) -> tuple[str, str]:
    """Say it to the robot, as with a push-to-talk button: (mission id or "", why not).

    Raises:
        CliError: the speech service is not there, or the robot stays busy.
    """
    heard, status = Subscription(link, topics.SPEECH_RESULT), Subscription(link, topics.SPEECH_STATUS)
    heard.next(0.3)  # the result of an earlier utterance
    if status.next(1.0) is None and "speech" not in link.alive():
        raise CliError("the speech service is not there; see `tidybot ps`")
    talk.await_open()
    Player(link, chunks).play()
    why = ""

    def refused() -> str:
        nonlocal why
        result, now = heard.next(0.0), status.next(0.0)
        if result is not None and result.text == "ERROR":
            why = f"not understood: {result.code} {result.detail}".strip()
        elif now is not None and now.code:
            why = f"not understood: {now.code} {now.detail}".strip()
        return why

    found = talk.accepted(HEAR, refused)
    return found, why or ("" if found else "nothing was heard")
