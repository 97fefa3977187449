"""Recordings: WAV files checked and brought to 16 kHz mono int16, which speech and everybody who speaks to it take."""

import struct
import wave
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

RATE = 16000
"""Samples per second of everything inside: what the networks were trained on."""
MIN_RATE, MAX_RATE = 4000, 192000
"""Samples per second that are accepted (chosen: telephone to studio)."""
ZERO_CROSSINGS, KAISER_BETA = 10, 5.0
"""Length of the filter to each side, and the shape of its window, as in `scipy.signal.resample_poly`."""
LARGEST = 64 * 2**20
"""Bytes of a file at most (chosen): half an hour of sound; a command lasts seconds."""
CHUNK = 16000
"""Outputs worked out at once, by which memory is bounded: a second of sound."""
Samples = NDArray[np.int16]


class AudioError(ValueError):
    """A recording that cannot be used; the message names it and the reason."""


def read_wav(path: Path) -> Samples:
    """A PCM WAV file as 16 kHz mono.

    Raises:
        AudioError: missing, empty, truncated, too large, or not PCM.
    """
    try:
        if (size := path.stat().st_size) > LARGEST:
            raise AudioError(f"{path}: {size >> 20} MB; a command lasts seconds")
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
    """Samples at `rate` Hz as int16 at 16 kHz, by a windowed sinc as `scipy.signal.resample_poly` has it.

    Importing scipy.signal for this alone takes 0.8 s and 30 MB.
    """
    if rate != RATE:
        ratio = Fraction(RATE, rate)
        samples = _polyphase(np.asarray(samples, np.float64), ratio.numerator, ratio.denominator)
    return np.clip(np.round(samples), -32768, 32767).astype(np.int16)


def _polyphase(samples: NDArray[np.float64], up: int, down: int) -> NDArray[np.float64]:
    """Samples (n,) at up / down times their rate (ceil(n * up / down),)."""
    widest = max(up, down)
    half = ZERO_CROSSINGS * widest
    taps = np.sinc(np.arange(-half, half + 1) / widest) * np.kaiser(2 * half + 1, KAISER_BETA)
    reach = -(-len(taps) // up)
    # Row p: what the samples before an output weigh whose place between two of them is p / up.
    phases = np.zeros((reach, up))
    phases.ravel()[: len(taps)] = taps * (up / taps.sum())
    weights = np.ascontiguousarray(phases.T)
    around = np.concatenate([np.zeros(reach), samples, np.zeros(reach + half // up + 1)])
    found = np.empty(-(-len(samples) * up // down))
    for start in range(0, len(found), CHUNK):
        at = np.arange(start, min(start + CHUNK, len(found))) * down + half
        newest = at // up + reach
        found[start : start + CHUNK] = (around[newest[:, None] - np.arange(reach)] * weights[at % up]).sum(axis=1)
    return found
