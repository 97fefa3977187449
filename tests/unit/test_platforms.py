"""`python -m tests.platforms` tells a version without wheels from a package index that does not answer."""

from pathlib import Path

import pytest

from tests import platforms


@pytest.fixture
def answers(monkeypatch: pytest.MonkeyPatch) -> dict[tuple[str, ...], str]:
    """What uv says, by the options that it is given."""
    said: dict[tuple[str, ...], str] = {}
    monkeypatch.setattr(platforms, "_resolve", lambda lock, python, architecture, *options: said[options])
    return said


def unresolved() -> str:
    return platforms.unresolved(Path("any.lock"), "3.12", "aarch64")


def test_the_cache_is_enough(answers: dict[tuple[str, ...], str]) -> None:
    answers["--offline",] = ""
    assert unresolved() == ""


def test_what_the_cache_does_not_know_is_asked_for(answers: dict[tuple[str, ...], str]) -> None:
    answers["--offline",] = "Packages were unavailable because the network was disabled."
    answers[()] = "numpy==1.26.0 has no usable wheels"
    assert "no usable wheels" in unresolved()


def test_an_index_that_does_not_answer_is_no_verdict(
    answers: dict[tuple[str, ...], str], capsys: pytest.CaptureFixture[str]
) -> None:
    answers["--offline",] = "Packages were unavailable because the network was disabled."
    answers[()] = "error: Request failed after 3 retries"
    with pytest.raises(ConnectionError):
        unresolved()
    assert platforms.main() == 0
    assert "not checked" in capsys.readouterr().out


def test_a_platform_without_wheels_fails(
    answers: dict[tuple[str, ...], str], capsys: pytest.CaptureFixture[str]
) -> None:
    answers["--offline",] = "there is no version of moonshine-cpp==0.1.4"
    answers[()] = "moonshine-cpp==0.1.4 has no wheels with a matching platform tag"
    assert platforms.main() == 1
    assert capsys.readouterr().out.count("matching platform tag") == 16
