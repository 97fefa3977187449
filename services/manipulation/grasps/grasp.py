"""A grasp: where the hand goes and what it holds there; and what of an object tells how it may be held."""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from common import messages as m
from common.geometry import Array, Pose2, matrix_quat, quat_matrix, yaw_quat
from common.kinds import KINDS, Kind, kind_of
from services.manipulation.arm.arm_model import Pose
from services.manipulation.grasps.target import Target

HANDLE_CONE = math.radians(50)
"""Angle [rad] between a finger and a handle below which the finger would land on it. Chosen: a handle's width and a
finger's, seen from the axis of a mug."""
HANDLE_ROOM, HANDLE_POINTS = 0.008, 4
"""How far [m] beyond the wall of a round object, and how many points there are, that a handle is taken to be: a finger
goes through one, noise and the fit's error do not reach as far."""
CERTAIN = 0.006
"""Largest spread [m] of measured extents from which an object is said to be too wide without a try."""
POOR = 0.0
"""Worth of a grasp on a surface below which a part, as a handle, or another stance is looked for. Chosen: that of pads
of which half lies on a slope that they just do not slide off; of pliers and an iron that were lost it was -.12 to
-.27."""
USUAL_VESSEL = KINDS["bowl"]
"""Whose wall is taken for that of a vessel of a kind that has none."""


@dataclass(frozen=True)
class Grasp:
    """Where the pinch point goes, how wide the object is there, and its height above the object's underside.

    `axis`: where the upper end of a lying object points [rad]; None when it stands. `turns_over`: it stands on its
    upper end, and is turned about the hand's approach before it is put down. `rim`: one finger is inside the
    object, `width` is that of its wall; `on_surface`: found on the measured surface and not by the rule of a kind;
    `over_edge`: one finger is below the object, which has to reach over the edge of its surface; `worth`: how good one
    on the surface is, about 1 for the best.
    """

    pose: Pose
    width: float
    height: float
    tilt: float
    name: str
    axis: float | None = None
    rim: bool = False
    on_surface: bool = False
    turns_over: bool = False
    over_edge: bool = False
    worth: float = 0.0


def approach_rotation(azimuth: float, tilt: float, roll: float = 0.0) -> Array:
    """Rotation (3, 3) that approaches along `azimuth`, `tilt` downward of horizontal.

    `roll` turns the fingers about the approach, counter-clockwise seen from behind the hand.
    """
    ca, sa, ct, st = math.cos(azimuth), math.sin(azimuth), math.cos(tilt), math.sin(tilt)
    z = np.array([ct * ca, ct * sa, -st])
    y = np.array([-sa, ca, 0.0])
    x = np.cross(y, z)
    c, s = math.cos(roll), math.sin(roll)
    return np.stack([c * x - s * y, s * x + c * y, z], axis=1)


def shown(
    target: Target,
    options: Iterable[Grasp],
    base: Pose2,
    now: float,
    failed: Iterable[str],
    chosen: str,
    goal_id: str,
) -> m.GraspCandidates:
    """Every candidate in frame map, for viewers."""
    turn, lost = quat_matrix(yaw_quat(base[2])), set(failed)
    found = []
    for one in options:
        x, y, z = (float(v) for v in turn @ one.pose.position + np.array([base[0], base[1], 0.0]))
        state: Literal["open", "failed", "chosen"] = "failed" if one.name in lost else "open"
        found.append(
            m.GraspCandidate(
                name=one.name, position=(x, y, z), orientation=matrix_quat(turn @ one.pose.rotation), width=one.width,
                state="chosen" if one.name == chosen else state,
            )
        )  # fmt: skip
    return m.GraspCandidates(t=now, object=target.label, candidates=found, goal_id=goal_id)


def certainly_too_wide(target: Target, widest: float) -> bool:
    """Neither side of an object goes between the fingers, even if it is smaller than measured by twice the spread."""
    return target.spread <= CERTAIN and min(target.size[:2]) - 2 * target.spread > widest


def is_poor(grasp: Grasp) -> bool:
    """It hardly holds, as far as the surface tells; a grasp by rule is as good as its rule."""
    return grasp.on_surface and grasp.worth < POOR


def upper_end(target: Target, rotation: Array) -> float | None:
    """Where the upper end of a lying object points [rad] that is to be put down upright; None of others."""
    kind = kind_of(target.kind)
    if not target.lies or not kind.upright:
        return None
    # Of two ends that are alike the hand leans towards the lower one: so it is above when the object stands.
    along = float(rotation[:2, 2] @ (math.cos(target.yaw), math.sin(target.yaw)))
    turn = math.pi if kind.ends_alike and along > 0 else 0.0
    return math.remainder(target.yaw + turn, math.tau)


def on_handle(target: Target, rotation: Array) -> bool:
    """True when a hand of this rotation (3, 3) would close on the handle of an upright object, or reach through it."""
    handle = handle_of(target)
    if handle is None or target.lies:
        return False
    closing = math.atan2(rotation[1, 1], rotation[0, 1])
    return abs(math.cos(handle - closing)) > math.cos(HANDLE_CONE)


def handle_of(target: Target) -> float | None:
    """Where the handle of an upright object points [rad]: along its yaw if its kind has one, or what was seen of a
    round one beyond its wall; None without.
    """
    if kind_of(target.kind).handle:
        return target.yaw
    if target.points is None or target.family not in ("round", "bowl"):
        return None
    beyond = target.points[np.hypot(target.points[:, 0], target.points[:, 1]) > max(target.size[:2]) / 2 + HANDLE_ROOM]
    if len(beyond) < HANDLE_POINTS:
        return None
    return math.atan2(float(beyond[:, 1].mean()), float(beyond[:, 0].mean()))


def vessel_of(target: Target) -> Kind:
    """The kind whose wall the object's is like."""
    kind = kind_of(target.kind)
    return kind if kind.wall else USUAL_VESSEL
