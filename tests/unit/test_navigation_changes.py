"""What has changed since the map was made: lasting things become a part of it, passing ones do not."""

from pathlib import Path

import msgspec
import numpy as np
import pytest

from common.geometry import Rectangle
from services.navigation.localisation.map_fit import MapFit
from services.navigation.planning.changes import SAVE_PERIOD, Changes, ChangesFile
from services.navigation.planning.costmap import Costmap
from tests.unit.navigation_flat import ANGLES, SCENE, Flat, cast, rectangles

CHAIR = Rectangle(0.9, -1.6, 0.45, 0.45, 0.3)
PLAN = rectangles(SCENE, 0.2)
FRONT = (0.85, -1.3)
"""On the side of the chair that is seen from HERE."""
HERE = (0.0, 0.0, 0.0)


def look(costmap: Costmap, now: float, boxes: list[Rectangle]) -> None:
    costmap.obstacles.see(HERE, ANGLES, cast(HERE, PLAN + boxes), 10.0, now)


def costmap() -> Costmap:
    return Costmap(SCENE, 0.05, memory=30.0, lasting_after=300.0)


def stands(found: Costmap) -> bool:
    return found.clearance(CHAIR.x, CHAIR.y) < 0.3 and not found.obstacles.empty


def test_what_stands_there_for_long_is_remembered_out_of_sight() -> None:
    found = costmap()
    look(found, 0.0, [CHAIR])
    wall = Rectangle(0.6, -1.0, 1.6, 0.05, 0.9)
    look(found, 100.0, [wall])
    look(found, 301.0, [CHAIR])
    assert stands(found) and found.obstacles.changes.lasting.any()
    look(found, 900.0, [wall])
    assert stands(found), "hidden for ten minutes"
    look(found, 901.0, [])
    assert not found.obstacles.changes.lasting.any() and found.obstacles.empty, "seen to be gone"


def test_who_stands_there_now_and_then_is_no_furniture() -> None:
    found = costmap()
    for now in range(0, 900, 10):
        look(found, float(now), [CHAIR] if now % 100 < 60 else [])
    assert not found.obstacles.changes.lasting.any()


def test_a_person_who_stands_for_long_does_not_become_furniture() -> None:
    found = costmap()
    for now in (0.0, 100.0, 301.0):
        person = [(CHAIR.x, CHAIR.y, 0.5)]
        found.obstacles.see(HERE, ANGLES, cast(HERE, [*PLAN, CHAIR]), 10.0, now, person)
    assert not found.obstacles.empty and not found.obstacles.changes.lasting.any()


def test_a_place_found_anew_forgets_the_brief_and_keeps_the_lasting() -> None:
    found = costmap()
    look(found, 0.0, [CHAIR])
    found.obstacles.forget()
    assert found.obstacles.empty
    look(found, 1.0, [CHAIR])
    look(found, 302.0, [CHAIR])
    found.obstacles.forget()
    assert stands(found)


def test_lasting_changes_are_kept_on_disk_for_their_map_alone(tmp_path: Path) -> None:
    said: list[str] = []
    kept, file = Changes((40, 30), 10.0), ChangesFile(tmp_path, SCENE, said.append)
    assert file.load(kept) == 0
    cells = np.array([3, 4]), np.array([7, 7])
    kept.occupied(cells, 0.0)
    file.save(kept, 1.0)
    assert not list(tmp_path.iterdir()), "nothing lasts yet"
    kept.occupied(cells, 11.0)
    file.save(kept, 12.0)
    kept.passed(cells)
    file.save(kept, 12.0 + SAVE_PERIOD / 2)
    kept.occupied(cells, 0.0)
    kept.occupied(cells, 11.0)
    fresh = Changes((40, 30), 10.0)
    assert ChangesFile(tmp_path, SCENE, said.append).load(fresh) == 2
    assert (fresh.lasting == kept.lasting).all()
    renamed = msgspec.structs.replace(SCENE, name="ours", rooms=())
    moved = msgspec.structs.replace(SCENE, walls=SCENE.walls[1:])
    assert ChangesFile(tmp_path, renamed, said.append).load(Changes((40, 30), 10.0)) == 2
    assert ChangesFile(tmp_path, moved, said.append).load(Changes((40, 30), 10.0)) == 0
    assert not said


def test_a_file_that_is_damaged_is_told_and_left(tmp_path: Path) -> None:
    said: list[str] = []
    kept, file = Changes((9, 9), 0.0), ChangesFile(tmp_path, SCENE, said.append)
    kept.occupied((np.array([1]), np.array([1])), 0.0)
    file.save(kept, 0.0)
    (path,) = tmp_path.iterdir()
    path.write_text("{")
    assert ChangesFile(tmp_path, SCENE, said.append).load(Changes((9, 9), 0.0)) == 0
    assert len(said) == 1


def test_the_next_process_goes_round_what_the_last_one_learnt(tmp_path: Path) -> None:
    flat = Flat(boxes=[CHAIR], state_dir=tmp_path, lasting_after=2.0)
    flat.step(4.0)
    again = Flat(state_dir=tmp_path)
    costmap = again.service.map
    assert costmap.clearance(*FRONT) < 0.15 and not (costmap.static_distance <= 0)[costmap.cell(*FRONT)]
    assert flat.service.state.map_fit.share > 0.9


def test_the_fit_of_the_map_is_that_of_the_last_metres() -> None:
    fit = MapFit()
    for _ in range(100):
        fit.see(HERE, 0.2)
    assert fit.share > 0.9, "one place says little"
    for k in range(100):
        fit.see((0.3 * k, 0.0, 0.0), 0.5)
    assert fit.share == pytest.approx(0.5, abs=0.05)
