"""What gateways to other tools share: checks of what these ask of the robot, and when something periodic is due."""

from typing import Any, TypeVar

from common import messages as m
from common.bus.port import Io
from common.bus.validation import bad_field
from common.geometry import quat_yaw
from common.robot.frames import MAP

M = TypeVar("M", bound=m.Message)
READY = ("IDLE", *m.OPEN_STATES)
"""States of the brain in which no mission is under way, so that others may move the robot."""
LEVEL = 0.1
"""How far from level a pose on the floor may be, and a quaternion's length from 1 [1]; chosen: rounding and no more."""
LONGEST = 200
"""Characters of a stop's reason that are passed on; chosen."""


def refusal(state: m.BrainState | None) -> str:
    """Why clients other than the brain may not move the robot now, in words; "" when they may."""
    suspended = state is not None and state.state == "IDLE" and state.mission_id
    if state is not None and (state.state not in READY or suspended):
        return f"a mission is under way ({state.state}); cancel it first"
    return ""


def checked(io: Io, message: M) -> M:
    """A message of a client, checked, with a new id where it has an empty one.

    Raises:
        ValueError: a number that nothing can act on.
    """
    if where := bad_field(message):
        raise ValueError(f"{where} is not a finite number of a sane size")
    if getattr(message, "id", None) == "":
        message.id = io.new_id(io.name)  # type: ignore[attr-defined]
    return message


def due(rate: float, since: float) -> bool:
    """True when an action repeated at `rate` [Hz], last done `since` seconds ago, is due; never at rate 0."""
    return rate > 0 and since >= 1 / rate


def standing_pose(stamped: Any) -> m.NavGoal:
    """A navigation goal from an object with the fields of a geometry_msgs/PoseStamped.

    Raises:
        ValueError: in another frame than the map, or not on the floor.
    """
    frame, p, o = stamped.header.frame_id, stamped.pose.position, stamped.pose.orientation
    q = o.w, o.x, o.y, o.z
    if frame.lstrip("/") != MAP:
        raise ValueError(f"a pose in frame {frame!r}: expected {MAP}")
    if not abs(sum(v * v for v in q) - 1) < LEVEL or abs(q[1]) > LEVEL or abs(q[2]) > LEVEL:
        raise ValueError("an orientation that is no rotation about the vertical")
    return m.NavGoal(x=p.x, y=p.y, theta=quat_yaw(q))


def stop(io: Io, reason: str) -> m.RobotStop:
    """A stop with this reason, shortened, or with `stop` in place of an empty one."""
    return m.RobotStop(reason=reason[:LONGEST] or "stop", source=io.name)
