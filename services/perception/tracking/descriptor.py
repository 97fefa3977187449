"""What several views of one object say about it together: shape, extents, kinds, colours, points of its surface."""

import math
from dataclasses import dataclass, field

import numpy as np

from common.floor_plan import Vec3
from common.geometry import Array
from common.messages import End, ShapeFamily
from common.naming.likeness import TAKEN_FOR
from services.perception.detection import Detection
from services.perception.shapes.measurement import LEVEL
from services.perception.tracking.registration import laid_over, unlike
from services.perception.unlisted import MOST_POINTS, thinned
from services.perception.views import colour

FADES = 0.85
"""What is left of earlier votes after a view."""
LEAST_SPREAD = 0.002
"""Standard deviation [m] that no number of views goes below: the sensor's own bias."""
STRONGER = 2.5
"""How much likelier another kind or colour must be before a label that others know is changed."""
FIRM = 0.9
"""Share of the votes from which a kind counts as seen: one that is nothing like it takes as much to replace it, and is
asked about before (chosen: a black bottle without depth is a book's back from near)."""
LIKELY = 0.2
"""Share of the likeliest kind's votes from which a kind may be meant by its word."""
BLURRED = 1.4
"""How many times as far a view is whose points are twice as noisy: a depth camera's noise grows with the square."""
LEAST_SHARE = 0.02
"""Share of the votes below which a word is not told of."""


@dataclass
class Descriptor:
    """`kinds`, `colours`, `shapes`: votes by name. `size` [m] with `spread` [m]; `points` (n, 3) [m] from its middle,
    seen from no farther than about `nearest` [m].

    `opening`: votes for an open end, from whatever side; they do not fade, as it is no more to be seen when the object
    stands on it. `ends`: votes for what its upper end is, since it rests as it does. `firm`: the last kind that counted
    as seen.
    """

    size: Vec3
    spread: float = 0.0
    yaw: float = 0.0
    kinds: dict[str, float] = field(default_factory=dict)
    colours: dict[str, float] = field(default_factory=dict)
    shapes: dict[ShapeFamily, float] = field(default_factory=dict)
    points: Array = field(default_factory=lambda: np.empty((0, 3)))
    named: tuple[str, str] = ("", "")
    opening: float = 0.0
    ends: dict[End, float] = field(default_factory=dict)
    firm: str = ""
    nearest: float = math.inf

    def add(self, d: Detection, weight: float, moved: bool, was: Vec3, now: Vec3) -> None:
        """Take in a view's detection; `weight`: how much it says. `moved`: earlier points and extents do not hold;
        `was`, `now` [map]: where the object was believed to be before that view, and is with it.
        """
        old = self.shape
        # Past the ridge of a carton one looks as well.
        self.opening += weight * (d.end == "open" and d.shape != "box")
        if moved:
            self.ends = {}
        if d.end and d.tilt != LEVEL:
            vote(self.ends, {d.end: 1.0}, weight)
        vote(self.kinds, d.kinds, weight)
        vote(self.colours, d.colours, weight)
        vote(self.shapes, {d.shape: 1.0}, weight)
        spread = max(LEAST_SPREAD, d.spread)
        if moved or not self.spread or old != self.shape or (d.shape != old and spread < self.spread):
            if d.shape == self.shape or moved or not self.spread:
                self.size, self.spread, self.yaw = d.size, spread, d.yaw
        elif d.shape == old:
            share = self.spread**2 / (self.spread**2 + spread**2)
            self.size = _between(self.size, _aligned(d, self.yaw), share)
            self.spread = max(LEAST_SPREAD, self.spread * math.sqrt(1 - share))
        self._add_points(d, was, now, moved)

    def set_down(self) -> None:
        """The hand has let go: how it rests, and what shape it shows so, is to be seen anew."""
        self.shapes, self.ends, self.spread = {}, {}, 0.0

    def _add_points(self, d: Detection, was: Vec3, now: Vec3, moved: bool) -> None:
        """Views of like noise are merged; what was seen from much farther blurs what was seen from near."""
        if not len(d.points):
            return
        # From its own middle: so views laid one over another do not blur it.
        seen = d.points - (d.position if d.whole else now)
        if moved or not len(self.points) or (d.whole and d.distance < self.nearest / BLURRED):
            self.points, self.nearest = seen, d.distance
        elif d.distance < self.nearest * BLURRED:
            # Taken for another shape it has another middle: then it is where it was on the map.
            on_map = self.points + np.subtract(was, now), d.points - now
            old, new = min((self.points, seen), on_map, key=lambda pair: unlike(*pair))
            self.points = _merged(old, laid_over(old, new))
            self.nearest = min(self.nearest, d.distance)

    def turned(self, d: Detection) -> float:
        """The yaw [rad] of a detection, by which its extents are in the order of `size`."""
        return d.yaw + math.pi / 2 if _crossed(d, self.yaw) else d.yaw

    @property
    def shape(self) -> ShapeFamily:
        return max(self.shapes, key=lambda s: (self.shapes[s], s), default="")

    @property
    def top(self) -> End:
        """What its upper end is by most votes."""
        return max(self.ends, key=lambda end: (self.ends[end], end), default="")

    @property
    def likely_kinds(self) -> list[str]:
        """The kinds that it may be, the likeliest first."""
        ordered = sorted(self.kinds, key=lambda k: (-self.kinds[k], k))
        return [k for k in ordered if self.kinds[k] >= LIKELY * self.kinds[ordered[0]]]

    @property
    def main_colours(self) -> list[str]:
        return colour.main_words(self.colours) if self.colours else []

    def name(self) -> tuple[str, str]:
        """Kind and colour by which it is called; once told they stay until others are much likelier."""
        kind, main = self.named
        first, shade = self.likely_kinds[0], (self.main_colours or [""])[0]
        if self.kinds[first] >= FIRM * sum(self.kinds.values()):
            self.firm = first
        credible = self.firm in ("", first) or any({first, self.firm} <= group for group in TAKEN_FOR)
        if not kind or (credible and self.kinds[first] > STRONGER * self.kinds.get(kind, 0.0)):
            kind = first
        if not main or self.colours.get(shade, 0.0) > STRONGER * self.colours.get(main, 0.0):
            main = shade
        self.named = kind, main
        return self.named

    def packed(self) -> bytes:
        """The points as `WorldObject.points`."""
        return np.clip(np.round(self.points * 1000), -32768, 32767).astype("<i2").tobytes()


