"""Noise of the robot itself in its microphone: a fan all the time, motors and wheels while it drives."""

import numpy as np
from numpy.typing import NDArray

from common.sound import RATE, Samples
from evaluation.person.voice import Floats, hum

FAN, DRIVE = -25.0, -12.0
"""Levels at the microphone [dB relative to speech], of the fan and of the drive at `FULL` speed; chosen: 35 dB(A) of a
quiet computer and 48 of wheel drives, beside speech of 60."""
FULL = 0.5
"""Speed [m/s] at which the drive is as loud as that; its power grows with the square of the speed."""
WHINE = 620.0
"""Lowest tone of the gears at full speed [Hz], with two harmonics of half the power each; chosen: 20 teeth at 31 turns
a second."""
LOOP = 8.0
"""Length of the noise that is drawn once and repeated [s]."""


class EgoNoise:
    """The sounds of one robot, drawn from `seed`; speech of a person has the root mean square `loudness`."""

    def __init__(self, seed: int, loudness: float) -> None:
        rng = np.random.default_rng([seed, 31])
        count = round(LOOP * RATE)
        self._fan, self._wheels = hum(count, rng), rng.normal(0.0, 1.0, count)
        self._loudness, self._at, self._phase = loudness, 0, 0.0

    def over(self, samples: Samples, speed: float) -> Samples:
        """Samples (n,) as the microphone hears them while the base drives at `speed` [m/s]; pieces join smoothly."""
        count, share = len(samples), min(abs(speed) / FULL, 2.0)
        at = (self._at + np.arange(count)) % len(self._fan)
        self._at = int(at[-1] + 1) if count else self._at
        noise = _gain(FAN) * self._fan[at]
        if share > 0.0:
            noise = noise + _gain(DRIVE) * share * (self._wheels[at] + self._whine(count, share)) / np.sqrt(2.0)
        heard: Floats = samples + self._loudness * noise
        return np.clip(heard, -32768, 32767).astype(np.int16)

    def _whine(self, count: int, share: float) -> NDArray[np.float64]:
        """The gears' tones (n,), root mean square 1."""
        step = 2 * np.pi * WHINE * share / RATE
        phase = self._phase + step * np.arange(1, count + 1)
        self._phase = float(phase[-1] % (2 * np.pi)) if count else self._phase
        tones = np.sin(phase) + np.sqrt(0.5) * (np.sin(2 * phase) + np.sin(3 * phase))
        return np.asarray(tones)


def _gain(level: float) -> float:
    return float(10 ** (level / 20))
