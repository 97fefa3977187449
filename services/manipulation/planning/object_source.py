"""Where the pose of the object to grab comes from.

The goal's own object says which and where; a sighting of it in `world/objects` that is newer says better where.
Without one the latched `world/objects` is asked for what was last looked for.
"""

import math

from msgspec import structs

from common.geometry import Pose2, to_frame
from common.household import Household
from common.messages import ManipulationGoal, ObjectRef, WorldObject, WorldObjects
from common.naming.names import match_object
from services.manipulation.planning.planning_scene import tilt_of

FRONT = 1.2
"""How far [m] ahead of the base an unnamed object to grab may be. Chosen: the arm's reach and its place on the base."""
SHIFTED = 0.4
"""How far [m] from where a goal describes an object a newer sighting of it still means the same one. Chosen: farther
than an object is shoved, nearer than the next surface."""
RENAMED = 0.05
"""How far [m] from where a goal describes an object another label is a better name for the same one. Chosen: the error
of a sighting from 3 m; the middles of two things that stand beside each other are farther apart.
"""
LEFT = 0.03
"""How far [m] from where an object was it is still said to be there. Chosen: the error of two sightings."""
DEFAULT_SIZE = (0.06, 0.06, 0.08)
"""Full extents [m] of an object that nobody described. Chosen: near those of a can."""


class ObjectSource:
    """Knows the objects that were reported and where held or placed ones have gone since."""

    def __init__(self, household: Household) -> None:
        self._household = household
        self._moved: dict[str, WorldObject] = {}
        self._left: dict[str, tuple[float, float, float]] = {}
        self._reported: WorldObjects | None = None

    def update(self, reported: WorldObjects | None) -> None:
        """A newer report replaces what was remembered of moved objects seen since."""
        if reported is not None and reported is not self._reported:
            self._reported = reported
            self._moved = self._still_newer(reported)

    def _still_newer(self, reported: WorldObjects) -> dict[str, WorldObject]:
        seen = {o.label: o for o in reported.objects}
        kept = {k: o for k, o in self._moved.items() if k not in seen or self._older(seen[k], o)}
        self._left = {k: place for k, place in self._left.items() if k in kept}
        return kept

    def _older(self, seen: WorldObject, moved: WorldObject) -> bool:
        left = self._left.get(seen.label)
        return seen.seen_at < moved.seen_at or (left is not None and _close(seen.position, left, LEFT))

    def objects(self) -> list[WorldObject]:
        """The objects as they are believed to be now."""
        if self._reported is None:
            return list(self._moved.values())
        reported = [self._moved.get(o.label, o) for o in self._reported.objects]
        labels = {o.label for o in reported}
        return reported + [o for k, o in self._moved.items() if k not in labels]

    def remember(self, label: str, position: tuple[float, float, float] | None, on: str, now: float) -> None:
        """An object was picked up (`position` None) or put down."""
        known = next((o for o in self.objects() if o.label == label), None)
        if known is None:
            return
        self._left.pop(label, None)
        # What lay is held, and put down, as it stands.
        size = known.size[::-1] if tilt_of(known) else known.size
        self._moved[label] = structs.replace(
            known, position=position or known.position, size=size, tilt=0.0, points=b"", on=on, seen_at=now,
            held=position is None,
        )  # fmt: skip

    def moved(self, was: WorldObject, found: WorldObject) -> None:
        """An object is now where the robot has brought it, as described, until it is seen elsewhere than it was: hidden
        in part it is still said to be there.
        """
        self._moved[found.label], self._left[found.label] = found, was.position

    def resolve(self, goal: ManipulationGoal, wanted: str, base: Pose2, since: float = math.inf) -> WorldObject | None:
        """The object of a goal: the one it describes, the one last looked for, or the nearest in front.

        One that was seen after `since` near the described place counts as it was seen.
        """
        if goal.object is not None:
            seen = self._as_it_is_called_now(goal.object, since)
            if seen is not None and seen.seen_at >= since and _close(seen.position, goal.object.position, SHIFTED):
                # What it was asked for as says better what it is than its looks.
                return structs.replace(seen, kind=goal.object.kind or seen.kind)
            return self._described(goal.object)
        found = match_object(wanted, self.objects(), self._household) if wanted else self.objects()
        near = []
        for o in found:
            x, y = to_frame(base, (o.position[0], o.position[1]))
            if not o.held and (wanted or (x > 0 and math.hypot(x, y) < FRONT)):
                near.append((math.hypot(x, y), o.label, o))
        return min(near)[2] if near else None

    def _as_it_is_called_now(self, ref: ObjectRef, since: float) -> WorldObject | None:
        """The reported object that a goal describes, by its label; or, where there is none of that label any more, what
        was seen in its place `since`: from nearer a box turns out to be a can."""
        known = self.objects()
        own = next((o for o in known if o.label == ref.label), None)
        if own is not None or self._household.thing(ref.label) is not None:
            return own
        fresh = (o for o in known if o.measured and not o.held and o.seen_at >= since)
        near = [o for o in fresh if _close(o.position, ref.position, RENAMED)]
        there = min(near, key=lambda o: math.dist(o.position[:2], ref.position[:2]), default=None)
        return structs.replace(there, label=ref.label) if there is not None else None

    def _described(self, ref: ObjectRef) -> WorldObject:
        known = next((o for o in self.objects() if o.label == ref.label), None)
        near = known is not None and _close(known.position, ref.position)
        size = ref.size if min(ref.size) > 0 else (known.size if known else DEFAULT_SIZE)
        return WorldObject(
            label=ref.label,
            kind=ref.kind or (known.kind if known else ""),
            colour=known.colour if known else "",
            position=ref.position,
            orientation=ref.orientation,
            size=size,
            on=known.on if known and near else "",
            tilt=ref.tilt,
            shape=ref.shape or (known.shape if known else ""),
            points=ref.points or (known.points if known and near else b""),
            spread=known.spread if known else 0.0,
            measured=known.measured if known else bool(ref.shape),
        )


def _close(a: tuple[float, float, float], b: tuple[float, float, float], within: float = 0.1) -> bool:
    return math.hypot(a[0] - b[0], a[1] - b[1]) < within
