"""What fell while the hand was at work is noticed, and no mission is called done with it."""

import math
from typing import Any

import msgspec
import pytest

from common import messages as m
from common import topics
from services.brain.world.neighbours import AROUND, FRESH, knocked_over, standing
from tests.unit.test_brain_check import brought, ended, look
from tests.unit.test_brain_vla import SPEECH

CAN = m.WorldObject("yellow can", "can", "yellow", (1.0, 0.2, 0.66), size=(0.06, 0.06, 0.12), on="shelf", seen_at=10.0)
BASE = (0.3, 0.0, 0.0)


def can(**changes: Any) -> m.WorldObject:
    return msgspec.structs.replace(CAN, **changes)


@pytest.mark.parametrize(
    ("after", "words"),
    [
        ({}, []),
        ({"position": (1.06, 0.2, 0.66)}, []),
        ({"position": (1.08, 0.2, 0.63), "tilt": math.pi / 2}, ["the yellow can fell over"]),
        ({"position": (1.08, 0.2, 0.63), "tilt": math.pi / 2, "spread": 0.01}, ["the yellow can fell over"]),
        ({"position": (1.04, 0.2, 0.65), "tilt": math.pi / 2, "spread": 0.06}, []),
        ({"position": (1.01, 0.2, 0.65), "tilt": math.pi / 2}, []),
        ({"position": (1.08, 0.2, 0.66), "tilt": math.pi / 2}, []),  # another look at something flat
        ({"position": (1.2, 0.2, 0.03), "tilt": math.pi / 2, "on": ""}, ["the yellow can fell off the shelf"]),
        ({"position": (1.08, 0.2, 0.63), "tilt": math.pi / 2, "held": True}, []),
        ({"position": (1.08, 0.2, 0.63), "tilt": math.pi / 2, "seen_at": 10.0}, []),
    ],
)
def test_what_stood_and_lies_by_a_later_sighting_fell(after: dict[str, Any], words: list[str]) -> None:
    stood = standing([CAN], BASE, 12.0)
    seen = can(**{"seen_at": 20.0, **after})
    assert knocked_over(stood, [seen], ["red mug"]) == words
    assert knocked_over(stood, [seen], ["yellow can"]) == []


def test_only_what_stands_near_and_was_seen_lately_counts() -> None:
    assert list(standing([CAN], BASE, 12.0)) == ["yellow can"]
    assert list(standing([can(id="7")], BASE, 12.0)) == ["7"]
    for other in (can(tilt=1.5), can(held=True), can(position=(0.31 + AROUND, 0.0, 0.66)), can(seen_at=11.9 - FRESH)):
        assert not standing([other], BASE, 12.0)


@pytest.mark.parametrize(("name", "clean"), [("object-1", True), ("object-2", False)])
def test_what_was_handled_under_another_label_is_no_neighbour(name: str, clean: bool) -> None:
    bench = brought()
    bench.brain.context.mission.delivery.around = standing([can(id=name)], BASE, 10.0)
    fell = can(id=name, label="yellow jar", position=(1.2, 0.2, 0.03), on="", seen_at=bench.now)
    bench.send(topics.WORLD_OBJECTS, m.WorldObjects(t=bench.now, objects=[fell]))
    look(bench, 2)
    assert ended(bench).outcome == ("delivered" if clean else "failed")


@pytest.mark.parametrize("fell", [False, True])
def test_a_mission_that_knocked_something_over_is_not_called_done(fell: bool) -> None:
    bench = brought()
    context = bench.brain.context
    context.mission.delivery.around = {"yellow can": standing([CAN], BASE, 10.0)["yellow can"]}
    after = can(position=(1.08, 0.2, 0.63), tilt=math.pi / 2) if fell else CAN
    seen = msgspec.structs.replace(after, seen_at=bench.now)
    bench.send(topics.WORLD_OBJECTS, m.WorldObjects(t=bench.now, objects=[seen]))
    look(bench, 2)
    last = ended(bench)
    assert last.outcome == ("failed" if fell else "delivered")
    assert ("KNOCKED_OVER" in last.reason) is fell
    assert ("COMPLETED" in bench.states()) is not fell
    if fell:
        bench.until(lambda: "the yellow can fell over" in bench.texts(SPEECH)[-1])


@pytest.mark.parametrize(("beside", "late", "mistaken"), [(0.05, True, True), (0.3, True, False), (0.05, False, False)])
def test_a_thing_found_again_where_it_was_taken_from_was_not_what_the_hand_put_down(
    beside: float, late: bool, mistaken: bool
) -> None:
    bench = brought()
    context = bench.brain.context
    item, found = next(iter(context.mission.search.found.items()))
    x, y, z = found.position
    context.mission.delivery.absent = {"red mug 1": ((x + beside, y, z), bench.now)}
    again = msgspec.structs.replace(found, seen_at=bench.now + (1.0 if late else -1.0))
    context.mission.search.found[item] = again
    look(bench, 2)
    last = ended(bench)
    assert last.outcome == ("failed" if mistaken else "delivered")
    assert ("TOOK_ANOTHER" in last.reason) is mistaken
