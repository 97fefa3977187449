"""`tidybot map`: what it prints, and what it says to those who mistype."""

import msgspec
import numpy as np
import pytest

from cli.home.map import contents, line, terminal
from cli.main import main
from common import messages as m
from common.files.map_file import FREE, OCCUPIED, UNKNOWN
from common.household import load_household


def test_the_progress_is_one_line() -> None:
    status = m.MappingStatus(t=133.0, phase="exploring", area=34.21, frontiers=5, keyframes=80, loops=3)
    assert line(status) == "exploring    34.2 m2 of floor, 5 places left to look at, 80 keyframes, 3 loops, 02:13"


def test_the_map_is_drawn_with_the_north_above() -> None:
    cells = np.full((8, 6), FREE, np.uint8)
    cells[7, :], cells[0, 0], cells[:2, 5] = OCCUPIED, OCCUPIED, UNKNOWN
    assert terminal(cells) == ["######", "......", "......", "#.... "]
    wide = terminal(np.full((300, 400), FREE, np.uint8))
    assert all(len(row) <= 72 for row in wide)
    assert terminal(np.zeros((1, 1), np.uint8)) == []


def test_it_says_what_there_is_in_each_room() -> None:
    home = load_household("apartment")
    rows = dict(row.strip().split(": ") for row in contents(home))
    assert set(rows) == {room.name for room in home.rooms}
    assert sorted(name for row in rows.values() for name in row.split(", ")) == sorted(r.name for r in home.receptacles)
    bare = msgspec.structs.replace(home, receptacles=home.receptacles[:1], rooms=home.rooms[:0])
    assert contents(bare) == [f"  elsewhere: {home.receptacles[0].name}"]


def test_nothing_to_go_on_with_is_said(tmp_path: "pytest.TempPathFactory", capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["map", "--resume", str(tmp_path), "--out", str(tmp_path)]) == 1
    assert "no pose_graph.json there" in capsys.readouterr().err
