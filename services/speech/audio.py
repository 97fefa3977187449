"""Recordings in and out: WAV files checked and brought to 16 kHz mono int16."""

import struct
import wave
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

RATE = 16000
MIN_RATE, MAX_RATE = 4000, 192000
Samples = NDArray[np.int16]


class AudioError(ValueError):
    """A recording that cannot be used; the message names it and the reason."""


def read_wav(path: Path) -> Samples:
    """A PCM WAV file as 16 kHz mono.

    Raises:
        AudioError: missing, empty, truncated, or not PCM.
    """
    try:
        with wave.open(str(path), "rb") as file:
            channels, width, rate, frames, _, _ = file.getparams()
            raw = file.readframes(frames)
    except FileNotFoundError:
        raise AudioError(f"{path}: no such file") from None
    except (wave.Error, EOFError, struct.error, RuntimeError) as error:  # RuntimeError: a seek beyond a chunk's end
        raise AudioError(f"{path}: not a PCM WAV file ({error or 'it ends too early'})") from None
    except OSError as error:
        raise AudioError(f"{path}: {error.strerror}") from None
    if not frames or not raw:
        raise AudioError(f"{path}: the recording is empty")
    if len(raw) < frames * channels * width:
        raise AudioError(f"{path}: truncated, {len(raw)} of {frames * channels * width} bytes")
    if not MIN_RATE <= rate <= MAX_RATE:
        raise AudioError(f"{path}: {rate} samples a second; {MIN_RATE} to {MAX_RATE} are expected")
    if width not in (1, 2, 4):
        raise AudioError(f"{path}: samples of {8 * width} bit; 16 bit is expected")
    if width == 2:
        samples: NDArray[Any] = np.frombuffer(raw, "<i2").astype(np.float32)
    elif width == 1:
        samples = (np.frombuffer(raw, np.uint8).astype(np.float32) - 128) * 256
    else:
        samples = np.frombuffer(raw, "<i4").astype(np.float32) / 65536
    return resample(samples.reshape(-1, channels).mean(axis=1), rate)


def resample(samples: NDArray[Any], rate: int) -> Samples:
    """Samples at `rate` Hz as int16 at 16 kHz."""
    if rate != RATE:
        from scipy.signal import resample_poly

        ratio = Fraction(RATE, rate)
        samples = resample_poly(samples, ratio.numerator, ratio.denominator)
    return np.clip(np.round(samples), -32768, 32767).astype(np.int16)


def write_wav(path: Path, samples: Samples) -> None:
    """16 kHz mono int16 as a WAV file."""
    with wave.open(str(path), "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(RATE)
        file.writeframes(samples.tobytes())
