"""An hour of the robot's life: `python -m bench.soak --hours 1`.

Every service in one process, in lockstep: things are fetched to the tray and put back where they stood, one after
the other, and each mission is judged as the evaluation judges. Resident memory is read every five minutes of robot
time. Exit status 1 when memory grew by more than 2 % after the first ten minutes, or when a claim was false.
"""

import argparse
import gc
import itertools
import sys
import time

import psutil

from common import messages as m
from common import topics
from evaluation.stack import Stack
from evaluation.statistics import share
from evaluation.watch import Watch
from judge.claims import false_claims
from judge.evidence import Want
from judge.goal import Goal
from judge.observer import WATCH
from judge.verdict import objections

PATIENCE = 400.0
"""Robot time [s] for one mission."""
SAMPLE = 0.2
"""Robot time [s] in which a fresh judge sees the world before the next command: four samples at 20 Hz."""
SETTLED, EVERY = 600.0, 300.0
"""Robot time [s] from which memory is compared, and between two looks at it."""
GROWTH = 0.02
"""Growth of memory that passes, as a share."""
THINGS = ("red mug", "green can", "blue block", "apple", "white box", "blue bottle")


def resident_mb() -> float:
    return float(psutil.Process().memory_info().rss / 1e6)


def on(stack: Stack, thing: str) -> str:
    place: str = stack.truth()["objects"][thing]["on"]
    return place


class Life:
    """Missions one after the other, and what memory they leave behind."""

    def __init__(self, seed: int) -> None:
        self.stack = Stack(seed=seed, settings=("brain.pipeline=vla",))
        self._watch: Watch = self.stack.join(Watch)
        self.told: dict[str, int] = {}
        self.flawless = self.false = 0
        self.memory: list[tuple[float, float]] = []
        self._began = time.monotonic()

    def ask(self, command: str, thing: str, goal: str) -> None:
        """One mission from the words to the report."""
        stack, observer, wanted = self.stack, self._watch.renew(), Goal((Want(thing, (goal,)),))
        stack.advance(SAMPLE)
        observer.begin()
        observer.expect(wanted)
        before = stack.state().last
        stack.bus.send(topics.VOICE_COMMAND, m.VoiceCommand(text=command, confidence=1.0, confirmed=True))
        end = stack.now + PATIENCE
        while stack.now < end:
            stack.advance(1.0)
            self._weigh()
            state = stack.state()
            if state.last is not None and state.last != before and state.state in ("WAITING", "LISTENING"):
                break
        last = stack.state().last
        ended = last if last != before else None
        outcome = ended.outcome if ended else "timeout"
        self.told[outcome] = self.told.get(outcome, 0) + 1
        if outcome != "delivered":
            print(f"  {command}: {outcome}{f', {ended.reason}' if ended else ''}", flush=True)
        stack.advance(WATCH)
        against = objections(observer.conclude(wanted), observer.claims)
        self.false += false_claims(observer.claims)
        self.flawless += not against
        if outcome == "delivered" and against:
            print(f"  {command}: reported delivered, but {'; '.join(against)}", flush=True)

    def _weigh(self) -> None:
        if not self.memory or self.stack.now - self.memory[-1][0] >= EVERY:
            gc.collect()
            self.memory.append((self.stack.now, resident_mb()))
            wall = time.monotonic() - self._began
            missions = sum(self.told.values())
            t, mb = self.memory[-1]
            print(
                f"{t / 60:7.0f} min  {missions:4d} missions  {mb:8.1f} MB  {t / max(wall, 1e-9):5.1f} x real time",
                flush=True,
            )


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--hours", type=float, default=1.0, help="of robot time (default 1)")
    parser.add_argument("--seed", type=int, default=0)
    args = parser.parse_args()
    life = Life(args.seed)
    life.stack.advance(1.0)
    for thing in itertools.cycle(THINGS):
        home = on(life.stack, thing)
        life.ask(f"bring me the {thing}", thing, life.stack.scene.delivery)
        if home and home != life.stack.scene.delivery:
            life.ask(f"put the {thing} on the {home}", thing, home)
        if life.stack.now > args.hours * 3600:
            break
    settled = next((mb for t, mb in life.memory if t >= SETTLED), life.memory[-1][1])
    growth = life.memory[-1][1] / settled - 1
    missions = sum(life.told.values())
    print(f"missions {life.told}, flawless {share(life.flawless, missions)}, false claims {life.false}")
    print(f"memory after ten minutes {settled:.1f} MB, {growth:+.1%} since")
    return 1 if growth > GROWTH or life.false else 0


if __name__ == "__main__":
    sys.exit(main())
