"""What of the things that perception reports on the floor is in the way."""

import msgspec

from common import messages as m
from common import topics
from services.navigation.config import NavigationConfig
from services.navigation.destinations import Destinations
from services.navigation.motion.obstacle_tracker import Obstacle
from tests.unit.navigation_flat import Flat

FOOT = m.WorldObject(
    label="thing", kind="thing", colour="", position=(1.0, 2.0, 0.11), size=(0.4, 0.4, 0.22), seen_at=5.0
)
WALKER = Obstacle(1.1, 2.1, 0.2, 5.0, walked=True)


def test_a_foot_is_left_out_until_something_is_seen_there_without_anybody() -> None:
    flat = Flat()
    destinations = Destinations(NavigationConfig(), flat.io)
    flat.bus.send(topics.WORLD_OBJECTS, m.WorldObjects(t=5.0, objects=[FOOT]))
    flat.step()
    assert destinations.on_floor([WALKER]) == []
    assert destinations.on_floor([]) == [], "whoever it was has walked on"
    flat.bus.send(topics.WORLD_OBJECTS, m.WorldObjects(t=9.0, objects=[msgspec.structs.replace(FOOT, seen_at=9.0)]))
    flat.step()
    assert [disc[:2] for disc in destinations.on_floor([])] == [FOOT.position[:2]]
    assert destinations.on_floor([WALKER]), "who comes by later makes no foot of it"


def test_what_stands_away_from_people_or_by_something_that_never_walked_is_in_the_way() -> None:
    flat = Flat()
    flat.bus.send(topics.WORLD_OBJECTS, m.WorldObjects(t=5.0, objects=[FOOT]))
    flat.step()
    assert Destinations(NavigationConfig(), flat.io).on_floor([Obstacle(2.0, 2.1, 0.2, 5.0, walked=True)])
    assert Destinations(NavigationConfig(), flat.io).on_floor([Obstacle(1.1, 2.1, 0.2, 5.0)])
