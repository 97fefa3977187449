"""Recordings for the robot's ear."""

import wave
from pathlib import Path

import numpy as np
import pytest

from cli.errors import CliError
from cli.missions.audio import CHUNK, LEAD_IN, RATE, TRAILING, padded, read_wav
from cli.missions.demo import VOICE


def written(path: Path, samples: np.ndarray, rate: int = RATE, channels: int = 1, width: int = 2) -> Path:
    with wave.open(str(path), "wb") as file:
        file.setnchannels(channels)
        file.setsampwidth(width)
        file.setframerate(rate)
        file.writeframes(samples.astype({1: "u1", 2: "<i2", 4: "<i4"}[width]).tobytes())
    return path


def test_samples_come_back_as_they_were(tmp_path: Path) -> None:
    tone = np.arange(-3000, 3000, dtype=np.int16)
    assert np.array_equal(read_wav(written(tmp_path / "a.wav", tone)), tone)


def test_another_rate_and_stereo_become_16_khz_mono(tmp_path: Path) -> None:
    t = np.arange(48000) / 48000
    left = 8000 * np.sin(2 * np.pi * 440 * t)
    both = np.stack((left, left), axis=1).ravel()
    heard = read_wav(written(tmp_path / "a.wav", both, 48000, 2)).astype(float)
    assert len(heard) == RATE
    expected = 8000 * np.sin(2 * np.pi * 440 * np.arange(RATE) / RATE)
    assert np.abs(heard[500:-500] - expected[500:-500]).max() < 200


def test_broken_recordings_are_refused_with_the_reason(tmp_path: Path) -> None:
    tone = np.zeros(1600, np.int16)
    whole = written(tmp_path / "whole.wav", tone).read_bytes()
    (tmp_path / "short.wav").write_bytes(whole[:-100])
    (tmp_path / "head.wav").write_bytes(whole[:20])
    (tmp_path / "nothing.wav").write_bytes(b"")
    (tmp_path / "text.wav").write_text("hello")
    written(tmp_path / "empty.wav", tone[:0])
    written(tmp_path / "eight.wav", tone, width=1)
    for name, reason in (
        ("short.wav", "truncated"),
        ("head.wav", "not a PCM WAV"),
        ("nothing.wav", "not a PCM WAV"),
        ("text.wav", "not a PCM WAV"),
        ("empty.wav", "no sound"),
        ("eight.wav", "16 bit"),
        ("absent.wav", "no such file"),
    ):
        with pytest.raises(CliError, match=reason):
            read_wav(tmp_path / name)


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
