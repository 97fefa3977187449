"""The poses of a goal that names a room."""

import pytest

from common.approach import ROOM
from common.floor_plan import Place, Room
from common.household import Household
from services.navigation.config import NavigationConfig
from services.navigation.goals import Goals
from services.navigation.places import Places, PlacesFile

AROUND = Room(name="lounge", low=(0.0, 0.0), high=(6.0, 6.0))
CORNER = Room(name="study", low=(2.0, 2.0), high=(6.0, 6.0))


def spots(*rooms: Room) -> list[tuple[float, float]]:
    """Where the base may stand in the first of the rooms of a home."""
    home = Household(name="L", low=(0.0, 0.0), high=(6.0, 6.0), home=Place(name="home", x=1.0, y=1.0), rooms=rooms)
    goals = Goals(home, Places(home, PlacesFile()), NavigationConfig())
    return [pose[:2] for _, pose in goals.place(rooms[0].name)]


def test_a_room_that_goes_round_another_is_not_entered_where_that_one_is() -> None:
    alone, found = spots(AROUND), spots(AROUND, CORNER)
    assert set(found) == {spot for spot in alone if not CORNER.contains(*spot)}
    assert found


def test_a_room_within_another_keeps_its_spots_and_one_that_has_no_others_does_too() -> None:
    assert spots(CORNER, AROUND) == spots(CORNER)
    assert spots(CORNER, Room(name="nook", low=(2.3, 2.3), high=(5.7, 5.7))) == spots(CORNER)


@pytest.mark.parametrize("depth", [2.6, 2.74, 2.9, 3.0, 3.15])
def test_a_room_that_is_most_of_it_bed_has_a_spot_before_the_bed(depth: float) -> None:
    """The base's middle has what a strip of 0.9 m leaves of it."""
    found = spots(Room(name="bedroom", low=(0.0, 0.0), high=(2.6, depth)))
    assert any(ROOM <= y <= 0.9 - ROOM and ROOM <= x <= 2.6 - ROOM for x, y in found)
