"""How far the hand keeps back from a grasp, so that open and closed nothing but its pads comes near the object."""

from collections.abc import Sequence
from dataclasses import replace

import mujoco
import numpy as np

from common.geometry import Array, quat_matrix
from common.robot.model import Hand, pads, subtree
from services.manipulation.arm.arm_model import STAND_IN, ArmModel, Obstacle, Pose
from services.manipulation.grasps.grasp import Grasp
from services.manipulation.grasps.surface import surface
from services.manipulation.grasps.target import Target

GAP = 0.002
"""Free space [m] kept between the object and every part of the hand but the pads: the pose error of a good sighting."""
STEP = 0.002
"""Resolution [m] of the search along the approach: finer than the pose noise."""
PAD = 0.019
"""Half the length [m] of a pad along the approach (Robotiq 2F-85: two boxes of 18.75 mm)."""
PAD_HALF = 0.011
"""Half the width [m] of a pad (Robotiq 2F-85: 22 mm)."""
FLAT = 0.003
"""How far [m] a part of the surface may be behind the outermost and still touch the pad: the rubber gives way by 1 mm,
the rest is noise of the sight."""
OUTWARD = 0.005
"""How far [m] beyond the pads' middle what they touch should be: adaptive fingers stay parallel when pressed there, and
fold around what presses nearer to the palm, which thin and round things slip out of (Robotiq 2F-85 manual, equilibrium
line; measured with a ball of 57 mm and a cylinder of 39)."""
MOST = 0.016
"""Farthest [m] that the hand keeps back from something round: its widest line stays 3 mm within the pads."""
HAND = 0.22
"""No part of the hand is farther [m] from the pinch point (Robotiq 2F-85: 163 mm from its flange)."""
FAR = 0.05
"""Greatest distance [m] that is told: the hand needs no more room."""
SUNK, STRAYS = 0.001, 2
"""How deep [m] in the hand a seen point is no noise, and how many such points are none: mixed pixels."""
COMING = (0.0, 0.025, 0.05)
"""Distances [m] before the grasp at which the open hand must be clear of what was seen: apart by a finger's width."""
OVERLAP = 0.6
"""Least share of a pad's length that lies on a flat face."""


