"""Missions to episodes, and episodes to a dataset that others open: `tidybot record --lerobot`."""

import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from cli.demonstrations.sampler import Episode, Frame, Picture, Sampler
from cli.errors import CliError
from common import messages as m
from common.demonstration import ACTION, STATE

pq = pytest.importorskip("pyarrow.parquet")
from cli.demonstrations.dataset import Dataset  # noqa: E402
from cli.demonstrations.statistics import merged, of_pictures, of_values  # noqa: E402

SIZE = (8, 6)
CAMERAS = {"head": SIZE, "wrist": SIZE}


def joints(t: float) -> m.JointStates:
    position = [t + i for i in range(len(STATE))]
    return m.JointStates(t=t, name=list(STATE), position=position, velocity=[0.0] * 11, effort=[0.0] * 11)


def rgbd(t: float, camera: str, grey: int = 128) -> m.Rgbd:
    width, height = SIZE
    rgb = bytes([grey]) * (width * height * 3)
    return m.Rgbd(
        t=t, id="x", camera=camera, width=width, height=height, fx=1, fy=1, cx=1, cy=1, position=(0, 0, 0),
        orientation=(1, 0, 0, 0), rgb=rgb, depth=b"",
    )  # fmt: skip


def state(mission: str, command: str, t: float = 0.0, outcome: Any = None) -> m.BrainState:
    last = m.MissionOutcome(id=mission, command=command, outcome=outcome, t=t) if outcome else None
    return m.BrainState(state="PLANNING", t=t, mission_id=mission, command=command, last=last)


def run(sampler: Sampler, begin: float, end: float, every: float = 0.1) -> None:
    """Joint states at 100 Hz, a picture of each camera now and then."""
    for tick in range(round(begin * 100), round(end * 100)):
        if tick % round(every * 100) == 0:
            for camera in ("head", "wrist"):
                sampler.take(rgbd(tick / 100, camera))
        sampler.take(joints(tick / 100))


def test_a_mission_is_an_episode_at_the_rate_asked_for() -> None:
    sampler = Sampler(10, ("head", "wrist"))
    run(sampler, 0, 5)
    assert not sampler.recording
    sampler.take(state("m.1", "bring me the red mug"))
    assert sampler.recording
    run(sampler, 5, 8)
    assert sampler.ended() == []
    sampler.take(state("m.1", "bring me the red mug", outcome="delivered"))
    (episode,) = sampler.ended()
    assert (episode.task, episode.outcome, len(episode.frames)) == ("bring me the red mug", "delivered", 30)
    assert np.allclose(np.diff([f.t for f in episode.frames]), 0.1)
    assert all(set(f.pictures) == {"head", "wrist"} for f in episode.frames) and episode.late < 0.06
    assert episode.frames[3].state == [episode.frames[3].t + i for i in range(11)]
    assert not sampler.recording and sampler.ended() == []


def test_the_action_is_what_was_commanded_as_long_as_it_counts() -> None:
    sampler = Sampler(10, ("head",))
    run(sampler, 0, 1)
    sampler.take(state("m.1", "x"))
    sampler.take(m.Odometry(t=1.0, x=0, y=0, theta=0, vx=0.1, vy=0.2, omega=0.3))
    sampler.take(m.ArmCommand(position=[9.0] * 7))
    sampler.take(m.GripperCommand(position=1.0))
    run(sampler, 1, 3)
    sampler.take(state("m.1", "x", outcome="failed"))
    first, *_, last = sampler.ended()[0].frames
    assert len(first.action) == len(ACTION)
    assert first.action == [0.1, 0.2, 0.3, *[9.0] * 7, 1.0]
    assert last.action[3:10] == last.state[3:10], "a stream that has fallen silent means hold"


def test_frames_before_the_first_picture_are_left_out_and_late_pictures_told() -> None:
    sampler = Sampler(10, ("head",))
    sampler.take(state("m.1", "x"))
    for tick in range(200):
        sampler.take(joints(tick / 100))
        if tick in (100, 150):
            sampler.take(rgbd(tick / 100, "head"))
    sampler.take(state("m.1", "x", outcome="delivered"))
    (episode,) = sampler.ended()
    assert 0 < len(episode.frames) < 20
    assert 0.2 < episode.late <= 1.0


def test_a_stop_of_another_mission_ends_nothing_and_the_next_mission_begins_anew() -> None:
    sampler = Sampler(10, ("head",))
    run(sampler, 0, 1)
    sampler.take(state("m.2", "y", outcome=None))
    sampler.take(m.BrainState(state="WAITING", last=m.MissionOutcome(id="m.1", command="x", outcome="failed")))
    assert sampler.recording
    run(sampler, 1, 2)
    sampler.take(state("m.2", "y", outcome="cancelled"))
    assert [e.outcome for e in sampler.ended()] == ["cancelled"]


def episode(task: str, count: int, grey: int = 100, outcome: str = "delivered") -> Episode:
    picture = Picture(0.0, *SIZE, bytes([grey]) * (SIZE[0] * SIZE[1] * 3))
    frames = [
        Frame(i / 10, [float(i)] * len(STATE), [float(-i)] * len(ACTION), {"head": picture, "wrist": picture})
        for i in range(count)
    ]
    return Episode("m", task, frames, outcome)


