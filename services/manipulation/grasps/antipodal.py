"""Antipodal grasps on a measured surface: two opposite places that both pads lie on, whatever the object is.

In the manner of ten Pas and Platt, "Using geometry to detect grasp poses in 3D point clouds", ISRR 2015, with the
approaches that a mobile robot has: from above and from its side, the fingers level.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from common.geometry import Array
from common.kinds import kind_of
from services.manipulation.arm.arm_model import Pose
from services.manipulation.grasps.clearance import PAD
from services.manipulation.grasps.grasp import Grasp, approach_rotation, on_handle, upper_end
from services.manipulation.grasps.grasp_verification import MEASURED
from services.manipulation.grasps.grasped_object import PART
from services.manipulation.grasps.pads import CELL, CELLS, LONGEST, PLAY, Contacts, Wanted, contacts
from services.manipulation.grasps.parts import across_parts
from services.manipulation.grasps.surface import guessed_along, surface
from services.manipulation.grasps.target import Target

TILTS = (90, 75, 60, 45, 30, 15)
"""How far below horizontal [deg] the hand comes."""
BEARINGS = (0, 25, -25, 50, -50, 75, -75)
"""From where [deg], off the way from the arm to the object, except straight from above."""
ROLLS = tuple(range(-90, 90, 15))
"""How far the fingers are turned [deg] from above."""
LEANING, FARTHEST, LEAST_ROLL = (75, 65), 55, 20
"""Tilts [deg] with which the fingers are turned as well, by more than that, to take what is low and lies across the way
to it: from straight above the arm does not reach what is on a counter, nor steeper than 60 what is on a worktop of 0.9
m. What is round lies across no way: of a plate the last would take its slope. Chosen: one finger is then 8 to 11 mm
lower than the other on either side of 20 mm."""
LEVER = 0.08
"""Farthest [m] to the side of an object's middle, in any direction: held by its neck a bottle of 0.3 kg that lay swings
by 35 degrees."""
KEPT, APART, TURNED = 40, 0.012, math.radians(20)
"""How many grasps are proposed, and from where on [m, rad] two of them are different ones."""
MOST_UPWARD, LAID_DOWN = 0.25, 0.75
"""Sine of the steepest upward approach with which an object can be put down upright, and what it costs when it has to
be put down as it lies: more than good contacts are worth."""
GUESSED = 0.4
"""What a grasp costs whose pads close along the way from the eye where the far side was not seen, as much as two
thirds of a pad less on the surface: a spray bottle that was taken so was 75 mm deep and not 37."""
LOW = 0.09
"""Height [m] up to which an object is better taken from above."""
LEAST_SHARE, OF_PART = 0.25, 0.33
"""Least share of a pad that lies on the surface, and of the parts of something that is too wide for the hand: a ball of
40 mm and the tube of a ring have .33 to .5, the edge of something, and the sloping rim of a plate, less."""
OF_LOW = 0.66
"""That share of what pads can touch of something that is lower than they are long: two of three cells of a blade."""
THIN, FINGER = 0.008, 0.022
"""Width [m] below which a part of something thicker is the noise of its outline, less than a hoop's, and the depth of a
finger behind its pad (Robotiq 2F-85)."""
CHORD = 0.5
"""Share of a ball's extent below which no chord of it is held: what is narrower is something else beside it, or its
outermost cap, which slips out of the pads."""
VAGUE = 0.4
"""What it costs to take a part that may be nothing but doubt in its width: what good contacts are worth, less that the
only part there is is taken still."""
SLOPING = 0.25
"""Steepest surface, as a tangent, under the pads of a grasp by rule: fingers slid up a cone of 17 degrees."""
SLIPPERY, SLIDES = 0.35, 3.0
"""Tangent from which a surface costs more, and how much where it is steeper by 1: what was measured as 23 degrees is as
often 30, which is beyond the cone of friction."""
SHAPELESS = ("long", "irregular")
"""Families of which a rectangle around them does not tell how their parts lie."""
ASIDE = 0.008
"""Distance [m] of places across something that is too wide for the hand, of which parts are taken: a quarter of the
pads' height."""


