"""Perception of objects that nobody listed: `python -m bench.perception --unknown sizes --views 40`.

The worlds are those of the suites `sizes`, `clutter`, `lying`, `labels` and `things`; perception is told the floor
plan alone. Of each object in view the table says whether it was found within 5 cm, whether its kind and colour are
among the words that it answers to, the first of these, and how far position and extents are off; and how many
detections are of nothing.
"""

import argparse
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np

from bench.perception.views import Looked, look_at, visible
from common.rendering.renderer import Renderer
from common.scene import ObjectSpec
from evaluation.case import Case
from evaluation.suites import unknown
from services.perception.detect import ClassicalDetector
from services.perception.detection import Detection
from services.perception.views import colour
from services.sim.layout import place_objects
from services.sim.world import world_files, world_mjcf

VIEWED: dict[str, Callable[[int], Case]] = {
    "sizes": unknown.sizes, "clutter": unknown.clutter, "lying": unknown.lying, "labels": unknown.labels,
    "things": unknown.scanned,
}  # fmt: skip
"""The suites whose worlds are looked at."""
NEAR, NOTHING = 0.05, 0.09
"""Distance [m] on the floor plan within which an object was found, and beyond which from all a detection is of none."""
VIEWS_PER_WORLD = 4
"""Standing places in each world [count]; chosen."""
LEANS = 0.7
"""Tilt [rad] from which an object does not stand."""


@dataclass
class Tally:
    """What became of the objects of one kind."""

    total: int = 0
    position: list[float] = field(default_factory=list)
    extents: list[float] = field(default_factory=list)
    kind: int = 0
    first_kind: int = 0
    colour: int = 0
    first_colour: int = 0
    rests: int = 0

    def add(self, spec: ObjectSpec, d: Detection | None, error: float) -> None:
        self.total += 1
        if d is None:
            return
        self.position.append(error)
        self.extents.append(max(abs(a - b) for a, b in zip(sorted(d.size), sorted(spec.size), strict=True)))
        self.kind += spec.kind in d.kinds
        self.first_kind += spec.kind == d.kind
        self.colour += spec.colour in colour.main_words(d.colours)
        self.first_colour += spec.colour == d.colour
        self.rests += (d.tilt > LEANS) == (spec.pose != "upright") or spec.kind == "box"

    def row(self, name: str) -> str:
        n = max(1, self.total)
        shares = (len(self.position), self.kind, self.first_kind, self.colour, self.first_colour, self.rests)
        p, e = (np.percentile(np.array(v or [math.nan]) * 1000, (50, 90)) for v in (self.position, self.extents))
        return (
            f"{name:10} {self.total:5} "
            + " ".join(f"{s / n:6.2f}" for s in shares)
            + f"  {p[0]:5.1f} {p[1]:5.1f}  {e[0]:5.1f} {e[1]:5.1f}"
        )


HEAD = (
    f"{'':10} {'seen':>5} {'found':>6} {'kind':>6} {'first':>6} {'colour':>6} {'first':>6} {'rests':>6}"
    f"  {'position':>11}  {'extents mm':>11} (median, p90)"
)


def take_all(args: argparse.Namespace) -> Iterator[Looked]:
    """Views of the suite's worlds from random places, with what stands there."""
    rng, made, seed = np.random.default_rng(args.seed), 0, args.seed
    while made < args.views:
        case = VIEWED[args.unknown](seed)
        assert case.scene is not None and case.household is not None
        detector = ClassicalDetector(case.household, 3.5)
        placements = place_objects(case.scene, case.seed)
        mjcf, files = world_mjcf(case.scene, placements), world_files(case.scene, placements)
        renderer = Renderer(mjcf, args.backend, files)
        for n in range(VIEWS_PER_WORLD):
            # Half of the views are of what is wanted.
            chosen = placements[0] if n % 2 else placements[int(rng.integers(len(placements)))]
            view = look_at(args, renderer, chosen, placements, rng)
            if view is not None and made < args.views:
                made += 1
                yield Looked(view, placements, detector)
        renderer.close()
        seed += 1


class Unlisted:
    """What perception makes of things that no household lists."""

    def __init__(self, args: argparse.Namespace) -> None:
        self._args = args
        self._tallies: dict[str, Tally] = {}
        self._all, self._false, self._seen = Tally(), 0, 0

    def views(self) -> Iterator[Looked]:
        """Views of the suite's worlds."""
        return take_all(self._args)

    def add(self, looked: Looked, found: list[Detection]) -> None:
        """One view, and what was detected in it."""
        view, placements, _ = looked
        self._seen += 1
        for p in placements:
            if not visible(view, p):
                continue
            near = [(math.dist(d.position[:2], p.position[:2]), n) for n, d in enumerate(found)]
            error, best = min(near, default=(math.inf, 0))
            d = found[best] if error < NEAR else None
            for tally in (self._tallies.setdefault(p.spec.kind, Tally()), self._all):
                tally.add(p.spec, d, error)
            if self._args.verbose and (d is None or p.spec.kind not in d.kinds or p.spec.colour not in d.colours):
                what, far = f"{p.spec.name} {p.spec.size} {p.spec.pose}", math.dist(view.position, p.position)
                print(f"view {self._seen}: {what} at {far:.2f} m: {_told(d)}")
        ghosts = [d for d in found if all(math.dist(d.position[:2], p.position[:2]) > NOTHING for p in placements)]
        self._false += len(ghosts)
        if self._args.verbose:
            print(*(f"view {self._seen}: nothing is {_told(d)} at {d.position}" for d in ghosts), sep="\n", end="")

    def show(self) -> None:
        """Print the table."""
        args = self._args
        print(f"{self._seen} views of {args.unknown}, {self._all.total} visible objects, {args.width} x {args.height}")
        print(HEAD)
        for kind in sorted(self._tallies):
            print(self._tallies[kind].row(kind))
        print(self._all.row("all"))
        print(f"detections of nothing a view: {self._false / max(1, self._seen):.3f}")


def _told(d: Detection | None) -> str:
    if d is None:
        return "not found"
    kinds = ", ".join(f"{k} {v:.2f}" for k, v in d.kinds.items())
    size = " x ".join(f"{v * 1000:.0f}" for v in d.size)
    return f"{d.colour} {d.shape} ({kinds}) {size} mm, tilt {d.tilt:.1f}, {d.confidence:.2f}, {'whole' * d.whole}"
