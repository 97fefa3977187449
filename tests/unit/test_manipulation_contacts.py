"""When open fingers that touched an object say that it is too wide for the hand."""

import math

import numpy as np
import pytest

from services.manipulation.arm.contacts import Contact, ContactLog, came_around, new_sides_first, other_side
from services.manipulation.grasps.grasp import approach_rotation

FRONT = approach_rotation(0.0, math.radians(40))
PAD = 0.019


def log(*contacts: Contact) -> ContactLog:
    found = ContactLog()
    for contact in contacts:
        found.add("mug", contact)
    return found


@pytest.mark.parametrize(
    ("azimuth", "tilt", "roll", "other"),
    [(0, 40, 0, False), (25, 40, 0, False), (50, 40, 0, True), (0, 55, 0, False), (0, 90, 0, True), (180, 40, 0, True),
     (0, 40, 50, True), (0, 40, 180, False)],
)  # fmt: skip
def test_sides_differ_by_approach_or_by_closing_direction(azimuth: int, tilt: int, roll: int, other: bool) -> None:
    turns = (math.radians(azimuth), math.radians(tilt), math.radians(roll))
    assert other_side(FRONT, approach_rotation(*turns)) is other


def test_too_wide_takes_two_sides_two_sightings_and_fingers_around_the_object() -> None:
    side = approach_rotation(math.radians(50), math.radians(40))
    first = Contact(FRONT, 1.0, True)
    assert not log(first).too_wide()
    assert log(first, Contact(side, 2.0, True)).too_wide()
    assert not log(first, Contact(FRONT, 2.0, True)).too_wide(), "the same side"
    assert not log(first, Contact(side, 1.0, True)).too_wide(), "the same sighting"
    assert not log(first, Contact(side, 2.0, False)).too_wide(), "something was met before the object"
    assert log(first, Contact(FRONT, 2.0, False), Contact(side, 3.0, True)).too_wide()
    assert not log(first, Contact(side, 400.0, True)).too_wide(), "another mission"


def test_contacts_with_another_object_or_before_a_grasp_around_it_are_forgotten() -> None:
    side = Contact(approach_rotation(math.radians(50), math.radians(40)), 2.0, True)
    found = log(Contact(FRONT, 1.0, True))
    found.add("can", side)
    assert not found.too_wide() and found.rotations("mug") == [] and len(found.rotations("can")) == 1
    found = log(Contact(FRONT, 1.0, True))
    found.clear()
    found.add("mug", side)
    assert not found.too_wide()


def test_contacts_are_bounded() -> None:
    assert len(log(*(Contact(FRONT, float(n), True) for n in range(50))).rotations("mug")) == 8


def test_grasps_from_new_sides_come_first_in_their_order() -> None:
    rotations = [approach_rotation(math.radians(a), math.radians(40)) for a in (0, 25, -25, 50, -50)]
    assert new_sides_first(rotations, []) == [0, 1, 2, 3, 4]
    assert new_sides_first(rotations, [FRONT]) == [3, 4, 0, 1, 2]


@pytest.mark.parametrize(("before", "around"), [(0.0, True), (0.045, True), (0.09, False)])
def test_the_hand_was_around_the_object_when_its_fingertips_had_reached_it(before: float, around: bool) -> None:
    """45 mm: a mug of 88 mm that is believed to have 74; 90 mm: the sighting of fetch seed 36, 60 mm too deep."""
    grasp = np.array([0.6, 0.0, 0.6])
    assert came_around(grasp - before * FRONT[:, 2], grasp, (0.074, 0.074, 0.095), PAD) is around
