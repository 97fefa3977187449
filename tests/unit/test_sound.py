"""Recordings of any form become 16 kHz mono; what is none is refused with the reason."""

import struct
from pathlib import Path

import numpy as np
import pytest

from common import sound
from common.sound import RATE, AudioError, read_wav
from tests.sounds import write_wav


def test_samples_come_back_as_they_were(tmp_path: Path) -> None:
    tone = np.arange(-3000, 3000, dtype=np.int16)
    assert np.array_equal(read_wav(write_wav(tmp_path / "a.wav", tone)), tone)


def test_another_rate_and_stereo_become_16_khz_mono(tmp_path: Path) -> None:
    t = np.arange(48000) / 48000
    left = 8000 * np.sin(2 * np.pi * 440 * t)
    both = np.stack((left, left), axis=1).ravel()
    heard = read_wav(write_wav(tmp_path / "a.wav", both, 48000, 2)).astype(float)
    assert len(heard) == RATE
    expected = 8000 * np.sin(2 * np.pi * 440 * np.arange(RATE) / RATE)
    assert np.abs(heard[500:-500] - expected[500:-500]).max() < 200


def test_recordings_of_other_forms_are_brought_to_16_khz_mono(tmp_path: Path) -> None:
    tone = (np.sin(np.arange(44100) * 2 * np.pi * 440 / 44100) * 20000).astype("<i2")
    path = tmp_path / "stereo.wav"
    write_wav(path, np.repeat(tone, 2), 44100, 2)
    samples = read_wav(path)
    assert len(samples) == RATE
    spectrum = np.abs(np.fft.rfft(samples.astype(float)))
    assert int(spectrum.argmax()) == 440


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        (None, "no such file"),
        (b"", "not a PCM WAV file"),
        (b"RIFF", "not a PCM WAV file"),
        (b"this is no sound at all, just words in a file", "not a PCM WAV file"),
    ],
)
def test_what_is_no_recording_is_named(tmp_path: Path, content: bytes | None, expected: str) -> None:
    path = tmp_path / "x.wav"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(AudioError, match=expected):
        read_wav(path)


def test_empty_and_truncated_recordings_are_named(tmp_path: Path) -> None:
    path = tmp_path / "x.wav"
    write_wav(path, np.zeros(0, np.int16))
    with pytest.raises(AudioError, match="empty"):
        read_wav(path)
    write_wav(path, np.ones(RATE, np.int16))
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) // 2])
    with pytest.raises(AudioError, match=r"truncated|not a PCM"):
        read_wav(path)
    path.write_bytes(whole[:22] + struct.pack("<H", 0) + whole[24:])
    with pytest.raises(AudioError):
        read_wav(path)


def test_samples_of_other_widths_are_scaled_to_16_bit(tmp_path: Path) -> None:
    loud = np.array([0, 64, 192], np.int64)
    assert read_wav(write_wav(tmp_path / "8.wav", loud, width=1)).tolist() == [-32768, -16384, 16384]
    assert read_wav(write_wav(tmp_path / "32.wav", (loud - 128) << 24, width=4)).tolist() == [-32768, -16384, 16384]


def test_what_is_no_command_by_its_size_is_not_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = write_wav(tmp_path / "long.wav", np.ones(RATE, np.int16))
    monkeypatch.setattr(sound, "LARGEST", 1000)
    with pytest.raises(AudioError, match="a command lasts seconds"):
        read_wav(path)
