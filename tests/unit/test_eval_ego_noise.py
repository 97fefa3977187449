"""The robot in its own ears: louder the faster it drives, without a click between pieces, the same for a seed."""

import numpy as np
import pytest

from common.sound import RATE
from evaluation.person.ego_noise import DRIVE, FAN, FULL, LOOP, WHINE, EgoNoise
from evaluation.person.voice import loudness

SPEECH = 3000.0
QUIET = np.zeros(RATE, np.int16)


def level(noise: np.ndarray) -> float:
    """[dB] below speech."""
    return float(20 * np.log10(np.sqrt(np.mean(np.square(noise.astype(float)))) / SPEECH))


def heard(speed: float, seed: int = 3, samples: np.ndarray = QUIET) -> np.ndarray:
    return EgoNoise(seed, SPEECH).over(samples, speed)


def test_at_rest_there_is_the_fan_and_the_drive_grows_with_the_speed() -> None:
    assert level(heard(0.0)) == pytest.approx(FAN, abs=1.0)
    fast, slow = heard(FULL), heard(FULL / 4)
    assert level(fast) == pytest.approx(10 * np.log10(10 ** (FAN / 10) + 10 ** (DRIVE / 10)), abs=1.0)
    assert FAN < level(slow) < level(fast) - 6.0
    assert level(heard(-FULL)) == pytest.approx(level(fast), abs=0.1)
    assert level(heard(100.0)) < DRIVE + 7.0


def test_the_gears_whine_at_a_pitch_of_the_speed() -> None:
    for speed in (FULL, FULL / 2):
        spectrum = np.abs(np.fft.rfft(heard(speed).astype(float)))
        assert np.argmax(spectrum[200:1000]) + 200 == pytest.approx(WHINE * speed / FULL, abs=2)


def test_pieces_join_to_what_is_heard_in_one_piece() -> None:
    whole = np.arange(4000, dtype=np.int16)
    noise = EgoNoise(5, SPEECH)
    pieces = [noise.over(whole[i : i + 800], 0.3) for i in range(0, 4000, 800)]
    assert (np.concatenate(pieces) == heard(0.3, 5, whole)).all()
    long = EgoNoise(5, SPEECH)
    for _ in range(int(LOOP) + 2):
        last = long.over(QUIET, 0.0)
    assert level(last) == pytest.approx(FAN, abs=1.0)


def test_a_seed_repeats_and_nothing_overflows() -> None:
    assert (heard(0.2) == heard(0.2)).all() and (heard(0.2) != heard(0.2, 4)).any()
    loud = heard(FULL, 3, np.full(RATE, 32767, np.int16))
    assert loud.max() == 32767 and loud.min() > 0
    assert len(EgoNoise(1, SPEECH).over(np.zeros(0, np.int16), 0.1)) == 0


def test_loudness_is_that_of_the_words_and_not_of_the_pauses() -> None:
    words = (1000 * np.sign(np.sin(np.arange(8000)))).astype(np.int16)
    assert loudness(np.concatenate((QUIET, words, QUIET))) == pytest.approx(1000.0, rel=0.01)
    assert loudness(QUIET) == 0.0
