"""Inverse kinematics by mink: differential IK as a quadratic program with joint, velocity and collision limits."""

import math
from collections.abc import Iterable

import mink
import numpy as np

from common.geometry import Array
from common.robot.joints import ARM
from services.manipulation.arm.arm_model import ArmModel, Pose

ITERATIONS = 60
"""Most steps from one start [count]; chosen."""
DT = 0.25
"""Time that a step integrates its velocity over [s]; chosen: no joint turns by more than 0.6 rad in one."""
POSITION_TOLERANCE, ANGLE_TOLERANCE = 0.0015, 0.02
"""Errors of the hand's pose [m, rad] within which it has arrived; chosen."""
CLEARANCE = 0.005
"""Distance [m] that the hand keeps from the nearest boxes and the deck; chosen."""
_SPEED = dict.fromkeys(ARM[:4], 2.0) | dict.fromkeys(ARM[4:], 2.5)
"""Largest speed of each joint in a step [rad/s]; chosen."""
_STALL = 1e-4
"""Gain of a step, errors of place and angle together [m + rad], below which it counts as none; chosen."""


class InverseKinematics:
    """Solves for the arm with base and fingers frozen."""

    def __init__(self, arm: ArmModel) -> None:
        self._arm = arm
        model = arm.model
        self._configuration = mink.Configuration(model)
        self._task = mink.FrameTask("pinch", "site", position_cost=1.0, orientation_cost=0.4, lm_damping=1e-3)
        self._posture = mink.PostureTask(model, cost=1e-3)
        frozen = [d for d in range(model.nv) if d not in set(arm.dof_at.tolist())]
        self._constraints = [mink.DofFreezingTask(model, dof_indices=frozen)]
        self._limits = [
            mink.ConfigurationLimit(model),
            mink.VelocityLimit(model, {k: np.array([v]) for k, v in _SPEED.items()}),
        ]
        surroundings: list[str | int] = [*(f"box_{i}" for i in range(3)), *arm.deck_geoms()]
        self._avoid = mink.CollisionAvoidanceLimit(
            model,
            geom_pairs=[(arm.hand_geoms(), surroundings)],
            minimum_distance_from_collisions=CLEARANCE,
            collision_detection_distance=0.05,
        )

    def solve(self, target: Pose, seeds: Iterable[Array], avoid: bool = False) -> Array | None:
        """The first solution (7,) from `seeds` that is within tolerance; None if there is none."""
        for seed in seeds:
            q = self._descend(target, seed, avoid)
            if q is not None:
                return q
        return None

    def _descend(self, target: Pose, seed: Array, avoid: bool) -> Array | None:
        configuration, arm = self._configuration, self._arm
        configuration.data.mocap_pos[:] = arm.data.mocap_pos
        configuration.data.mocap_quat[:] = arm.data.mocap_quat
        full = np.zeros(arm.model.nq)
        full[arm.qpos_at] = seed
        configuration.update(full)
        self._posture.set_target(full)
        rotation = mink.SO3.from_matrix(target.rotation)
        self._task.set_target(mink.SE3.from_rotation_and_translation(rotation, target.position))
        limits = [*self._limits, self._avoid] if avoid else self._limits
        tasks = [self._task, self._posture]
        best = math.inf
        stalled = 0
        for _ in range(ITERATIONS):
            error = self._task.compute_error(configuration)
            position, angle = float(np.linalg.norm(error[:3])), float(np.linalg.norm(error[3:]))
            if position < POSITION_TOLERANCE and angle < ANGLE_TOLERANCE:
                return np.array(configuration.q[arm.qpos_at])
            total = position + 0.3 * angle
            stalled = stalled + 1 if total > best - _STALL else 0
            best = min(best, total)
            if stalled > 12:
                return None
            try:
                velocity = mink.solve_ik(
                    configuration, tasks, DT, "daqp", 1e-4, limits=limits, constraints=self._constraints
                )
            except mink.NoSolutionFound:
                return None
            configuration.integrate_inplace(velocity, DT)
        return None


def seeds(arm: ArmModel, target: Pose, now: Array) -> list[Array]:
    """Starting points: here, home turned to the target, and elbows to either side."""
    turn = math.atan2(target.position[1], target.position[0] - arm.forward)
    found = [now]
    for lean, elbow, wrist in ((-0.35, -2.2, -0.9), (0.4, -1.9, -0.6), (0.6, -1.2, -1.2), (0.3, -2.3, 0.9)):
        q = arm.home.copy()
        q[0], q[1], q[3], q[5] = turn, lean, elbow, wrist
        found.append(q)
    return found
