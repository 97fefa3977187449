"""What is in the hand outlives the process that closed it."""

from pathlib import Path

import numpy as np
import pytest

from services.manipulation.grasps.grasp import approach_rotation
from services.manipulation.grasps.grasp_store import GraspStore
from services.manipulation.grasps.grasped_object import GraspedObject
from tests.unit.test_manipulation_service import Arm

BOTTLE = GraspedObject(
    "green bottle", "bottle", approach_rotation(0.3, 0.2), np.array([0.0, 0.01, 0.084]), (0.064, 0.064, 0.2), 0.064, 0.1
)  # fmt: skip


@pytest.fixture
def told() -> list[str]:
    return []


def test_it_comes_back_as_it_was_while_the_fingers_stay_where_they_are(tmp_path: Path, told: list[str]) -> None:
    GraspStore(tmp_path / "state", told.append).keep(BOTTLE, 0.0638)
    found = GraspStore(tmp_path / "state", told.append).recall(0.0631, 0.004)
    assert found is not None and (found.label, found.kind, found.size) == ("green bottle", "bottle", BOTTLE.size)
    assert np.array_equal(found.rotation, BOTTLE.rotation) and np.array_equal(found.offset, BOTTLE.offset)
    assert GraspStore(tmp_path / "state", told.append).recall(0.05, 0.004) is None
    assert not told


def test_an_empty_hand_leaves_nothing(tmp_path: Path, told: list[str]) -> None:
    memo = GraspStore(tmp_path, told.append)
    memo.keep(BOTTLE, 0.0638)
    memo.keep(None, 0.085)
    assert memo.recall(0.0638, 0.004) is None and not list(tmp_path.iterdir())


@pytest.mark.parametrize("junk", [b"", b"\xff\x00", b"\x80", b"{}"])
def test_a_torn_file_is_none(junk: bytes, tmp_path: Path, told: list[str]) -> None:
    (tmp_path / "hand").write_bytes(junk)
    assert GraspStore(tmp_path, told.append).recall(0.0638, 0.004) is None


def test_where_nothing_can_be_written_it_says_so_and_goes_on(tmp_path: Path, told: list[str]) -> None:
    (tmp_path / "state").write_text("a file where the folder should be")
    memo = GraspStore(tmp_path / "state", told.append)
    memo.keep(BOTTLE, 0.0638)
    assert len(told) == 1 and memo.recall(0.0638, 0.004) is None


def test_a_fresh_process_knows_what_the_hand_holds(tmp_path: Path, told: list[str]) -> None:
    GraspStore(tmp_path, told.append).keep(BOTTLE, 0.0638)
    node = Arm(state_dir=tmp_path)
    node.width, node.force = 0.0636, 25.0
    node.step(0.1)
    assert node.ask("grab", "a.2").detail.startswith("already holding green bottle")
    assert (tmp_path / "hand").exists()
    other = Arm(state_dir=tmp_path)
    other.step(0.1)
    assert not (tmp_path / "hand").exists(), "an open hand holds nothing"
