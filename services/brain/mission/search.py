"""What looking for the objects of a mission has shown, and where the robot has looked."""

import math

import msgspec

from common import messages as m

ALL_SIDES = 3
"""Sides from which an object is looked at from nearer. Chosen: a can shows all of what goes around it in three."""
SAME_PLACE = 0.03
"""Distance [m] within which an object is one that stood there before. Chosen: half of what two that touch are apart."""


class NearLooks(msgspec.Struct):
    """The `place` [m, map] and `id` of an object, and the directions [rad, map] from it to where the robot has looked
    at it from nearer: at most ALL_SIDES. One of both may have changed since: seen from another side it measures
    otherwise, and lost from sight it gets another id."""

    place: m.Vec3
    directions: list[float]
    id: str = ""

    def of(self, o: m.WorldObject | m.PossibleObject) -> bool:
        """Whether they are looks at this object."""
        return bool(o.id and o.id == self.id) or math.dist(self.place, o.position) < SAME_PLACE


class Search(msgspec.Struct):
    """What looking has shown: `found` objects and the `chosen` one of several `options`, by the plan's name for them.

    `unsure`: labels of objects that may be meant and can be told from nearer, or from another side only; `unlikely`:
    others for which that holds, and which are looked at once nothing else is left; `near_looks`: those made so far.

    `visited`: poses (x, y, theta) [m, rad] in map that the robot has looked from, `unreached` others that it could not
    get to, as often as it tried. `stances`: by label, the pose from
    which manipulation says that it reaches an object that it did not reach.

    `perhaps`: objects that may be meant, as perception had them last, `about` those which the person is being asked
    about, in `questions` [count] so far; `confirmed` the ids of those that are meant, by the plan's name, `rejected` of
    those that are not, which stood at `refused` [m, map].
    `unanswered`: nobody has answered such a question. `too_wide`: labels of what manipulation has called so.
    """

    found: dict[str, m.ObjectPose] = {}
    visited: list[tuple[float, float, float]] = []
    unreached: list[tuple[float, float, float]] = []
    options: list[str] = []
    chosen: dict[str, str] = {}
    unsure: list[str] = []
    unlikely: list[str] = []
    near_looks: list[NearLooks] = []
    stances: dict[str, tuple[float, float, float]] = {}
    perhaps: list[m.PossibleObject] = []
    about: list[m.PossibleObject] = []
    questions: int = 0
    confirmed: dict[str, str] = {}
    rejected: list[str] = []
    refused: list[m.Vec3] = []
    unanswered: bool = False
    too_wide: list[str] = []

    def directions(self, o: m.WorldObject | m.PossibleObject) -> list[float]:
        """Directions [rad, map] from which an object was looked at from nearer."""
        return next((looks.directions for looks in self.near_looks if looks.of(o)), [])

    def looked_near(self, o: m.WorldObject, directions: list[float]) -> None:
        """Note that an object was looked at from nearer, from these directions as well."""
        others = [looks for looks in self.near_looks if not looks.of(o)]
        self.near_looks = [*others, NearLooks(o.position, [*self.directions(o), *directions], o.id)]

    def drop(self, label: str) -> None:
        """An object is looked at from nearer now."""
        self.unsure = [other for other in self.unsure if other != label]
        self.unlikely = [other for other in self.unlikely if other != label]
