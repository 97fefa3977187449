"""Set-points for an arm that somebody else leads, a policy or a person: within limits whatever is asked for. Pure."""

from collections.abc import Sequence

import mujoco
import numpy as np

from common.geometry import Array
from services.manipulation.arm.arm_model import ArmModel, Obstacle

COLLISION, OUTSIDE = "COLLISION", "OUTSIDE"
CLEARANCE = 0.003
"""How near [m] solids count as touching; chosen: more than the arm can go unseen between two `SAMPLES`."""
DAMPING = 0.08
"""Damping of the inverse Jacobian [m]; chosen: near a singularity the hand slows down instead of the joints racing."""
SAMPLES = (0.0, 0.15, 0.3, 0.5, 0.7, 1.0)
"""Shares of the time of braking at which it is looked where the arm would be; chosen: a centimetre of the hand."""
REGAIN = 0.02
"""How far [m] from where the hand has met something it may be pressed that way again; chosen."""
Workspace = tuple[float, float, float, float, float, float]


class Servo:
    """Follows targets (7,) [rad] or velocities with bounded speed [rad/s] and acceleration [rad/s^2] of every joint.

    Set-points are `period` seconds apart. Before each it looks at where the arm would come to rest if it braked from
    there on: where that lies beyond a joint's limit, outside of the `workspace` (x, y, z from and to [m], of the pinch
    point in the base frame), in the robot itself or in a solid, it brakes now. Out of a place where it may not be every
    way that leads out is free. `arm` is its own.
    """

    def __init__(self, arm: ArmModel, speed: float, acceleration: float, workspace: Workspace, period: float) -> None:
        self.arm, self._speed, self._acceleration, self._period = arm, speed, acceleration, period
        arm.model.geom_margin[:] = CLEARANCE  # pairs this near are told, with their distance
        self._low, self._high = np.array(workspace[::2]), np.array(workspace[1::2])
        self._data = mujoco.MjData(arm.model)
        self._jacobian = np.zeros((6, arm.model.nv))
        self.q: Array = arm.home.copy()
        self._velocity: Array = np.zeros(7)
        self._rest: Array = np.zeros(7)
        self._weight = 0.0
        self._met: tuple[Array, Array] | None = None

    def begin(self, joints: Array, torques: Array, around: Sequence[Obstacle]) -> None:
        """From rest at these joints (7,), with what the motors feel (7,) [Nm] while the hand touches nothing."""
        self.arm.set_obstacles(around, 0.0)
        self.q, self._velocity, self._met = joints.copy(), np.zeros(7), None
        gravity = self._gravity(joints)
        # Some arms tell their own weight with their torques, some have taken it off.
        self._weight = 1.0 if np.linalg.norm(torques - gravity) < np.linalg.norm(torques) else 0.0
        self._rest = torques - self._weight * gravity

    @property
    def still(self) -> bool:
        """It has come to rest."""
        return not self._velocity.any()

    # --- moving
    def towards(self, target: Array) -> str:
        """The next set-point on the way to `target`; why it brakes, "" while it does not."""
        gap = np.clip(self.arm.nearest_turn(target, self.q), self.arm.low, self.arm.high) - self.q
        # From v = sqrt(2 a d) it still comes to rest there.
        most = np.minimum(self._speed, np.sqrt(2 * self._acceleration * np.abs(gap)))
        return self._advance(np.sign(gap) * np.minimum(most, np.abs(gap) / self._period))

    def hand(self, linear: Array, angular: Array) -> str:
        """The next set-point with the hand at this velocity (3,) [m/s] and rate of turn (3,) [rad/s], base frame."""
        if self._met is not None:
            where, way = self._met
            if np.linalg.norm(self.arm.pose(self.q).position - where) > REGAIN:
                self._met = None
            else:
                linear = linear - way * max(0.0, float(linear @ way))
        model, data, jacobian = self.arm.model, self._data, self._jacobian
        data.qpos[self.arm.qpos_at] = self.q
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_jacSite(model, data, jacobian[:3], jacobian[3:], self.arm.pinch)
        own = jacobian[:, self.arm.dof_at]
        wanted = own.T @ np.linalg.solve(own @ own.T + DAMPING**2 * np.eye(6), np.concatenate([linear, angular]))
        return self._advance(wanted / max(1.0, float(np.abs(wanted).max()) / self._speed))

    def rest(self) -> str:
        """The next set-point on the way to a stop."""
        return self._advance(np.zeros(7))

    def _advance(self, wanted: Array) -> str:
        step = self._acceleration * self._period
        velocity = np.clip(wanted, self._velocity - step, self._velocity + step)
        why = self._refusal(velocity)
        if why:
            velocity = np.sign(self._velocity) * np.maximum(np.abs(self._velocity) - step, 0.0)
            if self._worse(self.q + velocity * self._period):
                velocity = np.zeros(7)  # what the samples have passed over
        self.q, self._velocity = self.q + velocity * self._period, velocity
        return why

    def _refusal(self, velocity: Array) -> str:
        """Why the arm may not move on like that, "" when it may."""
        if not velocity.any():
            return ""
        *between, end = self._braking(velocity)
        if ((end < self.arm.low) & (velocity < 0) | (end > self.arm.high) & (velocity > 0)).any():
            return OUTSIDE
        return next((why for q in (end, *between) if (why := self._worse(q))), "")

    def _braking(self, velocity: Array) -> list[Array]:
        """Where the arm (7,) comes by and where it ends, if it brakes after one set-point at this velocity.

        Joints brake with the same deceleration, so that the fast ones stop last and the way there is bent.
        """
        times = np.abs(velocity) / self._acceleration
        begin, way = self.q + velocity * self._period, np.sign(velocity) * self._acceleration / 2
        passed = (np.minimum(times, float(times.max()) * share) for share in SAMPLES)
        return [begin + velocity * t - way * t * t for t in passed]

    def _worse(self, q: Array) -> str:
        """Why the arm may not be there: where it is already, it may go on if that leads out."""
        deep, out = self._depth(q), self._outside()
        if deep and deep > self._depth(self.q):
            return COLLISION
        if not out:
            return ""
        self.arm.place(self.q)
        return OUTSIDE if out > self._outside() else ""

    def _depth(self, q: Array) -> float:
        """How far [m] the robot would be within `CLEARANCE` of itself or of a solid; 0 when it is free."""
        if not self.arm.collides(q):
            return 0.0
        data = self.arm.data
        return max(0.0, CLEARANCE - float(data.contact.dist[: data.ncon].min()))

    def _outside(self) -> float:
        """How far [m] outside of the workspace the pinch point of the configuration asked about last is."""
        at = self.arm.data.site_xpos[self.arm.pinch]
        return float(np.maximum(np.maximum(self._low - at, at - self._high), 0.0).max())

    # --- feeling
    def force(self, joints: Array, torques: Array) -> float:
        """Force [N] on the hand, by `torques` (7,) [Nm] at `joints` (7,)."""
        self._data.qpos[self.arm.qpos_at] = joints
        mujoco.mj_kinematics(self.arm.model, self._data)
        mujoco.mj_comPos(self.arm.model, self._data)
        mujoco.mj_jacSite(self.arm.model, self._data, self._jacobian[:3], None, self.arm.pinch)
        extra = torques - self._rest - self._weight * self._gravity(joints)
        return float(np.linalg.norm(np.linalg.lstsq(self._jacobian[:3, self.arm.dof_at].T, extra, rcond=None)[0]))

    def meet(self, linear: Array) -> None:
        """The hand has met something on its way along `linear` (3,): it stops, and may go any way but that."""
        length = float(np.linalg.norm(linear))
        if self._met is None and length:
            self._met = self.arm.pose(self.q).position, linear / length
        self._velocity = np.zeros(7)

    def _gravity(self, joints: Array) -> Array:
        """Torques (7,) [Nm] with which the motors would have to hold the arm's own weight."""
        model, data = self.arm.model, self._data
        data.qpos[self.arm.qpos_at], data.qvel[:] = joints, 0.0
        mujoco.mj_fwdPosition(model, data)
        mujoco.mj_rne(model, data, 0, bias := np.zeros(model.nv))
        return np.asarray(bias[self.arm.dof_at])
