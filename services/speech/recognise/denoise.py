"""Stationary noise (fans, motors, hiss) taken out of an utterance.

Decision-directed Wiener filter: Ephraim and Malah, "Speech enhancement using a minimum mean-square error short-time
spectral amplitude estimator", 1984; Scalart and Filho, "Speech enhancement based on a priori signal to noise
estimation", 1996.
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float32]
WINDOW, HOP = 512, 128
"""Samples of a frame (32 ms) and between two: root-Hann windows overlap by three quarters."""
SMOOTHING = 0.96
"""Weight of the frame before in the a-priori ratio (Ephraim and Malah have 0.98)."""
FLOOR = 0.3
"""Least gain (chosen: lower ones leave musical tones)."""
MIN_NOISE_FRAMES = 8
"""Frames without speech from which a spectrum of noise is estimated (chosen)."""
MIN_NOISE = 2048
"""Samples without speech from which the loudness of noise is estimated (chosen: 128 ms)."""
_HANN = np.sqrt(np.hanning(WINDOW + 1)[:-1])


def reduce_noise(audio: Array, speech: tuple[int, int]) -> Array:
    """`audio` (n,) with the noise that is heard outside of `speech` (first and last sample) taken out of all of it."""
    if len(audio) < 2 * WINDOW:
        return audio
    padded = np.pad(audio.astype(np.float64), (WINDOW, 2 * WINDOW))
    count = (len(padded) - WINDOW) // HOP + 1
    index = np.arange(count)[:, None] * HOP + np.arange(WINDOW)
    spectrum = np.fft.rfft(padded[index] * _HANN, axis=1)
    power = np.abs(spectrum) ** 2
    start = np.arange(count) * HOP - WINDOW
    whole = (start >= 0) & (start + WINDOW <= len(audio))
    quiet = whole & ((start + WINDOW <= speech[0]) | (start >= speech[1]))
    noise = noise_power(power[whole], power[quiet])
    clean = np.empty_like(spectrum)
    before = np.zeros(power.shape[1])
    for k in range(count):
        posterior = power[k] / noise
        prior = SMOOTHING * before / noise + (1 - SMOOTHING) * np.maximum(posterior - 1, 0)
        gain = np.maximum(prior / (1 + prior), FLOOR)
        clean[k] = gain * spectrum[k]
        before = np.abs(clean[k]) ** 2
    frames = np.fft.irfft(clean, WINDOW, axis=1) * _HANN
    out = np.zeros(len(padded))
    for k in range(count):
        out[k * HOP : k * HOP + WINDOW] += frames[k]
    found: Array = (out[WINDOW : WINDOW + len(audio)] * (2 * HOP / WINDOW)).astype(np.float32)
    return found


def noise_ratio(audio: Array, speech: tuple[int, int]) -> float:
    """Speech to noise [dB] from the loudness in and outside of `speech`; infinite when nothing is outside."""
    outside = np.concatenate([audio[: speech[0]], audio[speech[1] :]]).astype(np.float64)
    inside = audio[speech[0] : speech[1]].astype(np.float64)
    noise = float(np.mean(outside**2)) if len(outside) >= MIN_NOISE else 0.0
    if noise <= 0:
        return float("inf")
    return 10 * float(np.log10(max(float(np.mean(inside**2)) - noise, 1e-12) / noise))


def noise_power(every: NDArray[np.float64], quiet: NDArray[np.float64]) -> NDArray[np.float64]:
    """Mean noise power per frequency (f,) from frames without speech, or else from the quietest frames of all."""
    if len(quiet) >= MIN_NOISE_FRAMES:
        mean = quiet.mean(axis=0)
    else:
        # Noise power is exponentially distributed: its 20 % quantile is -ln(0.8) of the mean.
        mean = np.quantile(every, 0.2, axis=0) / -np.log(0.8)
    found: NDArray[np.float64] = np.maximum(mean, 1e-12)
    return found
