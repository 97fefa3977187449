"""From nothing to a map in lockstep: simulation, camera, navigation and mapping in one process."""

from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("gtsam", reason="the extra mapping is not installed")
pytest.importorskip("small_gicp", reason="the extra mapping is not installed")

from common.household import load_household
from common.scene import load_scene
from evaluation.homes.explore import explore
from evaluation.homes.map_errors import HEIGHT, OUTLINE, WALL, compare


@pytest.mark.slow
@pytest.mark.timeout(1500)
def test_a_small_home_is_mapped_from_nothing(tmp_path: Path) -> None:
    scene = load_scene("minimal")
    explored = explore(scene, 20007, tmp_path, limit=400.0)
    assert explored.status.phase == "done" and explored.hits == []
    errors = compare(load_household(str(tmp_path / "household.toml")), scene)
    assert errors.missed == []
    assert np.median(errors.walls) < WALL
    assert max(errors.heights) < HEIGHT and max(errors.outlines) < OUTLINE
    assert (tmp_path / "map.yaml").exists() and (tmp_path / "pose_graph.json").exists()
