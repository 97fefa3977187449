"""The history of one object so far: lifted, carried, dropped, moved, toppled. Pure."""

import math

import msgspec

from common.kinds import kind_of

LIFTED = 0.05
"""Rise [m] above the lowest it was out of the hand that counts as lifted: more than any object of the scenes can tip up
on an edge."""
MOVED = 0.03
"""Displacement [m] from which an object counts as moved; physics at rest creeps by less than 1 mm."""
TOPPLED = math.radians(15)
"""Tilt [rad] from which an object does not stand: on a flat surface one with a flat bottom stands within 2 degrees or
has gone over; the slimmest, a bottle of 64 x 210 mm, goes over at 17."""
DROP = 0.01
"""Fall [m] of what left the hand that counts as dropped: a put-down lets go some millimetres above a surface, and pads
on a round wall may lose it for one sample."""
FALL = 1.0
"""Time [s] that a thing let go above a bin may take to lie in it: a free fall of 1 s is 4.9 m."""


class ThingState(msgspec.Struct, frozen=True):
    """One object at one moment: `tilt` [rad] of its own z axis to the vertical, `on` what it rests on."""

    position: tuple[float, float, float]
    tilt: float
    on: str
    held: bool
    touched: bool


class Track(msgspec.Struct):
    """`carried` [m]: way of the base with it in the hand. `shift` [m], `lean` [rad]: the most since the baseline.

    `lowest` [m]: height out of the hand since the baseline. `lost_at` [m]: height at which the hand lost it, at
    `let_go` [s], until something holds it up again."""

    kind: str
    bins: frozenset[str]
    baseline: ThingState
    last: ThingState
    lowest: float = math.inf
    lifted: bool = False
    carried: float = 0.0
    dropped: bool = False
    drops: int = 0
    let_go: float = 0.0
    lost_at: float | None = None
    shift: float = 0.0
    lean: float = 0.0

    def restart(self) -> None:
        """Take the last sample as the baseline: what has happened so far was the world settling."""
        self.baseline, self.lowest, self.shift, self.lean = self.last, math.inf, 0.0, 0.0

    def add(self, now: ThingState, t: float, driven: float) -> None:
        """Take the object at time `t` [s]; the base has driven `driven` [m] since the sample before."""
        before, self.last = self.last, now
        if now is before and not now.held:
            return
        self.shift = max(self.shift, math.dist(now.position, self.baseline.position))
        self.lean = max(self.lean, abs(now.tilt - self.baseline.tilt))
        if now.held:
            # What fell from a shelf is lifted from the floor.
            rested = min(self.lowest, self.baseline.position[2])
            self.lifted = self.lifted or now.position[2] - rested > LIFTED
            self.carried += driven
            # What slipped and was picked up again is judged by the carry that followed.
            self.dropped = self.dropped and before.held
        else:
            self.lowest = min(self.lowest, now.position[2])
        if not self.dropped and self._fell(before, t):
            self.dropped, self.drops = True, self.drops + 1
        if self.dropped and now.on in self.bins and t - self.let_go < FALL:
            self.dropped, self.drops = False, self.drops - 1

    def _fell(self, before: ThingState, t: float) -> bool:
        """True for an object on the floor, where it did not stand, or fallen out of the hand onto nothing."""
        now, lost = self.last, self.lost_at
        # A hand that goes down with it is lower by itself one sample later: only what is still out of it has fallen.
        fell = lost is not None and not now.touched and lost - now.position[2] > DROP
        if fell or now.touched or now.on:
            self.lost_at = None
        elif before.held:
            self.lost_at, self.let_go = before.position[2], t
        if now.on == "floor" and self.baseline.on != "floor":
            fell, self.let_go = True, t
        return fell

    @property
    def toppled(self) -> bool:
        """True for an object that has an upright, does not stand, and is in no bin; either of two alike ends is up."""
        kind, tilt = kind_of(self.kind), self.last.tilt
        off = min(tilt, math.pi - tilt) if kind.ends_alike else tilt
        return kind.upright and off > TOPPLED and self.last.on not in self.bins

    @property
    def disturbed(self) -> bool:
        """True when it was moved or knocked over at any time since the baseline, by whomever."""
        return self.shift > MOVED or (kind_of(self.kind).upright and self.lean > TOPPLED)
