"""The base's driver: an acceleration-limited set-point that moves to a target pose or follows a velocity."""

import math
from dataclasses import dataclass, field

from common.geometry import Pose2, compose, inverse, wrap
from services.sim.config import SimConfig

SETPOINT_LEAD = 0.05
"""How far [m] the set-point may be ahead of the base, and twice it in [rad]: a base that is held stays near it."""
MASS = 69.0
"""Of the whole robot [kg]."""
YIELD = 120.0
"""Force [N] beyond what its own acceleration takes at which the base gives way: less than that are the arm's motions,
more is somebody who pushes."""
PUSHED = 0.03
"""For how long [s] that has to be so: three readings, longer than a knock of the arm."""
_STILL = 0.02
"""Speed [m/s] below which the base rests."""
STREAM = 5
"""Targets in a row [count] from which they are a stream that is followed, not goals to stop at."""


@dataclass
class BaseDriver:
    """Owns the set-point (x, y, yaw) that the base servos follow.

    A target is a pose in frame odom: what the wheels report decides how far is left to go, not where the base is.
    """

    config: SimConfig
    pose: Pose2 = (0.0, 0.0, 0.0)
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    target: Pose2 | None = None
    target_id: str = ""
    stopped: bool = False
    yielding: bool = False
    """The set-point goes where the base goes: the wheels only brake."""
    _twist: tuple[float, float, float] = (0.0, 0.0, 0.0)
    _twist_until: float = -1.0
    _targeted_at: float = -math.inf
    _targets_in_a_row: int = 0
    _brake: "Brake" = field(default_factory=lambda: Brake())

    def go_to(self, x: float, y: float, theta: float, target_id: str, now: float) -> None:
        """Move to a pose, in place of any earlier command.

        One target is run to its end. Targets that come as a stream are good for `target_timeout` each: whoever
        steers the base may die or lose the network in mid-drive.
        """
        streaming = now - self._targeted_at <= self.config.target_timeout
        self._targets_in_a_row = self._targets_in_a_row + 1 if streaming else 0
        self._targeted_at = now
        self.target, self.target_id, self._twist_until = (x, y, theta), target_id, -1.0

    def drive(self, vx: float, vy: float, omega: float, now: float) -> None:
        """Follow a velocity in the robot's own frame until the stream falls silent."""
        self.target, self.target_id = None, ""
        self._twist, self._twist_until = (vx, vy, omega), now + self.config.stream_timeout

    def halt(self, actual: Pose2) -> None:
        """Brake as hard as the wheels can, and hold where that ends."""
        if not self.stopped:
            self.pose, self.velocity, self._brake.applied = actual, (0.0, 0.0, 0.0), True
        self.target, self._twist_until, self.stopped = None, -1.0, True

    def reached(self, odometry: Pose2) -> bool:
        """True when the measured pose is at the target, at rest."""
        if self.target is None or math.hypot(*self.velocity[:2]) > _STILL or abs(self.velocity[2]) > 0.05:
            return False
        x, y, yaw = self.target
        close = math.hypot(odometry[0] - x, odometry[1] - y) <= self.config.position_tolerance
        return close and abs(wrap(odometry[2] - yaw)) <= self.config.angle_tolerance

    def advance(
        self, actual: Pose2, odometry: Pose2, now: float, dt: float, force: tuple[float, float] | None = None
    ) -> Pose2:
        """The set-point after `dt` seconds.

        `actual` is where the servos are, `odometry` what the wheels report, `force` (x, y) [N] what they push with,
        where that is known.
        """
        self.yielding = self._brake.holds(actual, force, dt)
        if self.yielding:
            self.pose, self.velocity, self._brake.inertia = actual, (0.0, 0.0, 0.0), (0.0, 0.0)
            return self.pose
        before = self.velocity
        wanted, limit, turn_limit = self._wanted(actual, odometry, now, dt)
        vx, vy = _towards(self.velocity[:2], wanted[:2], limit * dt)
        omega = self.velocity[2] + max(-turn_limit * dt, min(turn_limit * dt, wanted[2] - self.velocity[2]))
        x, y, yaw = self.pose[0] + vx * dt, self.pose[1] + vy * dt, self.pose[2] + omega * dt
        ex, ey = x - actual[0], y - actual[1]
        lead = math.hypot(ex, ey)
        if lead > SETPOINT_LEAD:
            x, y = actual[0] + ex * SETPOINT_LEAD / lead, actual[1] + ey * SETPOINT_LEAD / lead
            vx, vy = vx * 0.5, vy * 0.5
        if abs(yaw - actual[2]) > 2 * SETPOINT_LEAD:
            yaw = actual[2] + math.copysign(2 * SETPOINT_LEAD, yaw - actual[2])
            omega *= 0.5
        self.pose, self.velocity = (x, y, yaw), (vx, vy, omega)
        self._brake.inertia = MASS * (vx - before[0]) / dt, MASS * (vy - before[1]) / dt
        return self.pose

    def _abandoned(self, now: float) -> bool:
        """A stream of targets fell silent; the last one stands again when the stream goes on."""
        return self._targets_in_a_row >= STREAM and now - self._targeted_at > self.config.target_timeout

    def _wanted(
        self, actual: Pose2, odometry: Pose2, now: float, dt: float
    ) -> tuple[tuple[float, float, float], float, float]:
        """Desired world velocity and the acceleration limits to reach it with."""
        c = self.config
        if self.stopped:
            return (0.0, 0.0, 0.0), c.acceleration, c.turn_acceleration
        if self.target is not None and not self._abandoned(now):
            x, y, yaw = compose(actual, compose(inverse(odometry), self.target))
            dx, dy = x - self.pose[0], y - self.pose[1]
            turn = wrap(yaw - self.pose[2])
            distance = math.hypot(dx, dy)
            speed = _profile(distance, c.acceleration, c.max_speed, dt)
            scale = speed / distance if distance > 1e-9 else 0.0
            omega = math.copysign(_profile(abs(turn), c.turn_acceleration, c.max_turn, dt), turn)
            return (dx * scale, dy * scale, omega), 2 * c.acceleration, 2 * c.turn_acceleration
        if now < self._twist_until:
            vx, vy, omega = self._twist
            fast = math.hypot(vx, vy)
            k = min(1.0, c.max_speed / fast) if fast > 0 else 1.0
            cos, sin = math.cos(self.pose[2]), math.sin(self.pose[2])
            world = (k * (cos * vx - sin * vy), k * (sin * vx + cos * vy), max(-c.max_turn, min(c.max_turn, omega)))
            return world, 2 * c.acceleration, 2 * c.turn_acceleration
        return (0.0, 0.0, 0.0), 3 * c.acceleration, 3 * c.turn_acceleration


