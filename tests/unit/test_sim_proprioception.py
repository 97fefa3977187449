"""What the arm and the hand feel of themselves: small errors that repeat for a seed."""

import numpy as np

from services.sim.fingers import COUNTS
from services.sim.proprioception import ENCODER_ZERO, Proprioception

EFFORTS = np.array([105.0] * 4 + [52.0] * 3)


def test_encoders_are_off_by_a_constant_and_noise() -> None:
    felt = Proprioception(3, EFFORTS)
    read = np.array([felt.angles(np.full(7, 0.5)) for _ in range(2000)]) - 0.5
    zero = read.mean(axis=0)
    assert (np.abs(zero) < 1.1 * ENCODER_ZERO).all() and np.abs(zero).max() > 0.3 * ENCODER_ZERO
    assert (np.abs(read.std(axis=0) / 2e-4 - 1.0) < 0.1).all()


def test_a_seed_repeats_and_another_robot_differs() -> None:
    first, again, other = (Proprioception(seed, EFFORTS).angles(np.zeros(7)) for seed in (5, 5, 6))
    assert (first == again).all() and (first != other).any()


def test_efforts_are_noisy_by_a_share_of_the_largest() -> None:
    felt = Proprioception(0, EFFORTS)
    read = np.array([felt.efforts(np.zeros(7)) for _ in range(2000)]).std(axis=0)
    assert (np.abs(read / (0.005 * EFFORTS) - 1.0) < 0.1).all()


def test_the_width_is_within_half_a_millimetre_and_keeps_still_while_the_pads_do() -> None:
    felt = Proprioception(1, EFFORTS)
    true = np.concatenate([np.linspace(0.0, 0.085, 300), np.linspace(0.085, 0.0, 300)])
    told = np.array([felt.width(round(w / 0.085 * COUNTS) / COUNTS * 0.085) for w in true])
    error = told - true
    assert np.abs(error).max() <= 0.00052 and error.std() > 0.0001
    assert (told >= 0.0).all()
    assert len({felt.width(0.0733) for _ in range(50)}) == 1
