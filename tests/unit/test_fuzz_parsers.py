"""Files from outside: a recording of sound, a scene, a configuration. Usable, or refused with a reason."""

import random
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cli.errors import CliError
from cli.missions import audio as cli_audio
from common import config, scene
from common.sound import AudioError, read_wav
from services.navigation.config import NavigationConfig
from services.navigation.places import PlacesFile
from services.sim.config import SimConfig
from services.speech.config import SpeechConfig
from services.speech.speak.voice import Voice
from tests.sounds import write_wav

QUICK = settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))
WORDS = (
    "nan",
    "inf",
    "-1",
    "0",
    "1e400",
    "''",
    "true",
    "[]",
    "[[]]",
    "{}",
    "{a=1}",
    '"' + "x" * 5000 + '"',
    "\x00",
    "1979-05-27",
)


def damaged(whole: bytes, rng: random.Random) -> bytes:
    """Cut, flipped, doubled or padded."""
    data = bytearray(whole)
    kind = rng.randrange(4)
    if kind == 0:
        return bytes(data[: rng.randrange(len(data))])
    if kind == 1:
        for _ in range(rng.randint(1, 8)):
            data[rng.randrange(min(len(data), 60))] = rng.randrange(256)
        return bytes(data)
    if kind == 2:
        place = rng.randrange(len(data))
        return bytes(data[:place] + data[place // 2 :])
    return bytes(data) + rng.randbytes(50)


def retyped(text: str, rng: random.Random) -> str:
    """A TOML file with values replaced, lines lost, doubled or torn."""
    lines = text.splitlines()
    for _ in range(rng.randint(1, 3)):
        at = rng.randrange(len(lines))
        kind, line = rng.randrange(5), lines[at]
        if kind == 0 and "=" in line:
            lines[at] = line.partition("=")[0] + "= " + rng.choice(WORDS)
        elif kind == 1:
            del lines[at]
        elif kind == 2:
            lines.insert(at, line)
        elif kind == 3:
            lines[at] = line[: rng.randrange(len(line) + 1)]
        else:
            lines.insert(at, rng.choice(("[[objects]]", "[home]", "unknown = 3", "= 1", "[", "name = 5")))
        if not lines:
            break
    return "\n".join(lines)


def test_a_damaged_wav_is_sound_or_refused(tmp_path: Path) -> None:
    path, rng = tmp_path / "voice.wav", random.Random(5)
    write_wav(path, (8000 * np.sin(np.arange(4000) / 10)).astype(np.int16))
    whole, refused = path.read_bytes(), 0
    for _ in range(400):
        path.write_bytes(damaged(whole, rng))
        try:
            samples = read_wav(path)
        except AudioError as error:
            refused += 1
            assert "voice.wav" in str(error)
        else:
            assert samples.dtype == np.int16 and samples.ndim == 1
    assert refused > 50


@QUICK
@given(st.binary(max_size=200))
def test_any_bytes_are_sound_or_refused(data: bytes) -> None:
    with tempfile.TemporaryDirectory() as folder:
        for head in (b"", b"RIFF\xff\xff\x00\x00WAVEfmt \x10\x00\x00\x00\x01\x00\x01\x00"):
            path = Path(folder) / "x.wav"
            path.write_bytes(head + data)
            with pytest.raises(AudioError):
                read_wav(path)
            with pytest.raises(CliError):
                cli_audio.recorded(path)


@pytest.mark.parametrize("name", ["minimal", "apartment"])
def test_a_damaged_scene_is_a_scene_or_refused(tmp_path: Path, name: str) -> None:
    rng, path = random.Random(8), tmp_path / "flat.toml"
    text, refused = scene.scene_path(name).read_text(), 0
    for _ in range(150):
        path.write_text(retyped(text, rng))
        try:
            found = scene.load_scene(str(path))
        except scene.SceneError as error:
            refused += 1
            assert "flat.toml" in str(error)
        else:
            assert found.name is not None
    assert refused > 40


@pytest.mark.parametrize(
    ("section", "kind"),
    [("navigation", NavigationConfig), ("sim", SimConfig), ("speech", SpeechConfig), ("places", PlacesFile)],
)
def test_a_damaged_configuration_is_one_or_refused(tmp_path: Path, section: str, kind: Any) -> None:
    rng, path = random.Random(9), tmp_path / f"{section}.toml"
    text, refused = (config.DEFAULT_DIR / f"{section}.toml").read_text(), 0
    for _ in range(150):
        path.write_text(retyped(text, rng))
        try:
            config.load(section, kind, tmp_path, {})
        except config.ConfigError as error:
            refused += 1
            assert str(error)
    assert refused > 10


@QUICK
@given(
    st.dictionaries(st.text(max_size=20), st.text(max_size=40), max_size=3), st.lists(st.text(max_size=40), max_size=3)
)
def test_any_settings_are_settings_or_refused(environ: dict[str, str], words: list[str]) -> None:
    given_ = {f"TIDYBOT__{k}": v for k, v in environ.items()}
    try:
        changes = config.overrides(given_, words)
        for section, kind in (("sim", SimConfig), ("runtime", config.RuntimeConfig)):
            config.load(section, kind, config.DEFAULT_DIR, changes)
    except config.ConfigError as error:
        assert str(error)


@pytest.fixture(scope="module")
def voice() -> Callable[[str], Any]:
    return Voice().speak


@pytest.mark.parametrize(
    "text",
    [
        "9" * 400,
        "1" * 7,
        "-1e999",
        "",
        " ",
        "\u202e\x00",
        "漢字 🤖",
        "%s%n{0}",
        "$3.50 £¥€",
        "a" * 5000,
        "1/2/3 4:5:6 -7.8.9",
    ],
)
def test_the_voice_says_what_it_can_of_any_text(voice: Callable[[str], Any], text: str) -> None:
    samples = voice(text)
    assert samples.dtype == np.int16 and len(samples) > 1000
