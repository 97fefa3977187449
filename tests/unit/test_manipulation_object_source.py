"""Which object a goal means, and of what kind it is taken to be."""

from types import SimpleNamespace
from typing import Any

import pytest
from msgspec import structs

from common.config import config_dir
from common.household import load_household, load_words, mapped
from common.messages import ManipulationGoal, ObjectPose, ObjectRef, WorldObject, WorldObjects
from services.brain.steps.find import object_ref
from services.manipulation.planning.object_source import ObjectSource

LISTED = load_household("apartment")
UNLISTED = mapped(LISTED, load_words(config_dir()))
AT = (4.0, -3.0, 0.8)
SEEN = WorldObject(label="red toy", kind="toy", colour="red", position=AT, size=(0.07, 0.07, 0.1), seen_at=5.0)


def source() -> ObjectSource:
    found = ObjectSource(UNLISTED)
    found.update(WorldObjects(t=5.0, objects=[SEEN]))
    return found


@pytest.mark.parametrize("since", [4.0, 9.0])
def test_what_an_object_was_asked_for_as_is_its_kind(since: float) -> None:
    goal = ManipulationGoal(goal="grab", object=ObjectRef(label="red toy", position=AT, kind="mug"))
    found = source().resolve(goal, "", (0.0, 0.0, 0.0), since)
    assert found is not None
    assert found.kind == "mug"


@pytest.mark.parametrize("since", [4.0, 9.0])
def test_without_that_it_is_what_it_looks_like(since: float) -> None:
    goal = ManipulationGoal(goal="grab", object=ObjectRef(label="red toy", position=AT))
    found = source().resolve(goal, "", (0.0, 0.0, 0.0), since)
    assert found is not None
    assert found.kind == "toy"


@pytest.mark.parametrize(("off", "held", "measured", "same"), [
    (0.03, False, True, True), (0.07, False, True, False), (0.03, True, True, False), (0.03, False, False, False),
])  # fmt: skip
def test_what_is_called_otherwise_from_nearer_is_grasped_where_it_was_seen_last(
    off: float, held: bool, measured: bool, same: bool
) -> None:
    known, there = source(), (AT[0] + off, AT[1], AT[2])
    renamed = structs.replace(SEEN, label="red can", position=there, seen_at=9.0, held=held, measured=measured)
    known.update(WorldObjects(t=9.0, objects=[renamed]))
    goal = ManipulationGoal(goal="grab", object=ObjectRef(label="red toy", position=AT))
    found = known.resolve(goal, "", (0.0, 0.0, 0.0), 8.0)
    assert found is not None
    assert (found.label, found.position) == ("red toy", there if same else AT)


def asked(item: str, label: str, household: Any) -> str:
    pose = ObjectPose(query_id="q", found=True, label=label, position=AT)
    search = SimpleNamespace(found={item: pose})
    ctx: Any = SimpleNamespace(mission=SimpleNamespace(search=search), io=SimpleNamespace(household=household))
    ref = object_ref(ctx, item)
    assert ref is not None
    return ref.kind


def test_the_brain_tells_what_it_was_asked_for() -> None:
    assert asked("red mug", "red toy", UNLISTED) == "mug"
    assert asked("red cup", "red mug", LISTED) == "mug"
    assert asked("something red", "red toy", UNLISTED) == ""


def test_what_was_pulled_is_there_until_it_is_seen_elsewhere_than_it_was() -> None:
    known = source()
    pulled = structs.replace(SEEN, position=(3.8, -3.0, 0.8), seen_at=7.0)
    known.moved(SEEN, pulled)
    assert known.objects() == [pulled]
    # Half hidden by the arm it is said to be where it was.
    known.update(WorldObjects(t=8.0, objects=[structs.replace(SEEN, seen_at=8.0)]))
    assert known.objects() == [pulled]
    seen = structs.replace(SEEN, position=(3.79, -3.01, 0.8), seen_at=9.0)
    known.update(WorldObjects(t=9.0, objects=[seen]))
    assert known.objects() == [seen]
