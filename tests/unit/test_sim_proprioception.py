"""What the arm and the hand feel of themselves: small errors that repeat for a seed."""

import numpy as np

from services.sim.body import COUNTS
from services.sim.sensors import ENCODER_ZERO, Proprioception

EFFORTS = np.array([105.0] * 4 + [52.0] * 3)


def readings(seed: int, count: int, angle: float = 0.5) -> np.ndarray:
    """Errors (count, 22) of readings of an arm at rest."""
    felt, true = Proprioception(seed, EFFORTS), np.concatenate((np.full(7, angle), np.zeros(14), [20.0]))
    return np.array([felt.read(true) for _ in range(count)]) - true


def test_encoders_are_off_by_a_constant_and_noise() -> None:
    read = readings(3, 2000)[:, :7]
    zero = read.mean(axis=0)
    assert (np.abs(zero) < 1.1 * ENCODER_ZERO).all() and np.abs(zero).max() > 0.3 * ENCODER_ZERO
    assert (np.abs(read.std(axis=0) / 2e-4 - 1.0) < 0.1).all()


def test_a_seed_repeats_and_another_robot_differs() -> None:
    first, again, other = (readings(seed, 3) for seed in (5, 5, 6))
    assert (first == again).all() and (first != other).any() and (first[0] != first[1]).all()


def test_speeds_efforts_and_the_finger_are_noisy_each_in_its_own_measure() -> None:
    read = readings(0, 2000)
    assert np.abs(read[:, 7:].mean(axis=0)).max() < 0.05
    deviation = read.std(axis=0)
    assert (np.abs(deviation[7:14] / 2e-3 - 1.0) < 0.1).all()
    assert (np.abs(deviation[14:21] / (0.005 * EFFORTS) - 1.0) < 0.1).all()
    assert abs(deviation[21] / 0.4 - 1.0) < 0.1


def test_the_width_is_within_half_a_millimetre_and_keeps_still_while_the_pads_do() -> None:
    felt = Proprioception(1, EFFORTS)
    true = np.concatenate([np.linspace(0.0, 0.085, 300), np.linspace(0.085, 0.0, 300)])
    told = np.array([felt.width(round(w / 0.085 * COUNTS) / COUNTS * 0.085) for w in true])
    error = told - true
    assert np.abs(error).max() <= 0.00052 and error.std() > 0.0001
    assert (told >= 0.0).all()
    assert len({felt.width(0.0733) for _ in range(50)}) == 1
