"""Recordings for the robot's ear."""

from pathlib import Path

import numpy as np
import pytest

from cli.errors import CliError
from cli.missions.audio import CHUNK, LEAD_IN, TRAILING, padded, recorded
from cli.missions.demo import VOICE
from common.sound import RATE, read_wav
from tests.sounds import write_wav


def test_a_recording_that_cannot_be_used_is_refused_with_the_reason(tmp_path: Path) -> None:
    for content, reason in ((b"hello", "not a PCM WAV"), (None, "no such file")):
        path = tmp_path / f"{reason}.wav"
        if content is not None:
            path.write_bytes(content)
        with pytest.raises(CliError, match=reason):
            recorded(path)


def test_a_recording_is_chunks_of_what_it_says(tmp_path: Path) -> None:
    tone = np.arange(-3000, 3000, dtype=np.int16)
    assert recorded(write_wav(tmp_path / "a.wav", tone)) == padded(tone)


def test_chunks_are_full_and_surrounded_by_silence() -> None:
    loud = np.full(1234, 1000, np.int16)
    chunks = padded(loud)
    assert {len(c) for c in chunks} == {2 * round(CHUNK * RATE)}
    whole = np.frombuffer(b"".join(chunks), "<i2")
    start = round(LEAD_IN * RATE)
    assert not whole[:start].any()
    assert np.array_equal(whole[start : start + 1234], loud)
    assert len(whole) - start - 1234 >= TRAILING * RATE
    assert not whole[start + 1234 :].any()


def test_the_shipped_recording_is_sound() -> None:
    samples = read_wav(VOICE)
    assert 1.0 < len(samples) / RATE < 4.0
    assert np.abs(samples).max() > 8000
    assert VOICE.stat().st_size < 150_000
