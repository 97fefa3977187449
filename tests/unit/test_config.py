from pathlib import Path

import pytest

from common import config


class Parameters(config.Config, frozen=True):
    speed: float = 0.5
    name: str = "a"
    names: tuple[str, ...] = ()
    retries: int = 3


def load(tmp_path: Path, text: str = "", environ: dict[str, str] | None = None, *settings: str) -> Parameters:
    if text:
        (tmp_path / "part.toml").write_text(text)
    return config.load("part", Parameters, tmp_path, config.overrides(environ or {}, settings))


def test_defaults_without_a_file(tmp_path: Path) -> None:
    assert load(tmp_path) == Parameters()


def test_later_sources_win(tmp_path: Path) -> None:
    found = load(tmp_path, "speed = 1.0\nretries = 4", {"TIDYBOT__PART__SPEED": "2"}, "part.speed=3", "other.x=1")
    assert (found.speed, found.retries) == (3.0, 4)


def test_values_are_toml_and_else_text(tmp_path: Path) -> None:
    found = load(tmp_path, "", {}, 'part.names=["a", "b"]', "part.name=red mug")
    assert (found.names, found.name) == (("a", "b"), "red mug")


def test_a_number_may_be_a_name(tmp_path: Path) -> None:
    assert load(tmp_path, "", {}, "part.name=7").name == "7"


@pytest.mark.parametrize(
    ("text", "environ", "setting", "expected"),
    [
        ("sped = 1", {}, "", r"part\.toml: unknown key 'sped'; known keys: name, names, retries, speed"),
        ("speed = 'x'", {}, "", r"part\.toml: Expected `float`, got `str` - at `\$\.speed`"),
        ("speed = ", {}, "", r"part\.toml: not valid TOML"),
        ("", {"TIDYBOT__PART__RETRIES": "many"}, "", "TIDYBOT__PART__RETRIES: Expected `int`"),
        ("", {"TIDYBOT__PART": "1"}, "", "expected TIDYBOT__<SECTION>__<KEY>"),
        ("", {}, "part.nothing=1", "--set part.nothing: unknown key"),
        ("", {}, "speed", "expected section.key=value"),
    ],
)
def test_what_cannot_be_used_names_source_and_key(
    tmp_path: Path, text: str, environ: dict[str, str], setting: str, expected: str
) -> None:
    with pytest.raises(config.ConfigError, match=expected):
        load(tmp_path, text, environ, *([setting] if setting else []))


class Described(config.Config, frozen=True):
    """Two parameters."""

    speed: float = 0.5
    """Largest
    speed [m/s]."""
    names: dict[str, str] = {}
    """Said -> meant."""


def test_parameters_are_told_with_what_they_are() -> None:
    assert config.described(Described) == {"speed": (0.5, "Largest speed [m/s]."), "names": ({}, "Said -> meant.")}
