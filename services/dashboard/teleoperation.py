"""Driving from the page: while somebody holds a control, slowly, never towards what the lidar sees close by."""

from math import hypot, isfinite, sqrt

import numpy as np

from common import messages as m
from common import topics
from common.approach import FOOTPRINT
from common.bus.port import Io
from common.gateway import refusal
from common.robot.lidar import rays_of

HAND_SPEED, HAND_TURN = 0.1, 0.5
"""Greatest speed [m/s] and rate of turn [rad/s] of the hand; chosen: what a person follows with the eyes."""
FINGERS = ("open", "close")
HOLD = 0.4
"""Time [s] after a visitor's last word at which the base stops (dead-man switch); chosen: eight words of 50 ms."""
SPEED, TURN = 0.3, 0.6
"""Greatest speed [m/s] and rate of turn [rad/s]; chosen: half of what navigation drives."""
BRAKING = 0.3
"""Deceleration [m/s^2] with which the base must be able to stop before an obstacle; chosen: a gentle one."""
ROOM = FOOTPRINT + 0.1
"""Distance [m] from the base's centre that stays free: a hand's width before the bumper; chosen."""
STALE = 0.5
"""Age [s] from which a scan, which comes at 10 Hz, says nothing any more."""
WIDTH = FOOTPRINT + 0.02
"""Half the width [m] of the lane that is looked at; chosen: the base, with the error of a range."""


class Teleoperation:
    """Turns what visitors hold into velocities. Not while a mission, navigation or the brake has the base."""

    def __init__(self, io: Io) -> None:
        self._io = io
        self._wish = (0.0, 0.0, 0.0)
        self._until = float("-inf")
        self._moving = False

    def hold(self, text: str, now: float) -> None:
        """Take a visitor's control: "forward left turn", each from -1 to 1; anything else is counted."""
        try:
            x, y, turn = (float(word) for word in text.split())
            if not all(isfinite(v) and abs(v) <= 1 for v in (x, y, turn)):
                raise ValueError(text)
        except ValueError:
            self._io.count_drop("page", f"drive {text[:40]!r}: expected three numbers from -1 to 1")
            return
        # A diagonal is no faster than straight on.
        scale = SPEED / max(1.0, hypot(x, y))
        self._wish, self._until = (x * scale, y * scale, turn * TURN), now + HOLD

    def step(self, now: float) -> None:
        """Publish the velocity while a control is held, then zero once, then nothing, which means hold."""
        io = self._io
        scan = io.latest(topics.SCAN) if io.age(topics.SCAN, now) <= STALE else None
        if now < self._until and any(self._wish) and free(io):
            x, y, omega = self._wish
            share = min(1.0, limit(scan, x, y) / max(hypot(x, y), 1e-9))
            io.publish(topics.CMD_VEL, m.CmdVel(vx=x * share, vy=y * share, omega=omega))
            self._moving = True
        elif self._moving:
            self._moving = False
            io.publish(topics.CMD_VEL, m.CmdVel(vx=0.0, vy=0.0, omega=0.0))


def free(io: Io) -> bool:
    """True when neither a mission nor navigation drives the robot and the brake is off."""
    sim, driving = io.latest(topics.SIM_STATUS), io.latest(topics.NAVIGATION_FEEDBACK)
    braked = sim is not None and sim.state == "stopped"
    driven = driving is not None and driving.status == "navigating"
    return not (braked or driven or refusal(io.latest(topics.BRAIN_STATE)))


def limit(scan: m.LaserScan | None, x: float, y: float) -> float:
    """Highest speed [m/s] towards (x, y) in the robot's frame that can stop before what a scan shows; 0 without one.

    v = sqrt(2 a d): d is how far the nearest point in the lane is beyond the base's own room.
    """
    if scan is None:
        return 0.0
    try:
        rays = rays_of(scan)
    except ValueError:
        return 0.0  # what is no scan shows no free way
    points = rays.ends[rays.hit]
    speed = hypot(x, y)
    if not speed or not len(points):
        return SPEED
    ahead = points @ np.array([x, y]) / speed
    aside = np.abs(points @ np.array([-y, x]) / speed)
    lane = ahead[(ahead > 0) & (aside < WIDTH)]
    return SPEED if not len(lane) else sqrt(2 * BRAKING * max(0.0, float(lane.min()) - ROOM))


# --- the hand led from the page: only while somebody holds on; manipulation keeps it within its limits
class HandTeleoperation:
    """Turns what visitors hold into velocities. Not while a mission, navigation or the brake has the robot."""

    def __init__(self, io: Io) -> None:
        self._io = io
        self._wish: m.HandVelocity | None = None
        self._until = float("-inf")
        self._leading = False

    def hold(self, text: str, now: float) -> None:
        """Take a visitor's control: "forward left up roll pitch yaw", each from -1 to 1, then perhaps open or close; or
        "home". What is no such thing is counted."""
        try:
            self._wish, self._until = _wish(text.split()), now + HOLD
        except ValueError:
            self._io.count_drop("page", f"hand {text[:60]!r}: expected six numbers from -1 to 1, or home")

    def step(self, now: float) -> None:
        """Publish the velocity while a control is held, then zero once, then nothing, which means stop."""
        io, wish = self._io, self._wish
        if wish is not None and now < self._until and free(io):
            io.publish(topics.HAND_VELOCITY, wish)
            if wish.fingers:  # said once: what is sent again would close again what was opened since
                self._wish = m.HandVelocity(linear=wish.linear, angular=wish.angular, home=wish.home)
            self._leading = True
        elif self._leading:
            self._leading = False
            io.publish(topics.HAND_VELOCITY, m.HandVelocity())


def _wish(words: list[str]) -> m.HandVelocity:
    """Raises ValueError for what is no wish."""
    if words == ["home"]:
        return m.HandVelocity(home=True)
    fingers = words.pop() if len(words) == 7 else ""
    values = [float(word) for word in words]
    if len(values) != 6 or not all(isfinite(v) and abs(v) <= 1 for v in values) or fingers not in ("", *FINGERS):
        raise ValueError(words)
    x, y, z, roll, pitch, yaw = values
    return m.HandVelocity(
        linear=(x * HAND_SPEED, y * HAND_SPEED, z * HAND_SPEED),
        angular=(roll * HAND_TURN, pitch * HAND_TURN, yaw * HAND_TURN),
        fingers=fingers,  # type: ignore[arg-type]
    )
