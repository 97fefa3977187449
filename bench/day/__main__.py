"""A long day in one home: `python -m bench.day --hours 12 --missions 100`.

A home of the generator with boxes that its map does not have and people who walk about, every service a process. Things
are fetched, put elsewhere and asked for all day, by somebody who answers the robot's questions. Three services are
killed in mid-mission, and once the power goes: every process at once, and the robot is switched on where it stands. At
the start a room is named and a rule is told. At the end every mission that was accepted must be in the journal with an
outcome, what was told must still be known, no claim may be false, and neither memory nor files may have grown beyond
their bounds. Exit 1 otherwise.
"""

import argparse
import math
import random
import sys
import tempfile
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from bench.day.account import Account
from bench.day.robot import Robot
from cli.errors import CliError
from cli.link import Link
from common import messages as m
from common import topics
from common.bus.session import open_session
from common.scene import Scene
from common.time.clock import monotonic, sleep
from evaluation.homes.aged import aged
from evaluation.homes.suite import homes
from evaluation.person.dialogue import choice

PATIENCE, WALL = 900.0, 3600.0
"""Robot time and wall time [s] for one mission, whichever is over first."""
KILLED = ("navigation", "perception", "brain")
INTO = 8.0
"""Robot time [s] into a mission at which somebody is killed, or the power goes."""
ANSWER = 20.0
"""Wall time [s] within which the brain says whether it has kept what it was told."""
OPEN = ("WAITING", "LISTENING", "COMPLETED", "ERROR")
TOLD = (
    m.HouseholdEdit(do="name", name="den", kind="room", id="day-1"),
    m.HouseholdEdit(do="rule", id="day-2"),
)


