"""What was taken in place of the object that was meant is put back, and the object is grabbed anew."""

import pytest

from common import messages as m
from common import topics
from tests.unit.brain_bench import Bench
from tests.unit.test_brain_check import approach_again
from tests.unit.test_brain_vla import FETCH, MANIP, MUG_AT, approach, planned, see


def grabbed(moved: float = 0.0, seen_later: bool = True) -> Bench:
    """The hand has closed; pictures show the ball in it, and the mug `moved` [m], since then or before."""
    bench = planned(FETCH)
    see(bench, 1)
    approach(bench, 1)
    goal = bench.manip(1)
    x, y, z = MUG_AT
    closed = bench.now
    bench.did(goal)
    mug = m.WorldObject(
        label="red mug", kind="mug", colour="red", position=(x + moved, y, z), id="object-1", on="counter",
        seen_at=closed + (0.5 if seen_later else -0.5),
    )  # fmt: skip
    ball = m.WorldObject(
        label="red ball", kind="ball", colour="red", position=(x, y, z + 0.3), id="object-2", held=True, seen_at=closed
    )
    bench.send(topics.WORLD_OBJECTS, m.WorldObjects(t=bench.now, objects=[mug, ball]))
    bench.step()
    return bench


def test_what_was_not_meant_is_put_back_and_the_object_is_grabbed() -> None:
    bench = grabbed()
    place = bench.manip(2)
    assert place.goal == "place counter"
    bench.did(place)
    see(bench, 2)
    approach_again(bench, 2)
    bench.until(lambda: bench.count(MANIP) == 3)
    assert bench.texts(MANIP) == ["grab", "place counter", "grab"]


@pytest.mark.parametrize(("moved", "seen_later"), [(0.09, True), (0.0, False)], ids=["a neighbour", "seen before"])
def test_what_is_not_seen_where_it_was_since_the_hand_closed_is_held(moved: float, seen_later: bool) -> None:
    bench = grabbed(moved, seen_later)
    bench.until(lambda: bench.count(topics.NAVIGATION_GOAL) == 1)
    assert bench.texts(MANIP) == ["grab"]