def test_what_is_written_is_the_documented_layout(tmp_path: Path) -> None:
    root = tmp_path / "set"
    dataset = Dataset(root, 10, CAMERAS)
    dataset.add(episode("bring me the mug", 5))
    dataset.add(episode("tidy up", 3, grey=200, outcome="failed"))
    info = json.loads((root / "meta/info.json").read_text())
    assert (info["codebase_version"], info["fps"], info["total_episodes"], info["total_frames"]) == ("v3.0", 10, 2, 8)
    assert info["splits"] == {"train": "0:2"} and info["total_tasks"] == 2
    rows: list[dict[str, Any]] = []
    for number, length in enumerate((5, 3)):
        table = pq.read_table(root / info["data_path"].format(chunk_index=0, file_index=number))
        assert set(table.column_names) == set(info["features"])
        assert len(table) == length
        rows += table.to_pylist()
    assert [r["index"] for r in rows] == list(range(8))
    assert [r["episode_index"] for r in rows] == [0] * 5 + [1] * 3
    assert [r["frame_index"] for r in rows] == [*range(5), *range(3)]
    assert [r["task_index"] for r in rows] == [0] * 5 + [1] * 3
    assert np.allclose([r["timestamp"] for r in rows[:5]], np.arange(5) / 10)
    assert [r["next.done"] for r in rows] == [False] * 4 + [True] + [False] * 2 + [True]
    assert [r["next.success"] for r in rows] == [False] * 4 + [True] + [False] * 3
    assert rows[6]["observation.state"] == [1.0] * 11 and rows[6]["action"] == [-1.0] * 11
    seen = Image.open(io.BytesIO(rows[0]["observation.images.head"]["bytes"]))
    assert (seen.size, seen.format) == (SIZE, "JPEG") and np.abs(np.asarray(seen).astype(int) - 100).max() < 4
    episodes = pq.read_table(root / "meta/episodes/chunk-000/file-000.parquet").to_pylist()
    assert [(e["dataset_from_index"], e["dataset_to_index"], e["length"]) for e in episodes] == [(0, 5, 5), (5, 8, 3)]
    assert [e["tasks"] for e in episodes] == [["bring me the mug"], ["tidy up"]]
    tasks = pq.read_table(root / "meta/tasks.parquet")
    assert tasks.column("task").to_pylist() == ["bring me the mug", "tidy up"]
    assert json.loads(tasks.schema.metadata[b"pandas"])["index_columns"] == ["task"]
    stats = json.loads((root / "meta/stats.json").read_text())
    assert stats["observation.state"]["max"] == [4.0] * 11 and stats["observation.state"]["count"] == [8]
    assert np.shape(stats["observation.images.head"]["mean"]) == (3, 1, 1)
    assert np.isclose(stats["observation.images.head"]["mean"][0][0][0], (5 * 100 + 3 * 200) / 8 / 255)


def test_a_dataset_is_continued_and_what_does_not_fit_is_refused(tmp_path: Path) -> None:
    root = tmp_path / "set"
    Dataset(root, 10, CAMERAS).add(episode("a", 4))
    again = Dataset(root, 10, CAMERAS)
    again.add(episode("b", 2))
    again.add(episode("a", 1))
    assert (again.episodes, again.frames) == (3, 7)
    assert [r["task_index"] for r in pq.read_table(root / "data/chunk-000/file-002.parquet").to_pylist()] == [0]
    with pytest.raises(CliError, match="another fps"):
        Dataset(root, 20, CAMERAS)
    with pytest.raises(CliError, match="another features"):
        Dataset(root, 10, {"head": SIZE})
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "thesis.txt").write_text("mine")
    with pytest.raises(CliError, match="not empty"):
        Dataset(tmp_path / "other", 10, CAMERAS)
    (root / "meta/info.json").write_text("{")
    with pytest.raises(CliError, match="not a dataset"):
        Dataset(root, 10, CAMERAS)


def test_an_interrupted_episode_leaves_the_dataset_as_it_was(tmp_path: Path) -> None:
    root = tmp_path / "set"
    dataset = Dataset(root, 10, CAMERAS)
    dataset.add(episode("a", 4))
    before = (root / "meta/info.json").read_text()
    dataset.add(episode("b", 2))
    (root / "meta/info.json").write_text(before)  # as if it had ended before its last file
    again = Dataset(root, 10, CAMERAS)
    assert (again.episodes, again.frames) == (1, 4)
    again.add(episode("c", 3))
    rows = pq.read_table(root / "meta/episodes/chunk-000/file-000.parquet").to_pylist()
    assert [(r["episode_index"], r["tasks"]) for r in rows] == [(0, ["a"]), (1, ["c"])]


def test_statistics_of_parts_are_those_of_the_whole() -> None:
    values = np.random.default_rng(3).normal(2.0, 5.0, (90, 4))
    parts = [of_values(values[:20]), of_values(values[20:25]), of_values(values[25:])]
    whole, found = of_values(values), merged(parts)
    for name in ("min", "max", "mean", "std", "count"):
        assert np.allclose(found[name], whole[name]), name


def test_statistics_of_pictures_are_between_0_and_1() -> None:
    black = Picture(0.0, 2, 1, bytes(6))
    red = Picture(0.0, 2, 1, bytes([255, 0, 0] * 2))
    found = of_pictures([black, red])
    assert found["mean"] == [[[0.5]], [[0.0]], [[0.0]]] and found["max"][0] == [[1.0]] and found["count"] == [2]
