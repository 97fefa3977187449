"""Two robots meet in one flat: do both arrive, how near do they come, what does it cost? `python -m bench.encounters`.

Two whole navigation services drive two bodies in one MuJoCo world, with the lidars and wheels of the simulation. Every
meeting is driven by the two and by each of them alone, which is what time lost is counted against. Exit 1 after a touch
or a robot that did not arrive.
"""

import argparse
import sys
from dataclasses import dataclass, field

import numpy as np

from bench.encounters.meetings import KINDS
from bench.encounters.pair import Outcome, Pair

MET = 1.5
"""Two robots that came this near to each other have met [m]."""


@dataclass
class Tally:
    """Results of one kind of meeting."""

    meetings: int = 0
    met: int = 0
    arrived: int = 0
    touched: int = 0
    nearest: list[float] = field(default_factory=list)
    lost: list[float] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def add(self, seed: int, outcome: Outcome, alone: list[float | None]) -> None:
        self.meetings += 1
        self.met += outcome.nearest < MET
        self.arrived += outcome.arrived
        self.touched += outcome.touched
        if outcome.nearest < MET:
            self.nearest.append(outcome.nearest)
            self.lost += [t - a for t, a in zip(outcome.took, alone, strict=True) if t is not None and a is not None]
        if not outcome.arrived or outcome.touched:
            self.notes.append(f"seed {seed}: nearest {outcome.nearest:.2f} m, {', '.join(outcome.codes) or 'arrived'}")

    def row(self) -> str:
        near = f"{min(self.nearest):8.2f} {np.median(self.nearest):8.2f}" if self.nearest else f"{'-':>8} {'-':>8}"
        lost = f"{np.mean(self.lost):8.1f} {max(self.lost):8.1f}" if self.lost else f"{'-':>8} {'-':>8}"
        return f"{self.meetings:8} {self.met:8} {self.arrived:8} {self.touched:8} {near} {lost}"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=10, help="meetings of each kind (default %(default)s)")
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--only", default="", help="kinds whose name contains this")
    args = parser.parse_args()
    tallies = {kind: Tally() for kind in KINDS if args.only in kind}
    for kind, tally in tallies.items():
        for seed in range(args.first, args.first + args.seeds):
            meeting = KINDS[kind](np.random.default_rng([seed, 17]))
            drivers = [n for n in (0, 1) if meeting.goals[n] is not None]
            alone = [Pair(meeting, alone=n).run().took[0] for n in drivers]
            outcome = Pair(meeting).run()
            tally.add(seed, outcome, alone)
            print(f"  {kind}, seed {seed}: {outcome} alone {alone}", file=sys.stderr)
    heads = ("meetings", "met", "arrived", "touched", "nearest", "median", "lost s", "most")
    print(f"{'':16}" + " ".join(f"{head:>8}" for head in heads))
    for kind, tally in tallies.items():
        print(f"{kind:16}{tally.row()}")
    for kind, tally in tallies.items():
        for note in tally.notes:
            print(f"{kind}: {note}")
    return int(any(t.touched or t.arrived < t.meetings for t in tallies.values()))


if __name__ == "__main__":
    sys.exit(main())