def antipodal(target: Target, forward: float, opening: float, widest: float) -> list[Grasp]:
    """Grasps on the completed surface of an object, the best first; empty when it is nowhere narrow enough.

    `forward`: where the arm stands on the base [m]; `opening`: how far apart the fingers go, `widest`: what fits [m].
    """
    points, centre = surface(target), np.array(target.position)
    facing = math.atan2(target.position[1], target.position[0] - forward)
    most = OF_LOW * min(1.0, max(1, round((target.size[2] - PLAY) / CELL[1])) / CELLS[1])
    least, guessed = THIN if min(target.size) > 2 * THIN else 0.0, guessed_along(target)
    if kind_of(target.kind).shape == "sphere":
        least = max(least, CHORD * min(target.size))
    balance = _balance(target, points - centre)
    found: list[_Found] = []
    for rotation, tilt, off, name in _directions(target, facing, _across(target, points)):
        if on_handle(target, rotation):
            continue
        blind = GUESSED * abs(float(rotation[:, 1] @ guessed)) if guessed is not None else 0.0
        upper = upper_end(target, rotation)
        less = blind + _from_below(upper, rotation)
        floor = rotation[2], target.bottom - target.position[2] + PLAY
        for there in _places((points - centre) @ rotation, floor, opening, (least, widest), most):
            if not len(there.at):
                continue
            arm = there.at @ rotation.T
            worth = _worth(target, there, arm - balance, tilt, off, widest) - less
            near = np.hypot(arm[:, 0], arm[:, 1]) <= LEVER
            found += [
                _Found(rotation, math.radians(tilt), name, upper, *row)
                for row in zip(*(a[near] for a in (there.at, centre + arm, there.width, worth)), strict=True)
            ]
    return [one.grasp(target.bottom) for one in _different(found)]


def _balance(target: Target, points: Array) -> Array:
    """Where (3,), level, from the middle of its extents an object is taken to be balanced: in the middle of its body
    (n, 3), which of what is thick at one end is nearer to that. How deep the body of what stands is, is a guess.
    """
    told = target.points is not None and target.family in SHAPELESS and target.size[2] < LOW
    found: Array = points.mean(axis=0) * (1.0, 1.0, 0.0) if told else np.zeros(3)
    return found


@dataclass(frozen=True)
class _Found:
    """A grasp in the making: the hand's rotation, tilt [rad], bearing in words, where the upper end comes to point;
    place along the hand's axes (3,) and in the base frame (3,), width [m], worth."""

    rotation: Array
    tilt: float
    bearing: str
    upper: float | None
    place: Array
    at: Array
    width: float
    worth: float

    def grasp(self, bottom: float) -> Grasp:
        """It over an object whose underside is at a height [m]."""
        along, across, deep = (1000 * float(v) for v in self.place)
        beside = f"{across:+.0f}/" if abs(across) > 1000 * LONGEST / 2 else ""
        return Grasp(
            Pose(self.at, self.rotation), float(self.width), float(self.at[2]) - bottom, self.tilt,
            f"{self.bearing}, {along:+.0f}/{beside}{deep:+.0f} mm", self.upper, on_surface=True,
            worth=float(self.worth),
        )  # fmt: skip


def _places(
    local: Array, floor: tuple[Array, float], opening: float, widths: tuple[float, float], most: float
) -> Iterator[Contacts]:
    """As `contacts` with a width from one to the other [m]; of what is wider than the fingers go the parts that have
    room for a finger on either side. No more than the share `most` of a pad is asked for.
    """
    low, high = float(local[:, 1].min()), float(local[:, 1].max())
    if high - low <= opening - 2 * PLAY:
        yield contacts(local, floor, opening, Wanted(widths, share=min(LEAST_SHARE, most)))
        return
    up = floor[0]
    # Farther to the side than this the hand is beyond the lever, wherever along it.
    farthest = LEVER * math.sqrt(1.0 - up[1] ** 2) + float(np.abs(local @ up).max() + PAD) * abs(up[1]) + ASIDE / 2
    local = local[np.argsort(local[:, 1])]
    for across in np.arange(low, high + ASIDE, ASIDE):
        if abs(across) > farthest:
            continue
        reach = opening / 2 + FINGER
        first, near, beyond, last = np.searchsorted(local[:, 1], across + np.array([-reach, -ASIDE, ASIDE, reach]))
        if near < beyond:
            there = (across - ASIDE / 2, across + ASIDE / 2)
            yield contacts(local[first:last], floor, opening, Wanted(widths, there, min(OF_PART, most)))


def _from_below(upper: float | None, rotation: Array) -> float:
    """What a grasp of something that lies costs when the hand would come from below it once that stands; `upper`: where
    its upper end points [rad]."""
    if upper is None:
        return 0.0
    lean = float(rotation[:2, 2] @ (math.cos(upper), math.sin(upper)))
    return LAID_DOWN if lean > MOST_UPWARD else 0.0


