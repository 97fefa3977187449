"""`tidybot say` and `status`: commands to the robot and what becomes of them."""

import argparse
import uuid
from collections.abc import Callable
from pathlib import Path
from typing import get_args

import msgspec

from cli.audio import Player, padded, read_wav
from cli.errors import CliError, checked
from cli.link import Link, Watch, add_options, linked
from common import messages as m
from common import topics
from common.time.clock import monotonic

OPEN = ("WAITING", "LISTENING", "COMPLETED", "ERROR")
ACCEPT, KEPT, HEAR, LISTEN = 5.0, 30.0, 60.0, 90.0
"""Times [s] for a busy brain to refuse a command, for a free one to take it up, for sound to be understood, and until
the robot listens."""
Show = Callable[[m.BrainState], None]


class Conversation:
    """One command given to the brain and followed to its end."""

    def __init__(self, link: Link, show: Show = lambda state: None) -> None:
        self._link, self._show = link, show
        self._watch = Watch(link, topics.BRAIN_STATE)
        first = self._watch.next(3.0)
        if first is None:
            raise CliError("the brain does not answer; see `tidybot ps`")
        self.state = first
        show(first)
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
        """Raises:
        CliError: the robot takes no command now.
        """
        why = self.closed()
        if why:
            raise CliError(f"{why}; wait with `tidybot status --wait WAITING`, or end it with `tidybot say cancel`")

    def await_open(self, timeout: float = LISTEN) -> None:
        """Return when the robot takes a command.

        Raises:
            CliError: it does not in time.
        """
        end = monotonic() + timeout
        while why := self.closed():
            if monotonic() > end:
                raise CliError(f"after {timeout:.0f} s still: {why}")
            self._next(0.2)

    def closed(self) -> str:
        """Why the robot takes no command now; "" when it does."""
        if self.state.state in OPEN:
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

    def outcome(self, timeout: float, idle: Callable[[], None] = lambda: None) -> m.MissionOutcome:
        """How the accepted mission ended.

        Raises:
            CliError: not within `timeout` seconds, or another mission took its place.
        """
        end = monotonic() + timeout
        while True:
            last = self.state.last
            if last is not None and last.id == self.mission_id:
                return last
            if monotonic() > end:
                raise CliError(f"no outcome after {timeout:.0f} s; the robot is {self.state.state}")
            if self.state.mission_id not in ("", self.mission_id):
                raise CliError(f"mission {self.state.mission_id} took the place of {self.mission_id}")
            self._next(0.2)
            idle()


def typed(text: str, source: str) -> m.VoiceCommand:
    """A command in written words, which nobody can have misheard."""
    return m.VoiceCommand(text=text, id=f"{source}-{uuid.uuid4().hex[:8]}", confirmed=True)


def speak_into(link: Link, talk: Conversation, chunks: list[bytes]) -> tuple[str, str]:
    """Say it to the robot, as with a push-to-talk button: (mission id or "", why not).

    Raises:
        CliError: the speech service is not there, or the robot stays busy.
    """
    heard, status = Watch(link, topics.SPEECH_RESULT), Watch(link, topics.SPEECH_STATUS)
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


def say(args: argparse.Namespace) -> int:
    if (args.wav is None) == (not args.text):
        raise CliError('say what? `tidybot say "bring me the red mug"` or `tidybot say --wav FILE`')
    chunks = padded(read_wav(args.wav)) if args.wav else []
    with linked(args) as link:
        talk = Conversation(link, _shower(args))
        if talk.state.state == "CONFIRMING":
            mission_id, why = talk.answer(" ".join(args.text), chunks), ""
        elif args.wav:
            talk.require_open()
            mission_id, why = speak_into(link, talk, chunks)
        else:
            text = " ".join(args.text)
            link.send(topics.VOICE_COMMAND, typed(text, "cli"))
            why = talk.closed()
            # While it still reports on the last mission it keeps the command for after that.
            mission_id = talk.accepted(ACCEPT if why else KEPT)
            why = "" if mission_id else why or "the brain started no mission from it"
        record: dict[str, object] = {"accepted": bool(mission_id), "mission_id": mission_id}
        if not mission_id:
            record["reason"] = why
        outcome = talk.outcome(args.timeout) if mission_id and args.wait else None
    if outcome is not None:
        record |= {"outcome": outcome.outcome, "reason": outcome.reason}
    if args.json:
        print(msgspec.json.encode(record).decode())
    elif outcome is not None:
        print(f"{outcome.outcome}{': ' + outcome.reason if outcome.reason else ''}")
    else:
        print(f"mission {mission_id}" if mission_id else f"not accepted: {why}")
    if not mission_id or (outcome is not None and outcome.outcome != "delivered"):
        return 1
    return 0


