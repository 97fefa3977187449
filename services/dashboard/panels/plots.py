"""The curves of the page, and the samples that go into them."""

from math import degrees

from common import messages as m
from services.dashboard.panels.history_buffers import Curves, Jitter
from services.dashboard.panels.tracking_error import arm_error
from services.dashboard.panels.widgets import Panels

OFF_PATH, OFF_ARM = "base [cm]", "arm [deg]"


class Plots:
    """Base speed, tracking error, gripper force and loop jitter over the last minute."""

    def __init__(self, panels: Panels) -> None:
        self._jitter = Jitter()
        self._speed, self._force = Curves(("base",)), Curves(("gripper",))
        self._late, self._off = Curves(("late",)), Curves((OFF_PATH, OFF_ARM))
        for curves, title, unit, top in (
            (self._speed, "base speed", "m/s", 0.6),
            (self._off, "tracking error", "cm, deg", 5.0),
            (self._force, "gripper force", "N", 50.0),
            (self._late, "loop jitter", "ms", 60.0),
        ):
            panels.plot(curves, title, unit, top)

    def take(self, now: float, joints: m.JointStates, command: m.ArmCommand | None, off_path: float) -> None:
        """New joint states, with the arm's set-point and how far the base is from its path [m]."""
        velocity = dict(zip(joints.name, joints.velocity, strict=False))
        effort = dict(zip(joints.name, joints.effort, strict=False))
        angles = dict(zip(joints.name, joints.position, strict=False))
        speed = (velocity.get("base_x", 0.0) ** 2 + velocity.get("base_y", 0.0) ** 2) ** 0.5
        self._speed.add(now, base=speed)
        self._force.add(now, gripper=abs(effort.get("gripper", 0.0)))
        self._late.add(now, late=1000 * self._jitter.late(joints.t, now))
        self._off.add(now, **{OFF_PATH: 100 * off_path, OFF_ARM: degrees(arm_error(command, angles))})