def shares(votes: dict[str, float]) -> dict[str, float]:
    """The share of each of the votes that has any to speak of, the largest first."""
    total = sum(votes.values()) or 1.0
    ordered = sorted(votes, key=lambda name: (-votes[name], name))
    return {name: round(votes[name] / total, 3) for name in ordered if votes[name] >= LEAST_SHARE * total}


def vote(
    votes: dict[str, float] | dict[ShapeFamily, float] | dict[End, float], new: dict[str, float], weight: float
) -> None:
    """Add shares to the votes, of which the old ones fade."""
    table: dict[str, float] = votes  # type: ignore[assignment]
    for name in table:
        table[name] *= FADES
    for name, share in new.items():
        table[name] = table.get(name, 0.0) + share * weight


def _between(a: Vec3, b: Vec3, share: float) -> Vec3:
    x, y, z = (p + share * (q - p) for p, q in zip(a, b, strict=True))
    return x, y, z


def _crossed(d: Detection, yaw: float) -> bool:
    """A box whose longer side is across that of one that is turned by `yaw`: from elsewhere another may seem longer."""
    return d.shape == "box" and not d.tilt and abs(math.sin(d.yaw - yaw)) > math.sqrt(0.5)


def _aligned(d: Detection, yaw: float) -> Vec3:
    """Extents in the axes of a box that is turned by `yaw`."""
    x, y, z = d.size
    return (y, x, z) if _crossed(d, yaw) else d.size


def _merged(old: Array, new: Array) -> Array:
    """Points of earlier views and of this one, the newest of each place."""
    together = thinned(np.concatenate([old, new]))
    return together[:MOST_POINTS]
