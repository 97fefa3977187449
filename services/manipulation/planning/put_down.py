"""How what is held may be turned where it is put down. Pure."""

import math
from dataclasses import dataclass

import numpy as np

from common.geometry import Array, turn_matrix, yaw_matrix
from services.manipulation.grasps.grasped_object import GraspedObject

TURNS = (0.0, 0.5, -0.5, 1.0, -1.0, 2.0, -2.0, np.pi)
"""How far [rad] the hand is turned about the vertical, off the way from the arm to the spot, in the order of trying."""
LEANS = tuple(math.radians(degrees) for degrees in (15, 30, 45, 60))
"""How far [rad] the hand is tipped away from the arm, with what it holds, where it cannot come as it grasped: from
straight above it comes to nothing that is higher than 0.85 m, and from 60 degrees to what is on a worktop."""
SPINS, TRIED = 24, 4
"""In how many directions what is tipped is turned, and how many of these, those it falls least from, are tried."""
ON_THE_WAY = (0.25, 0.5, 0.75, 1.0)
"""Shares of how far it is tipped at which that is looked at: tipped over its edge a box lies on its side at last."""
FALLS = 0.008
"""How far [m] the middle of what is let go may come down until it lies: less than the centimetre that counts as
dropped."""


@dataclass(frozen=True)
class PutDown:
    """The held object over a spot (x, y): turned from how it was grasped by `turn` (3, 3), by `spin` [rad] of it about
    the vertical; `raised` [m]: how much higher its middle is so than as it stood."""

    spot: tuple[float, float]
    turn: Array
    spin: float
    raised: float = 0.0


def turned(held: GraspedObject, spot: tuple[float, float], heading: float) -> PutDown:
    """It stands as it stood, the hand pointing to `heading` [rad]."""
    approach = held.rotation[:, 2]
    # Straight down has no azimuth of its own: the hand's x axis points away from the robot there.
    level = approach if np.hypot(approach[0], approach[1]) > 0.2 else held.rotation[:, 0]
    spin = float(heading - np.arctan2(level[1], level[0]))
    return PutDown(spot, yaw_matrix(spin), spin)


def tipped(held: GraspedObject, spot: tuple[float, float], bearing: float, lean: float) -> list[PutDown]:
    """It is tipped by `lean` [rad] so that the hand comes more from the arm's side, those first from which it falls
    back least; empty where it would fall back, or over, from there or on the way there."""
    axis = np.array([math.sin(bearing), -math.cos(bearing), 0.0])
    tips = [turn_matrix(share * lean * axis) for share in ON_THE_WAY]
    found, upright = [], held.reaches(np.eye(3))
    for spin in np.linspace(0.0, math.tau, SPINS, endpoint=False):
        turns = [tip @ yaw_matrix(float(spin)) for tip in tips]
        rises = [held.reaches(turn) - upright for turn in turns]
        # Lower again than it was on the way, it is past its balance.
        falls = max(*map(abs, rises), 2 * (max(rises) - rises[-1]))
        found.append((falls, float(spin), turns[-1]))
    least = sorted(found, key=lambda entry: entry[:2])[:TRIED]
    # A finger is lower than what it holds: the way goes on down from there until one or the other is felt.
    return [PutDown(spot, turn, spin, FALLS) for raised, spin, turn in least if raised < FALLS]
