"""Goals in words or poses to candidate poses of the base."""

import math

import msgspec

from common import messages as m
from common.approach import FOOTPRINT, delivers_at_home, poses_for
from common.floor_plan import Receptacle, Room
from common.furniture_tops import support_at
from common.geometry import SIDES, Pose2
from common.household import Household
from services.navigation.config import NavigationConfig
from services.navigation.ended import Ended
from services.navigation.places import Places

Goal = m.NavigationGoal | m.NavGoal
# Candidate poses, each with a penalty [m].
Choices = list[tuple[float, Pose2]]

SAME = 0.4
"""An object reported within this of where a goal says that it is, is the goal's [m]: as far as a push moves one."""
INSIDE, SPACING = FOOTPRINT + 0.06, 0.2
"""Of the spots in a room, the distance from its sides and from each other [m]; chosen: all of the base is inside, and
one is in a strip of 0.9 m that a bed leaves along a wall, in which the base has 28 cm."""
UNLISTED = 3.0
"""Penalty [m] of a pose before a side of a surface that the household does not list as free: as much as a way round of
20 m. Chosen: where the floor is free all the same, it serves."""
LAST_RESORT = 100.0
"""Penalty of the pose that a goal gives when its object has others [m]: more than any way within a flat costs."""


class Goals:
    """Translates goals, words or poses, to the poses at which the base may stand; raises `Ended` if it cannot."""

    def __init__(self, household: Household, places: Places, config: NavigationConfig) -> None:
        self._household, self._places, self._config = household, places, config

    def by_words(self, text: str) -> Choices:
        """The poses for a goal in words other than `find`; raises `Ended` UNKNOWN_GOAL or UNKNOWN_PLACE."""
        verb, _, place = text.partition(" ")
        if text == "return_to_start":
            return self._home()
        if verb == "goto" and place.strip():
            return self.place(place.strip())
        raise Ended("failed", "UNKNOWN_GOAL", f"{text!r}: expected find, goto, return_to_start or stop")

    def _home(self) -> Choices:
        return [(0.0, self._places.home)]

    def place(self, name: str) -> Choices:
        """The poses at a room, surface or place called `name`; raises `Ended` UNKNOWN_PLACE."""
        place = self._places.place(name)
        if place is None:
            raise Ended("failed", "UNKNOWN_PLACE", f"no place {name!r}; known: {self._places.similar(name)}")
        if isinstance(place, Room):
            return self._within(place)
        if not isinstance(place, Receptacle):
            return [(0.0, place)]
        if place.name == self._household.delivery and delivers_at_home(self._household):
            return self._home()
        return self._before((place.center[0], place.center[1]), place)

    def pose(self, goal: m.NavGoal, objects: list[m.WorldObject]) -> Choices:
        """The pose of a goal; if it names an object, poses before that, and the given one as the last resort.

        Raises `Ended` BAD_POSE.
        """
        if goal.frame != "map":
            raise Ended("failed", "BAD_POSE", f"frame {goal.frame!r}: only map is known")
        low, high = self._household.low, self._household.high
        if not all(map(math.isfinite, (goal.x, goal.y, goal.theta))):
            raise Ended("failed", "BAD_POSE", "the pose is not finite")
        if not (low[0] <= goal.x <= high[0] and low[1] <= goal.y <= high[1]):
            raise Ended("failed", "BAD_POSE", f"({goal.x:.2f}, {goal.y:.2f}) is outside the map")
        given = goal.x, goal.y, goal.theta
        before = self._described(goal.object, objects) if goal.object is not None else []
        return [*before, (LAST_RESORT if before else 0.0, given)]

    def _described(self, ref: m.ObjectRef, objects: list[m.WorldObject]) -> Choices:
        """Poses before the object of a goal: where it was reported last if that is near the goal's own position."""
        x, y, _ = ref.position
        if ref.frame != "map" or not (math.isfinite(x) and math.isfinite(y)):
            return []
        for o in objects:
            if o.label == ref.label and not o.held and math.dist((x, y), o.position[:2]) < SAME:
                return self._before((o.position[0], o.position[1]), self._places.receptacle_of(o))
        return self._before((x, y), support_at(self._household, x, y))

    def before(self, item: str, objects: list[m.WorldObject]) -> Choices:
        """Poses before every reported object that the words `item` can mean; empty when there is none."""
        return [
            choice
            for o in self._places.matching(item, objects)
            for choice in self._before((o.position[0], o.position[1]), self._places.receptacle_of(o))
        ]

    def known(self, item: str, objects: list[m.WorldObject]) -> bool:
        """True when one of the reported objects can be meant by the words `item`."""
        return bool(self._places.matching(item, objects))

    def expected_at(self, item: str) -> Choices:
        """The pose at which an item is expected while perception does not run."""
        return [(0.0, self._places.spot(item) or self._config.find_spot)]

    def _within(self, room: Room) -> Choices:
        """Spots all over a room, the penalty growing from its middle, where perhaps a table stands.

        Of a room that goes round another one, as an L does, its rectangle has floor of that: the spots there are left
        out, unless there are no others.
        """
        outline = room.outline
        counts = [max(0, math.floor((side / 2 - INSIDE) / SPACING)) for side in (outline.length, outline.width)]
        shifts = [
            (i * SPACING, j * SPACING)
            for i in range(-counts[0], counts[0] + 1)
            for j in range(-counts[1], counts[1] + 1)
        ]
        spots: Choices = [(math.hypot(*s), (*outline.to_map(*s), 0.0)) for s in shifts]
        return [s for s in spots if self._household.room_at(*s[1][:2]) == room] or spots

    def _before(self, point: tuple[float, float], receptacle: Receptacle | None) -> Choices:
        """Poses before the sides that the household lists, and with a penalty before the others that no wall is beside:
        a chair may stand before the only side that is listed."""
        stand_off, edge_distance = self._config.stand_off, self._config.edge_distance
        listed = poses_for(point, receptacle, stand_off, edge_distance)
        if receptacle is None or not receptacle.approach:
            return listed
        sides = tuple(side for side in SIDES if side not in receptacle.approach)
        if not sides:
            return listed
        turned = msgspec.structs.replace(receptacle, approach=sides)
        walls = [wall.footprint for wall in self._household.walls]
        return listed + [
            (UNLISTED + penalty, pose)
            for penalty, pose in poses_for(point, turned, stand_off, edge_distance)
            if not any(wall.meets(point, pose[:2]) for wall in walls)
        ]


def in_words(goal: Goal) -> str:
    """A goal for logs and reasons."""
    if isinstance(goal, m.NavigationGoal):
        return goal.goal.strip()
    return f"a pose before {goal.object.label}" if goal.object is not None else "a pose"
