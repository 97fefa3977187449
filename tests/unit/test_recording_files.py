"""A recording that keeps its newest part only."""

from pathlib import Path

from cli.recordings.record import PARTS, RecordingFiles
from common import messages as m
from common import topics
from common.bus import codec
from common.recording import Recorder, Recording


def write(recorder: Recorder, n: int) -> None:
    state = m.BrainState(state="WAITING", detail=f"number {n}")
    recorder.write(topics.BRAIN_STATE.key, codec.encode(topics.BRAIN_STATE, state), float(n), float(n))


def test_one_file_grows_where_nothing_is_dropped(tmp_path: Path) -> None:
    files = RecordingFiles(tmp_path / "run.mcap")
    write(files.recorder, 1)
    assert not files.full
    files.recorder.close()
    assert [p.name for p in tmp_path.iterdir()] == ["run.mcap"]


def test_the_oldest_file_goes_and_the_others_are_whole(tmp_path: Path) -> None:
    files = RecordingFiles(tmp_path / "run.mcap", keep=1)
    finished: list[Path] = []
    for n in range(PARTS + 3):
        write(files.recorder, n)
        assert files.full
        files.turn_over(lambda done: finished.append(done.path))
    write(files.recorder, 99)
    files.recorder.close()
    left = sorted(tmp_path.iterdir())
    assert len(left) == PARTS and left[0].name == "run.005.mcap" and len(finished) == PARTS + 3
    for path, n in zip(left, [*range(4, PARTS + 3), 99], strict=True):
        assert [row.t for row in Recording(path).rows] == [float(n)]
