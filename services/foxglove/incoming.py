"""Commands from Foxglove's panels: their JSON, checked and translated into the robot's messages."""

from collections.abc import Callable
from typing import Any, NamedTuple

import msgspec

from common import messages as m
from common import topics
from common.bus import codec
from common.bus.port import Io
from common.gateway import checked, standing_pose, stop
from common.topic import Topic


class Vector(msgspec.Struct):
    x: float = 0.0
    y: float = 0.0
    z: float = 0.0


class Twist(msgspec.Struct):
    """A geometry_msgs/Twist, as the Teleop panel sends it."""

    linear: Vector
    angular: Vector


class Quaternion(msgspec.Struct):
    w: float
    x: float = 0.0
    y: float = 0.0
    z: float = 0.0


class Pose(msgspec.Struct):
    position: Vector
    orientation: Quaternion


class Header(msgspec.Struct):
    frame_id: str


class PoseStamped(msgspec.Struct):
    """A geometry_msgs/PoseStamped, as the 3D panel's Publish tool sends it."""

    header: Header
    pose: Pose


class Words(msgspec.Struct):
    """A std_msgs/String, as the Publish panel sends it."""

    data: str = ""


class Row(NamedTuple):
    """A topic `name` of visitors, translated to the robot's `topic`; `always`: also where visitors may not command.

    `moves`: not during a mission.
    """

    name: str
    topic: Topic[Any]
    convert: Callable[[Io, bytes], m.Message]
    moves: bool = False
    always: bool = False


def twist(io: Io, data: bytes) -> m.CmdVel:
    found = msgspec.json.decode(data, type=Twist)
    return m.CmdVel(vx=found.linear.x, vy=found.linear.y, omega=found.angular.z)


def pose(io: Io, data: bytes) -> m.NavGoal:
    return standing_pose(msgspec.json.decode(data, type=PoseStamped))


def words(io: Io, data: bytes) -> m.VoiceCommand:
    """A command from a std_msgs/String or the robot's own message; typed, so nobody asks whether it was heard right."""
    typed = msgspec.json.decode(data, type=Words).data
    found = codec.decode(topics.VOICE_COMMAND, typed.encode() if typed else data)
    found.confirmed = True
    return found


def brake(io: Io, data: bytes) -> m.RobotStop:
    """A stop from any message, valid or not."""
    try:
        return stop(io, msgspec.json.decode(data, type=Words).data)
    except msgspec.DecodeError:
        return stop(io, "")


def resume(io: Io, data: bytes) -> m.RobotResume:
    return m.RobotResume(source=io.name)


ROWS = (
    Row("voice_command", topics.VOICE_COMMAND, words),
    Row("cmd_vel", topics.CMD_VEL, twist, moves=True),
    Row("goal_pose", topics.NAV_GOAL, pose, moves=True),
    Row("move_base_simple/goal", topics.NAV_GOAL, pose, moves=True),
    Row("nav_goal", topics.NAV_GOAL, pose, moves=True),
    Row("robot/stop", topics.ROBOT_STOP, brake, always=True),
    Row("robot/resume", topics.ROBOT_RESUME, resume),
)
BY_NAME = {row.name: row for row in ROWS}


def message_of(row: Row, io: Io, data: bytes) -> m.Message:
    """The robot's message for a visitor's JSON.

    Raises:
        ValueError: not of the row's kind, or one that cannot be meant; the text is the reason.
    """
    try:
        return checked(io, row.convert(io, data))
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise ValueError(str(error)) from None