class Day:
    """Runs one mission after the other and keeps the account."""

    def __init__(self, robot: Robot, world: Scene, seed: int) -> None:
        self.robot, self.world, self.account = robot, world, Account()
        self._draw = random.Random(seed)
        self._session: Any = None
        self._now = 0.0
        self._answered = ""
        self.connect()

    def connect(self) -> None:
        if self._session is not None:
            self._session.__exit__(None, None, None)
        self._session = open_session(self.robot.connect, self.robot.namespace)
        self.link = Link(self._session.__enter__(), self.robot.connect)

    def close(self) -> None:
        self._session.__exit__(None, None, None)

    @property
    def now(self) -> float:
        """Robot time [s], as it was last heard: a simulation that starts again, or is busy, does not answer."""
        joints = self.link.latest(topics.JOINT_STATES)
        self._now = joints.t if joints is not None else self._now
        return self._now

    def state(self) -> m.BrainState:
        return self.link.latest(topics.BRAIN_STATE) or m.BrainState(state="IDLE")

    def where(self, thing: str) -> str:
        place: str = self.link.query(topics.SIM_TRUTH)["objects"][thing]["on"]
        return place

    # --- at the start
    def tell(self) -> list[str]:
        """Name a room and tell a tidying rule; returns what the robot did not keep."""
        to = next(r.name for r in self.world.receptacles if r.spawn and not r.depth)
        rule = m.TidyRule(things="mugs", to=[to], kinds=["mug"])
        wrong = []
        for edit in TOLD:
            asked = msgspec.structs.replace(edit, rule=rule if edit.do == "rule" else None)
            result = self.link.ask(topics.HOUSEHOLD_EDIT, asked, topics.HOUSEHOLD_EDITED, ANSWER, "the brain")
            if not result.ok:
                wrong.append(f"{edit.do}: {result.detail}")
        return wrong

    # --- missions
    def mission(self, number: int, disturb: str) -> None:
        """One command from its words to the outcome; `disturb`: who is killed in the middle, "power" for all."""
        thing, command, goal = self._command()
        known = {*self.account.ids}
        before = self.state().last
        began = self.now
        said = m.VoiceCommand(text=command, confidence=1.0, confirmed=True, id=f"day-{number}")
        self.link.send(topics.VOICE_COMMAND, said)
        mission, outcome, end = "", None, monotonic() + WALL
        while outcome is None and monotonic() < end and self.now < began + PATIENCE:
            sleep(0.5)
            state = self.state()
            if state.state == "CONFIRMING" and state.command == command:
                self.answer(thing, state)
            if not mission and state.command == command and state.mission_id not in known:
                mission = state.mission_id
                self.account.ids[mission] = command
            if disturb and mission and self.now - began > INTO:
                self._disturb(disturb)
                disturb = ""
            last = state.last
            if (
                last is not None
                and last != before
                and (last.id == mission or (not mission and last.command == command))
            ):
                self.account.ids[last.id] = command
                outcome = last
        name = outcome.outcome if outcome else "timeout" if mission else "unheard"
        self.account.unheard += name == "unheard"
        self.account.outcomes[name] = self.account.outcomes.get(name, 0) + 1
        why = f": {outcome.reason}" if outcome is not None and outcome.outcome != "delivered" else ""
        if name == "delivered" and goal and self.where(thing) != goal:
            self.account.false.append(f"{command}: it is on {self.where(thing) or 'the floor'}")
        self.await_open()
        self.account.memory.append(self.robot.memory())
        self.account.disk.append(self.robot.disk())
        print(f"{self.now / 60:7.1f} min  {number:4d}  {command}: {name}{why}", flush=True)

    def answer(self, thing: str, state: m.BrainState) -> None:
        """Answer the robot's question once, as somebody who wants the thing does."""
        speech = self.link.latest(topics.SPEECH_STATUS)
        if speech is None or speech.state != "listening" or speech.goal_id == self._answered:
            return
        self._answered, words = speech.goal_id, f"the {thing}"
        if state.offered:
            objects = self.link.query(topics.SIM_TRUTH)["objects"]
            where = {name: o["position"] for name, o in objects.items()}
            words = choice(thing, [min(where, key=lambda name: math.dist(where[name], p)) for p in state.offered])
        self.link.send(topics.SPEECH_TEXT, m.TypedText(text=words))

    def _command(self) -> tuple[str, str, str]:
        """A thing, what is asked of it, and where it has to be afterwards: "" for a question."""
        thing = self._draw.choice(self.world.objects).name
        on = self.where(thing)
        if self._draw.random() < 0.15:
            return thing, self._draw.choice(("where is the {}", "where did you last see the {}")).format(thing), ""
        if on != self.world.delivery:
            return thing, f"bring me the {thing}", self.world.delivery
        flat = [r.name for r in self.world.receptacles if r.spawn and not r.depth and r.name != on]
        goal = self._draw.choice(flat)
        return thing, f"put the {thing} on the {goal}", goal

    def _disturb(self, who: str) -> None:
        self.account.disturbed.append(who)
        print(f"{self.now / 60:7.1f} min        {'power cut' if who == 'power' else f'SIGKILL to {who}'}", flush=True)
        if who != "power":
            self.robot.kill(who)
            return
        self.robot.power_cut()
        self.robot.up()
        self.connect()

    def await_open(self) -> None:
        """Return when the robot takes commands."""
        end = monotonic() + 120.0
        while self.state().state not in OPEN and monotonic() < end:
            sleep(0.5)

    def rest(self, until: float) -> None:
        """Let robot time pass until `until` [s], with nothing asked."""
        while self.now < until:
            sleep(1.0)

    # --- at the end
    def faults(self) -> list[str]:
        """What failed in the day, in words."""
        wrong = [f"false claim: {claim}" for claim in self.account.false]
        rows = self.link.query(topics.BRAIN_MISSIONS)
        kept = {row["id"]: row["outcome"] for row in rows}
        lost = [i for i in self.account.ids if i not in kept]
        wrong += [f"mission {i} ({self.account.ids[i]}) is not in the journal" for i in lost]
        wrong += [f"mission {i} has no outcome" for i in self.account.ids if i in kept and not kept[i]]
        wrong += [f"{self.account.unheard} commands were not taken"] if self.account.unheard else []
        edits = self.link.latest(topics.HOUSEHOLD_EDITS) or m.HouseholdEdits()
        if [n.name for n in edits.names] != ["den"] or [r.things for r in edits.rules] != ["mugs"]:
            wrong.append(f"of what was told there is left: {edits}")
        if not (self.link.latest(topics.SIGHTINGS) or m.Sightings(t=0.0)).sightings:
            wrong.append("nothing is known of what was seen where")
        return wrong + self.account.left_out() + self.account.excess()


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--hours", type=float, default=12.0, help="of robot time, over which the missions are spread")
    parser.add_argument("--missions", type=int, default=100)
    parser.add_argument("--seed", type=int, default=12700, help="of the home, its things and the commands")
    parser.add_argument("--speed", default="max", help="max or realtime (default %(default)s)")
    args = parser.parse_args()
    home = homes(args.seed).scene
    assert home is not None
    world = aged(home, np.random.default_rng([args.seed, 26]))
    at = {max(1, round(args.missions * share)): who for share, who in zip((0.2, 0.4, 0.8), KILLED, strict=True)}
    at[max(2, round(args.missions * 0.6))] = "power"
    with tempfile.TemporaryDirectory(prefix="tidybot-day-") as directory:
        robot = Robot(Path(directory), world, home, args.seed, args.speed)
        try:
            robot.up()
            day = Day(robot, world, args.seed)
            day.account.planned = args.missions
            day.await_open()
            wrong = day.tell()
            for number in range(1, args.missions + 1):
                day.mission(number, at.get(number, ""))
                if day.now > args.hours * 3600:
                    break
                day.rest(number / args.missions * args.hours * 3600)
            wrong += day.faults()
            print(*day.account.lines(day.now), sep="\n")
            day.close()
        except CliError as error:
            wrong = [str(error)]
        finally:
            robot.down()
    print("everything is accounted for" if not wrong else "wrong:", *wrong, sep="\n  ")
    return int(bool(wrong))


if __name__ == "__main__":
    sys.exit(main())
