"""Grasp verification by the gripper's width and force: nothing between the fingers, an object held, an object lost."""

import math
from typing import Literal

from common.kinds import kind_of
from common.robot.grip import EMPTY_WIDTH, Grip
from services.manipulation.config import ManipulationConfig

TOO_WIDE = 0.006
"""How much wider [m] than the object the fingers may stand, else they are on a handle or a rim. Chosen: more than the
corners of a round wall, less than any handle adds."""
MEASURED = 0.006
"""How far [m] a width found on a measured surface may be off beyond the spread of the measures. Chosen: two cells of
the completed surface, and the noise of depth at arm's length."""
WIDTH_ERROR = 0.0008
"""Most [m] that the width after the lift may be over what the object measures there: beyond it the hold is bad
(measured over reach-grasp-lift trials)."""
OFF_CENTRE = 0.019
"""How far [m] the middle of what is held may be from the middle of the pads: half their length. What is round feels as
narrow as its chord there."""
CHANGED = 0.4
"""Share of a width that was read off an incomplete surface which is felt at least. Chosen: half seen it may be thought
twice as wide."""
CLOSED = 0.0035
"""Width [m] up to which the pads may be on each other (measured: they read 2.9 mm where they met askew)."""
TURNING = 0.012
"""By how much less [m] something may be held than when the fingers closed, once it has turned its narrow side to them.
Chosen: ovals of a hand's width are 6 to 10 mm wider than deep; what slips out goes on."""
NARROWER = 1 / 3
"""Most of its width that it has less then: what loses more is no oval, the pads slide off it. Chosen."""
FLEX = 0.003
"""Most [m] that it may be under that: the motor goes on by 2 mm while the fingers' linkage gives under the grip."""


def judge(
    grip: Grip,
    nominal: float,
    at_close: float | None,
    config: ManipulationConfig,
    doubt: float = 0.0,
    certain: bool = False,
) -> Literal["", "EMPTY_GRASP", "SLIPPED"]:
    """The failure code of a grasp on something `nominal` metres wide; "" when it is good.

    `at_close` is the width when the fingers had closed: after the lift it must not have changed. A `nominal` of 0 is
    a rim of unknown slope, which turns between the fingers as its weight comes on them. `doubt` [m] is how far off
    `nominal` may be where it was measured; `certain`: as the width of a whole shape, not of a part of a surface.
    """
    if grip.empty:
        return "SLIPPED" if at_close is not None and at_close > EMPTY_WIDTH else "EMPTY_GRASP"
    if not grip.pressing:
        return "EMPTY_GRASP" if at_close is None else "SLIPPED"
    if nominal > 0 and at_close is not None and abs(grip.width - at_close) > config.slip_width:
        return "SLIPPED"
    if nominal > 0 and grip.width < least_width(nominal, doubt, certain):
        return "SLIPPED"
    if nominal > 0 and grip.width > nominal + TOO_WIDE + doubt:
        # On a handle or a rim, not around the body.
        return "EMPTY_GRASP" if at_close is None else "SLIPPED"
    return ""


def settled(grip: Grip, at_close: float, config: ManipulationConfig) -> float:
    """The width [m] that is held once something has come off its surface, `at_close` before: what is no circle turns
    its narrow side between the pads then, and stays so.
    """
    narrower = at_close - grip.width
    turned = config.slip_width < narrower < min(TURNING, NARROWER * at_close)
    return grip.width if grip.holds() and turned else at_close


def least_width(nominal: float, doubt: float, certain: bool) -> float:
    """Least width [m] between pads that are on the body of something `nominal` wide there, and not on its handle."""
    if not certain:
        return max(CHANGED * (nominal - doubt), min(CLOSED, CHANGED * nominal))
    return 2 * math.sqrt(max(0.0, (nominal / 2) ** 2 - OFF_CENTRE**2)) - doubt


def held_badly(grip: Grip, nominal: float, kind: str) -> bool:
    """The lifted object is not held around its body: its width differs from `nominal` [m] there, as on a handle."""
    over = grip.width - nominal
    return nominal > 0 and not -FLEX <= over <= WIDTH_ERROR + kind_of(kind).facets