def _across(target: Target, points: Array) -> list[float]:
    """The level directions [rad] in which something is plainly taken: along its sides, and across its narrow parts."""
    sides = [target.yaw, target.yaw + math.pi / 2]
    return [*sides, *across_parts(points)] if target.points is not None and target.family in SHAPELESS else sides


def _directions(target: Target, facing: float, across: list[float]) -> Iterator[tuple[Array, int, float, str]]:
    """Rotations (3, 3) of the hand with their tilt [deg] and bearing [rad] off `facing`; `across` [rad]: along which
    the fingers close beside the usual."""
    own = [math.degrees(math.remainder(turn - facing - math.pi / 2, math.pi)) for turn in across]
    for roll in sorted({*ROLLS, *(round(angle, 1) for angle in own)}, key=abs):
        rotation = approach_rotation(facing, math.pi / 2, math.radians(roll))
        yield rotation, 90, 0.0, f"from above, fingers at {roll:+.0f}"
    leaning = LEANING if target.family in ("round", "bowl") and not target.lies else (*LEANING, FARTHEST)
    for tilt in leaning if target.size[2] < LOW else ():
        for roll in sorted({*ROLLS[::2], *(round(angle, 1) for angle in own)}, key=abs):
            if abs(roll) > LEAST_ROLL:
                rotation = approach_rotation(facing, math.radians(tilt), math.radians(roll))
                yield rotation, tilt, 0.0, f"{tilt} deg, fingers at {roll:+.0f}"
    sides = [math.degrees(math.remainder(target.yaw - facing + q * math.pi / 2, math.tau)) for q in range(4)]
    for tilt in TILTS[1:]:
        for bearing in sorted({*BEARINGS, *(round(s, 1) for s in sides if abs(s) < 105)}, key=abs):
            rotation = approach_rotation(facing + math.radians(bearing), math.radians(tilt))
            yield rotation, tilt, math.radians(bearing), f"{tilt} deg at {bearing:+.0f}"


def _worth(target: Target, there: Contacts, arm: Array, tilt: int, off: float, widest: float) -> Array:
    """How good grasps are (n,), about 1 for the best: what both pads touch counts most."""
    preferred = 90 if target.size[2] < LOW else 25
    lever = np.hypot(arm[:, 0], arm[:, 1]) + 0.3 * np.abs(arm[:, 2])
    tight = np.maximum(0.0, there.width + 2 * target.spread - widest + 0.008) / 0.008
    # Of a part that is hardly wider than its width is doubtful, one side may be that of something else.
    part = there.width < PART * min(target.size)
    vague = np.where(part, np.maximum(0.0, 1.0 - there.width / (2 * (MEASURED + 2 * target.spread))), 0.0)
    found: Array = (
        np.minimum(there.share, 0.75) - VAGUE * vague - 0.5 * there.slope - 4.0 * lever
        - SLIDES * np.maximum(0.0, there.slope - SLIPPERY) - 0.3 * np.minimum(tight, 1.0)
        - 0.2 * abs(tilt - preferred) / 90 - 0.15 * abs(off) / (math.pi / 2)
    )  # fmt: skip
    return found


def _different(found: Sequence[_Found]) -> list[_Found]:
    """The best of those that are alike, best first, at most `KEPT`."""
    kept: list[_Found] = []
    if not found:
        return kept
    at, turn = np.array([one.at for one in found]), np.array([one.rotation for one in found])
    left = np.argsort([-one.worth for one in found], kind="stable")
    while len(left) and len(kept) < KEPT:
        best = left[0]
        kept.append(found[best])
        left = left[~_alike(at[left] - at[best], turn[left], turn[best])]
    return kept


def _alike(apart: Array, turns: Array, turn: Array) -> NDArray[np.bool_]:
    """Which of the hands `apart` (n, 3) [m] from one, with rotations (n, 3, 3), take hold as that with (3, 3)."""
    # A parallel gripper holds the same with its fingers exchanged.
    closing, approach = np.abs(turns[:, :, 1] @ turn[:, 1]), turns[:, :, 2] @ turn[:, 2]
    found: NDArray[np.bool_] = (np.linalg.norm(apart, axis=1) <= APART) & (
        np.minimum(closing, approach) > math.cos(TURNED)
    )
    return found


def alike(a: Pose, b: Pose) -> bool:
    """Two poses of the hand take hold of the same place in the same way."""
    return bool(_alike((a.position - b.position)[None], a.rotation[None], b.rotation)[0])