@dataclass
class Brake:
    """Decides whether the wheels only brake: after a stop until the base rests, and while somebody pushes it.

    `inertia` (x, y) [N]: what the wheels have to push with to accelerate the robot itself.
    """

    applied: bool = False
    inertia: tuple[float, float] = (0.0, 0.0)
    _was: Pose2 | None = None
    _pushed: float = 0.0

    def holds(self, actual: Pose2, force: tuple[float, float] | None, dt: float) -> bool:
        """True when the wheels brake for the next `dt` [s]; the base is at `actual`, `force` [N] is the wheels'."""
        moving = self._was is not None and math.dist(actual[:2], self._was[:2]) > _STILL * dt
        self._was = actual
        self.applied = self.applied and moving
        if self.applied:
            return True
        beyond = force is not None and math.hypot(force[0] - self.inertia[0], force[1] - self.inertia[1]) > YIELD
        self._pushed = self._pushed + dt if beyond else 0.0
        return self._pushed >= PUSHED


def _profile(distance: float, deceleration: float, limit: float, dt: float) -> float:
    """The fastest speed from which `distance` still suffices to stop."""
    return min(limit, math.sqrt(2 * deceleration * distance) * 0.95, distance / dt)


def _towards(now: tuple[float, ...], wanted: tuple[float, ...], step: float) -> tuple[float, float]:
    dx, dy = wanted[0] - now[0], wanted[1] - now[1]
    change = math.hypot(dx, dy)
    if change <= step:
        return wanted[0], wanted[1]
    return now[0] + dx * step / change, now[1] + dy * step / change
