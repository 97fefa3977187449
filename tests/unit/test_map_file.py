"""The files of a map: map_server's format, and the same files out of a plan."""

import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from cli.errors import CliError
from cli.home.map import plan_to_map
from common.files.map_file import FREE, OCCUPIED, UNKNOWN, GridMap, picture, write_map
from common.household import load_household
from tests.map_server import read_map


def test_a_map_comes_back_as_it_was_written(tmp_path: Path) -> None:
    cells = np.random.default_rng(1).integers(0, 3, (7, 11)).astype(np.uint8)
    read = read_map(write_map(tmp_path, GridMap(cells, 0.05, (-1.25, 0.4))))
    assert (read.cells == cells).all() and read.resolution == 0.05 and read.origin == (-1.25, 0.4)


def test_the_picture_is_what_map_server_reads(tmp_path: Path) -> None:
    cells = np.full((4, 6), UNKNOWN, np.uint8)
    cells[0, 1], cells[3, 5] = OCCUPIED, FREE
    text = write_map(tmp_path, GridMap(cells, 0.1, (0.0, 0.0))).read_text()
    assert "image: map.pgm\n" in text and "origin: [0, 0, 0.0]\n" in text and "negate: 0\n" in text
    grey = np.asarray(Image.open(tmp_path / "map.pgm"))
    assert grey.shape == (4, 6)
    assert (grey[3, 1], grey[0, 5], grey[1, 1]) == (0, 254, 205), "the south is the picture's last row"


def test_a_plan_becomes_a_map_and_a_household(tmp_path: Path) -> None:
    made = plan_to_map("apartment", tmp_path)
    told = load_household(str(tmp_path / "household.toml"))
    assert told.receptacles == made.receptacles and told.things == ()
    grid = read_map(tmp_path / "map.yaml")

    def state(x: float, y: float) -> int:
        return int(grid.cells[int((y - grid.origin[1]) / 0.05), int((x - grid.origin[0]) / 0.05)])

    assert state(0.0, 0.0) == FREE and state(2.5, 1.0) == OCCUPIED and state(5.3, -0.75) == OCCUPIED
    rows = {r["name"]: r for r in json.loads((tmp_path / "surfaces.json").read_text())}
    assert rows["kitchen table"]["height"] == 0.72 and len(rows["kitchen table"]["outline"]) == 4
    assert rows["bin"]["height"] == 0.4 and rows["counter"]["reached_from"] == [[0.0, 1.0]]
    assert picture(grid.cells).size == (4 * grid.cells.shape[1], 4 * grid.cells.shape[0])
    added = np.asarray(Image.open(tmp_path / "map.png")) != np.asarray(picture(grid.cells))
    for r in made.receptacles:
        column, row = 4 * (r.center[0] - grid.origin[0]) / 0.05, len(added) - 4 * (r.center[1] - grid.origin[1]) / 0.05
        assert added[round(row) - 6 : round(row) + 6, round(column) - 15 : round(column) + 15].any(), r.name


def test_a_plan_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(CliError, match="nowhere"):
        plan_to_map(str(tmp_path / "nowhere.toml"), tmp_path)