def _shower(args: argparse.Namespace) -> Show:
    """Print every new state while waiting, unless only JSON is wanted."""
    shown = ""

    def show(state: m.BrainState) -> None:
        nonlocal shown
        line = f"{state.state}  {state.step}  {state.detail}".rstrip()
        if args.wait and not args.json and line != shown:
            shown = line
            print(f"{state.t:8.1f} s  {line}", flush=True)

    return show


def status_record(state: m.BrainState, system: m.SystemStatus | None) -> dict[str, object]:
    """What `tidybot status --json` prints."""
    mission: dict[str, object] | None = None
    ended = state.last.id if state.last else ""
    if state.command and state.mission_id not in ("", ended):
        mission = {"id": state.mission_id, "command": state.command, "step": state.step, "started": state.started}
    last: dict[str, object] | None = None
    if state.last is not None:
        one = state.last
        last = {"id": one.id, "command": one.command, "outcome": one.outcome, "reason": one.reason}
    name = system.state if system else ""
    return {"state": state.state, "system_status": name, "mission": mission, "last": last, "detail": state.detail}


def status(args: argparse.Namespace) -> int:
    wanted = args.wait.upper() if args.wait else ""
    if wanted:
        checked(wanted, (*get_args(m.BrainStateName), "EXECUTING", "SUCCESS"), "state")
    reached = not wanted
    with linked(args) as link:
        watch, system = Watch(link, topics.BRAIN_STATE), Watch(link, topics.SYSTEM_STATUS)
        state = watch.next(3.0)
        if state is None:
            raise CliError("the brain does not answer; see `tidybot ps`")
        end = monotonic() + args.timeout
        while wanted and monotonic() < end:
            folded = system.next(0.0)
            if state.state == wanted or (folded is not None and folded.state == wanted):
                reached = True
                break
            state = watch.next(0.2) or state
        folded = link.latest(topics.SYSTEM_STATUS)
    record = status_record(state, folded)
    if args.json:
        print(msgspec.json.encode(record).decode())
    else:
        _print_status(record)
    if not reached:
        raise CliError(f"not {wanted} within {args.timeout:g} s")
    return 0


def _print_status(record: dict[str, object]) -> None:
    detail = f"  {record['detail']}" if record["detail"] else ""
    print(f"state    {record['state']} ({record['system_status'] or 'no system status'}){detail}")
    for word in ("mission", "last"):
        value = record[word]
        if isinstance(value, dict):
            print(f"{word:8} " + "  ".join(f"{k}: {v}" for k, v in value.items() if v != ""))


def register(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = commands.add_parser("say", help="command the robot by text, or by a recording")
    parser.add_argument("text", nargs="*", help="such as: bring me the red mug")
    parser.add_argument("--wav", type=Path, metavar="FILE", help="a recording to send instead of a microphone's sound")
    parser.add_argument("--wait", action="store_true", help="until the mission ends; exit 0 only if it succeeded")
    parser.add_argument("--timeout", type=float, default=1800.0, metavar="S", help="for --wait (default %(default)s)")
    parser.add_argument("--json", action="store_true")
    add_options(parser)
    parser.set_defaults(run=say)
    parser = commands.add_parser("status", help="what the robot is doing, and how the last mission ended")
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--wait", metavar="STATE", help="until the brain, or system_status, is in this state")
    parser.add_argument("--timeout", type=float, default=600.0, metavar="S", help="for --wait (default %(default)s)")
    add_options(parser)
    parser.set_defaults(run=status)