class HandClearance:
    """The hand alone, open and closed on a width, with the object as a primitive in the frame of the pinch point."""

    def __init__(self, arm: ArmModel) -> None:
        model = arm.model
        self._model, self._data = model, mujoco.MjData(model)
        self._shape = int(model.geom(STAND_IN).id)
        self.hand = Hand(model)
        self._joints = [model.joint(name).qposadr[0] for name in self.hand.joints]
        gripping = set().union(*pads(model))
        bodies = subtree(model, "gripper")
        self._parts = [
            g
            for g in range(model.ngeom)
            if int(model.geom_bodyid[g]) in bodies and g not in gripping and model.geom(g).name != "held"
        ]
        self._all = [
            g for g in range(model.ngeom) if int(model.geom_bodyid[g]) in bodies and model.geom(g).name != "held"
        ]
        self._arm_at, self._home = arm.qpos_at, arm.home
        self._known: tuple[Target, Array] | None = None

    def clear(self, target: Target, grasp: Grasp, opening: float | None = None) -> Grasp | None:
        """The grasp with its pinch point where the pads meet, kept back as far as the hand needs; None if too far.

        `opening` [m]: how far apart the fingers come, None as far as they go.

        The pads' middle runs along an arc while they close: the site is put so far behind that at the grasp's width
        they are where the grasp wants them.
        """
        advance = self.hand.advance(grasp.width)
        pose = grasp.pose.moved(-advance * grasp.pose.rotation[:, 2])
        if not grasp.rim:  # there the hand is inside the object's own bounding shape
            back = self._needed(target, pose, (opening or self.hand.open, grasp.width), grasp.on_surface)
            if back is None:
                return None
            pose = pose.moved(-back * pose.rotation[:, 2])
        return None if self._meets(target, pose, opening or self.hand.open) else replace(grasp, pose=pose)

    def _meets(self, target: Target, pose: Pose, width: float) -> bool:
        """The hand, `width` [m] open, would be where something of a measured object was seen, there or before that."""
        if target.points is None or not target.measured:
            return False
        seen = target.points + np.array(target.position)
        self._spread(width)
        for back in COMING:
            at = pose.moved(-back * pose.rotation[:, 2])
            apart = self._apart((seen - at.position) @ at.rotation, self._all)
            if np.count_nonzero(apart < -SUNK) > STRAYS:
                return True
        return False

    def _needed(self, target: Target, pose: Pose, widths: tuple[float, float], on_surface: bool) -> float | None:
        back, most = self._outward(target, pose, widths[1]), MOST if on_surface else _most(target, pose)
        room = self._room_on_surface if on_surface else self._room
        while True:
            kept = pose.moved(-back * pose.rotation[:, 2])
            free = min(room(target, kept, w) for w in widths)
            if free >= GAP:
                return back
            # Nothing of the hand comes nearer than it moves: the distance missing is the least that helps.
            back += max(STEP, GAP - max(free, 0.0))
            if back > most:
                return None

    def met(self, pose: Pose, width: float, around: Sequence[Obstacle]) -> set[str]:
        """Labels of the obstacles that the hand alone, `width` [m] open at a pose, would touch; "" for furniture."""
        self._spread(width)
        found = set()
        for obstacle in around:
            far = float(np.linalg.norm(pose.position - np.array(obstacle.center)))
            if (
                far - float(np.linalg.norm(obstacle.size)) / 2 < HAND
                and self._distance(obstacle, pose, self._all) <= 0.0
            ):
                found.add(obstacle.label)
        return found

    def _room(self, target: Target, pose: Pose, width: float) -> float:
        """Distance [m] from the object to the nearest part of the hand but its pads; negative inside, at most 0.05."""
        self._spread(width)
        return self._distance(target.grown(0.0), pose, self._parts)

    def _outward(self, target: Target, pose: Pose, width: float) -> float:
        """How far [m] back the hand goes so that the middle of what its pads touch is `OUTWARD` of their middle."""
        points = self._local(target, pose) - (0.0, 0.0, self.hand.advance(width))
        facing = points[(np.abs(points[:, 0]) <= PAD_HALF) & (np.abs(points[:, 2]) <= PAD)]
        if not len(facing):
            return 0.0
        touched = facing[np.abs(facing[:, 1]) >= np.abs(facing[:, 1]).max() - FLAT]
        return float(np.clip(OUTWARD - (touched[:, 2].max() + touched[:, 2].min()) / 2, 0.0, OUTWARD))

    def _local(self, target: Target, pose: Pose) -> Array:
        """Points (n, 3) [m] of the object's completed surface in the frame of the pinch point."""
        if self._known is None or self._known[0] is not target:
            self._known = target, surface(target)
        found: Array = (self._known[1] - pose.position) @ pose.rotation
        return found

    def _room_on_surface(self, target: Target, pose: Pose, width: float) -> float:
        """The same for the completed surface of the object; every part of the hand counts as the box around it."""
        self._spread(width)
        return float(self._apart(self._local(target, pose), self._parts).min(initial=FAR))

    def _apart(self, points: Array, parts: Sequence[int]) -> Array:
        """Distance (m,) [m] from the nearest of the hand's `parts`, negative inside, at most `FAR`, of those of the
        points (n, 3), in the frame of the pinch point, that are no farther than that from the whole hand.
        """
        model, data = self._model, self._data
        site, boxes = data.site("pinch"), model.geom_aabb[parts]
        turns = data.geom_xmat[parts].reshape(-1, 3, 3)
        middles = data.geom_xpos[parts] + np.einsum("nij,nj->ni", turns, boxes[:, :3])
        reach = np.einsum("nij,nj->ni", np.abs(turns), boxes[:, 3:]) + FAR
        local = points @ site.xmat.reshape(3, 3).T + site.xpos
        low, high = (middles - reach).min(axis=0), (middles + reach).max(axis=0)
        local = local[((local >= low) & (local <= high)).all(axis=1)]
        least = np.full(len(local), FAR)
        for middle, turn, half in zip(middles, turns, boxes[:, 3:], strict=True):
            beyond = np.abs((local - middle) @ turn) - half
            inside = np.minimum(beyond.max(axis=1), 0.0)
            least = np.minimum(least, np.linalg.norm(np.maximum(beyond, 0.0), axis=1) + inside)
        return least

    def _spread(self, width: float) -> None:
        """Put the fingers `width` [m] apart."""
        self._data.qpos[self._arm_at] = self._home
        self._data.qpos[self._joints] = self.hand.posture(width)
        mujoco.mj_kinematics(self._model, self._data)

    def _distance(self, solid: Obstacle, pose: Pose, parts: Sequence[int]) -> float:
        """Distance [m] from a solid to the nearest of the hand's `parts` at a pose, at most 0.05."""
        model, data = self._model, self._data
        site, shape = data.site("pinch"), self._shape
        turn = site.xmat.reshape(3, 3) @ pose.rotation.T
        model.geom_type[shape], model.geom_size[shape], half, quat = solid.geom()
        model.geom_rbound[shape] = float(np.linalg.norm(half))
        data.geom_xpos[shape] = site.xpos + turn @ (np.array(solid.center) - pose.position)
        data.geom_xmat[shape] = (turn @ quat_matrix(quat)).reshape(-1)
        return min(float(mujoco.mj_geomDistance(model, data, g, shape, 0.05, None)) for g in parts)


def _most(target: Target, pose: Pose) -> float:
    """How far [m] the pads' middle may stay before the object's and still hold it."""
    if target.solid != "box":
        return MOST
    c, s = np.cos(target.yaw), np.sin(target.yaw)
    own = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1.0]])
    approach, at = own @ pose.rotation[:, 2], own @ (pose.position - np.array(target.position))
    run = np.where(np.abs(approach) > 1e-6, np.abs(approach), np.inf)
    inside = float(((np.array(target.size) / 2 + np.sign(approach) * at) / run)[run < np.inf].min())
    return inside + PAD - 2 * PAD * OVERLAP
