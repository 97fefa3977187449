"""WAV files for tests."""

import wave
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from common.sound import RATE


def write_wav(path: Path, samples: NDArray[Any], rate: int = RATE, channels: int = 1, width: int = 2) -> Path:
    """Samples (n * channels,), scaled to `width` bytes each already, as a PCM file."""
    with wave.open(str(path), "wb") as file:
        file.setnchannels(channels)
        file.setsampwidth(width)
        file.setframerate(rate)
        file.writeframes(samples.astype({1: "u1", 2: "<i2", 4: "<i4"}[width]).tobytes())
    return path
