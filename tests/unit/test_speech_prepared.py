"""What speech works out of packages once: kept, worked out again when it has to differ, and done without a place."""

import tempfile
from pathlib import Path

import pytest

from common import speech_weights
from services.speech import prepared as module
from services.speech.prepared import prepared

FILE = "networks"


@pytest.fixture
def works(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> list[Path]:
    """The folders that were worked into; places are `first` and `second`."""
    into: list[Path] = []

    def work_out(folder: Path) -> None:
        into.append(folder)
        (folder / FILE).write_text("x", encoding="ascii")

    places = (tmp_path / "first" / "weights", tmp_path / "second" / "weights")
    monkeypatch.setattr(module, "_work_out", work_out)
    (tmp_path / "temporary").mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "temporary"))
    monkeypatch.setattr(speech_weights, "places", lambda: places)
    return into


def test_it_is_worked_out_once_and_kept(works: list[Path], tmp_path: Path) -> None:
    with prepared() as first, prepared() as second:
        assert first == second and first.parent == tmp_path / "first"
    assert (first / FILE).exists() and len(works) == 1
    assert [path.name for path in first.parent.iterdir()] == [first.name], "nothing half done is left"


def test_of_two_processes_at_once_the_first_is_kept(
    works: list[Path], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def work_out(folder: Path) -> None:
        (folder / FILE).write_text("second", encoding="ascii")
        if not works:
            works.append(folder)
            with prepared() as first:
                (first / FILE).write_text("first", encoding="ascii")

    monkeypatch.setattr(module, "_work_out", work_out)
    with prepared() as folder:
        assert (folder / FILE).read_text(encoding="ascii") == "first"
    assert [path.name for path in (tmp_path / "first").iterdir()] == [folder.name]


def test_other_code_or_packages_have_it_worked_out_again(works: list[Path], monkeypatch: pytest.MonkeyPatch) -> None:
    with prepared() as old:
        pass
    monkeypatch.setattr(module, "version", lambda package: "next")
    with prepared() as new:
        assert new != old and len(works) == 2
    assert not old.exists(), "what is outdated takes no room"


def test_a_place_that_cannot_be_written_is_passed_over(works: list[Path], tmp_path: Path) -> None:
    (tmp_path / "first").write_text("a file", encoding="ascii")
    with prepared() as folder:
        assert folder.parent == tmp_path / "second"
    (tmp_path / "second" / folder.name / FILE).unlink()
    (tmp_path / "second" / folder.name).rmdir()
    (tmp_path / "second").rmdir()
    (tmp_path / "second").write_text("a file", encoding="ascii")
    with prepared() as scratch:
        assert (scratch / FILE).exists()
    assert not scratch.exists(), "a temporary folder goes with the block"


def test_what_could_not_be_worked_out_is_told_and_not_kept(
    works: list[Path], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def fail(folder: Path) -> None:
        raise speech_weights.WeightsError("no memory")

    monkeypatch.setattr(module, "_work_out", fail)
    with pytest.raises(speech_weights.WeightsError, match="no memory"), prepared():
        pass
    assert list((tmp_path / "first").iterdir()) == []


def test_memory_is_no_place(works: list[Path], monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    with prepared() as folder:
        assert folder.parent == tmp_path
    assert not (tmp_path / "first").exists()
