"""`tidybot say` and `status`: commands to the robot and what becomes of them."""

import argparse
from collections.abc import Iterator
from pathlib import Path
from typing import get_args

from cli.errors import CliError, checked
from cli.link import Subscription, linked, robot_command
from cli.missions.audio import recorded
from cli.missions.conversation import ACCEPT, INSTEAD, KEPT, Answer, Conversation, Show, speak_into, typed
from cli.output import NewStates, show
from common import messages as m
from common import topics
from common.mission_log.states import under_way
from common.time.clock import monotonic


def say(args: argparse.Namespace) -> int:
    if (args.wav is None) == (not args.text):
        raise CliError('say what? `tidybot say "bring me the red mug"` or `tidybot say --wav FILE`')
    chunks = recorded(args.wav) if args.wav else []
    said = ""
    with linked(args) as link:
        talk = Conversation(link, _shower(args))
        if talk.state.state == "CONFIRMING":
            mission_id, why = talk.answer(" ".join(args.text), chunks), ""
        elif args.wav:
            talk.require_open()
            mission_id, why = speak_into(link, talk, chunks)
        else:
            text, why = " ".join(args.text), talk.closed()
            answer = Answer(link, talk) if why else None
            link.send(topics.VOICE_COMMAND, typed(text, "cli"))
            # While it still reports on the last mission it keeps the command for after that.
            mission_id = talk.accepted(ACCEPT, answer.given) if answer else talk.accepted(KEPT)
            if answer and answer.text:
                said, mission_id = answer.text, mission_id or talk.accepted(INSTEAD)
            why = "" if mission_id or said else why or "the brain started no mission from it"
        record: dict[str, object] = {"accepted": bool(mission_id or said), "mission_id": mission_id}
        if said:
            record["said"] = said
        if not (mission_id or said):
            record["reason"] = why
        outcome = talk.outcome(args.timeout) if mission_id and args.wait else None
    if outcome is not None:
        record |= {"outcome": outcome.outcome, "reason": outcome.reason}
    show(args, record, _told(said, mission_id, why, outcome))
    if not (mission_id or said) or (outcome is not None and outcome.outcome != "delivered"):
        return 1
    return 0


def _told(said: str, mission_id: str, why: str, outcome: m.MissionOutcome | None) -> Iterator[str]:
    if said:
        yield said
    if outcome is not None:
        yield f"{outcome.outcome}{': ' + outcome.reason if outcome.reason else ''}"
    elif mission_id:
        yield f"mission {mission_id}"
    elif not said:
        yield f"not accepted: {why}"


def _shower(args: argparse.Namespace) -> Show:
    """Print every new state while waiting, unless only JSON is wanted."""
    states = NewStates()

    def show(state: m.BrainState) -> None:
        if args.wait and not args.json and (line := states.line(state)):
            print(line, flush=True)

    return show


def status_record(state: m.BrainState, system: m.SystemStatus | None) -> dict[str, object]:
    """What `tidybot status --json` prints."""
    mission: dict[str, object] | None = None
    if state.command and under_way(state):
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
        watch, system = Subscription(link, topics.BRAIN_STATE), Subscription(link, topics.SYSTEM_STATUS)
        state = watch.first()
        end = monotonic() + args.timeout
        while wanted and monotonic() < end:
            folded = system.next(0.0)
            if state.state == wanted or (folded is not None and folded.state == wanted):
                reached = True
                break
            state = watch.next(0.2) or state
        folded = link.latest(topics.SYSTEM_STATUS)
    record = status_record(state, folded)
    show(args, record, _status_told(record))
    if not reached:
        raise CliError(f"not {wanted} within {args.timeout:g} s")
    return 0


def _status_told(record: dict[str, object]) -> Iterator[str]:
    detail = f"  {record['detail']}" if record["detail"] else ""
    yield f"state    {record['state']}{detail}"
    for word, key in (("mission", "step"), ("last", "outcome")):
        value = record[word]
        if isinstance(value, dict):
            more = f" ({value['reason']})" if value.get("reason") else ""
            yield (f"{word:8} {value['id']}: {value['command']}: {value[key] or 'begins'}{more}")


def register(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = robot_command(commands, say, "command the robot by text, or by a recording", json=True)
    parser.add_argument("text", nargs="*", help="such as: bring me the red mug")
    parser.add_argument("--wav", type=Path, metavar="FILE", help="a recording to send instead of a microphone's sound")
    parser.add_argument("--wait", action="store_true", help="until the mission ends; exit 0 only if it succeeded")
    parser.add_argument("--timeout", type=float, default=1800.0, metavar="S", help="for --wait (default %(default)s)")
    parser = robot_command(commands, status, "what the robot is doing, and how the last mission ended", json=True)
    parser.add_argument("--wait", metavar="STATE", help="until the brain, or system_status, is in this state")
    parser.add_argument("--timeout", type=float, default=600.0, metavar="S", help="for --wait (default %(default)s)")
