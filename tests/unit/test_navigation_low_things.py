"""What of the things that perception reports on the floor is in the way."""

import math

import numpy as np
import pytest

from common import messages as m
from common import topics
from common.floor_plan import Place
from common.geometry import Rectangle
from common.household import Household
from services.navigation.planning.costmap import Costmap
from services.navigation.planning.low_things import AROUND, LATE, PICTURE, LowThings
from tests.unit.navigation_flat import Flat
from tests.unit.test_navigation_recovery import KITCHEN_DOOR, STUDY_DOOR

HERE = (0.0, 0.0, 0.0)
EAST = np.radians(np.arange(360.0))
RADIUS = 0.2 * math.sqrt(2)


def thing(seen_at: float, low: float = 0.0, held: bool = False) -> m.WorldObject:
    return m.WorldObject(
        label="thing", kind="thing", colour="", position=(2.0, 0.0, low + 0.11), size=(0.4, 0.4, 0.22),
        seen_at=seen_at, held=held,
    )  # fmt: skip


class Floor:
    """A bare floor with something `ahead` [m] that the lidar sees, or nothing."""

    def __init__(self) -> None:
        home = Household(name="x", low=(-4.0, -4.0), high=(4.0, 4.0), home=Place(name="home", x=0, y=0))
        self.map = Costmap(home, 0.05, memory=30.0)
        self.low = LowThings(self.map)

    def scan(self, now: float, ahead: float = math.inf) -> None:
        ranges = np.full(360, 20.0)
        ranges[0] = ahead
        self.map.obstacles.see(HERE, EAST, ranges, 10.0, now)
        self.low.see(np.array([(ahead, 0.0)]) if math.isfinite(ahead) else np.empty((0, 2)), now)

    def shut(self, *objects: m.WorldObject) -> bool:
        """What is reported fills the floor behind where the lidar saw something."""
        self.low.place(objects)
        return self.map.clearance(2.0 + RADIUS / 2, 0.0) == 0.0


def test_a_foot_is_gone_when_the_lidar_no_longer_sees_who_stood_on_it() -> None:
    floor = Floor()
    floor.scan(5.0, 1.85)
    floor.scan(6.0, 1.85)
    assert floor.shut(thing(5.0)), "they stand there"
    floor.scan(7.0)
    assert not floor.shut(thing(5.0)), "they have walked on"
    assert floor.shut(thing(7.0)), "it was seen again without anybody"
    floor.scan(7.5, 1.85)
    floor.scan(8.0)
    assert floor.shut(thing(7.0)), "who comes by later makes no foot of it"


def test_a_foot_of_somebody_who_has_walked_on_by_when_it_is_reported() -> None:
    floor = Floor()
    floor.scan(5.0, 1.85)
    floor.scan(5.0 + PICTURE + 0.1)
    assert not floor.shut(thing(5.0))
    assert floor.shut(thing(5.0 + PICTURE + 0.1))


def test_scans_of_long_ago_or_beside_the_thing_say_nothing() -> None:
    floor = Floor()
    floor.scan(5.0, 2.0 - RADIUS - AROUND - 0.05)
    floor.scan(6.0)
    assert floor.shut(thing(5.0))
    floor = Floor()
    floor.scan(5.0, 1.85)
    floor.scan(5.0 + LATE + 0.1)
    assert floor.shut(thing(5.0)), "nobody knows any more"


def test_what_is_held_or_on_something_is_not_in_the_way() -> None:
    floor = Floor()
    floor.scan(5.0)
    assert not floor.shut(thing(5.0, held=True))
    assert not floor.shut(thing(5.0, low=0.4))
    assert floor.shut(thing(5.0))
    assert not floor.shut(), "it is reported no longer"


def test_what_shut_every_way_is_tried_once_it_has_not_been_seen_for_a_while() -> None:
    floor = Floor()
    floor.scan(5.0)
    floor.map.obstacles.doubt(7.0, 3.0, (0.0, 0.0))
    assert floor.shut(thing(5.0)), "seen since"
    floor.map.obstacles.doubt(9.0, 3.0, (0.0, 0.0))
    assert not floor.shut(thing(5.0))
    assert floor.shut(thing(9.0)), "it is there after all"


@pytest.mark.parametrize(("away", "kept"), [(0.99, True), (1.01, False)])
def test_what_lies_too_near_to_be_seen_again_in_time_is_not_driven_over(away: float, kept: bool) -> None:
    floor = Floor()
    floor.scan(5.0)
    floor.map.obstacles.doubt(9.0, 3.0, (2.0 - away, 0.0))
    assert floor.shut(thing(5.0)) == kept


def test_a_disc_that_nobody_sees_any_more_shuts_no_way_for_good() -> None:
    """The study's door is shut by a wall, the kitchen's by what perception believes and never sees again."""
    flat = Flat([Rectangle(*STUDY_DOOR)])
    x, y = KITCHEN_DOOR[:2]
    believed = m.WorldObject(label="thing", kind="thing", colour="", position=(x, y, 0.08), size=(0.9, 0.9, 0.16))
    flat.bus.send(topics.WORLD_OBJECTS, m.WorldObjects(t=0.0, objects=[believed]))
    flat.ask("goto kitchen")
    assert flat.finish(180.0).status == "arrived"
