"""Commands from ROS peers: one row for each ROS topic, checked and translated into the robot's messages."""

from collections.abc import Callable
from typing import Any, NamedTuple

import msgspec

from common import messages as m
from common import topics
from common.bus import codec
from common.bus.port import Io
from common.gateway import checked, standing_pose, stop
from common.topic import Topic
from services.ros2.outgoing import POSE, STRING
from services.ros2.types import Types


class Row(NamedTuple):
    """ROS topic `name` of `type`: `convert` makes of its message one for `topic`. `moves`: not during a mission."""

    name: str
    type: str
    topic: Topic[Any]
    convert: Callable[[Io, Any], m.Message]
    moves: bool = False


def words(topic: Topic[Any]) -> Callable[[Io, Any], m.Message]:
    """A message from a String: bare words, or JSON as Zenoh clients send it."""

    def convert(io: Io, message: Any) -> m.Message:
        found: m.Message = codec.decode(topic, message.data.encode())
        return found

    return convert


def pose(io: Io, message: Any) -> m.NavGoal:
    return standing_pose(message)


def twist(io: Io, message: Any) -> m.CmdVel:
    """Base velocity; the driver limits it and holds when the stream falls silent."""
    linear, angular = message.linear, message.angular
    return m.CmdVel(vx=linear.x, vy=linear.y, omega=angular.z)


def twist_stamped(io: Io, message: Any) -> m.CmdVel:
    return twist(io, message.twist)


def plan(io: Io, message: Any) -> m.ActionPlan:
    """A plan as JSON, or the bare list of its steps as an answer to the last request that went to `plan_request`.

    Raises:
        ValueError: neither, or a list that nobody asked for.
    """
    text = message.data.encode()
    if not text.lstrip().startswith(b"["):
        return codec.decode(topics.ACTION_PLAN, text)
    asked = io.latest(topics.PLAN_REQUEST)
    if asked is None:
        raise ValueError("a list of steps, and no plan was requested")
    try:
        steps = msgspec.json.decode(text, type=list[m.PlanStep])
    except msgspec.DecodeError as error:
        raise ValueError(str(error)) from None
    return m.ActionPlan(request_id=asked.id, steps=steps, source="ros2")


def brake(io: Io, message: Any) -> m.RobotStop:
    return stop(io, message.data)


def resume(io: Io, message: Any) -> m.RobotResume:
    """Releases the brake alone; the mission goes on by `tidybot resume`."""
    return m.RobotResume(source=io.name)


ROWS = (
    Row("voice_command", STRING, topics.VOICE_COMMAND, words(topics.VOICE_COMMAND)),
    Row("brain/speech_goal", STRING, topics.SPEECH_GOAL, words(topics.SPEECH_GOAL), moves=True),
    Row("brain/navigation_goal", STRING, topics.NAVIGATION_GOAL, words(topics.NAVIGATION_GOAL), moves=True),
    Row("brain/manipulation_goal", STRING, topics.MANIPULATION_GOAL, words(topics.MANIPULATION_GOAL), moves=True),
    Row("nav_goal", POSE, topics.NAV_GOAL, pose, moves=True),
    Row("goal_pose", POSE, topics.NAV_GOAL, pose, moves=True),
    Row("cmd_vel", "geometry_msgs/msg/Twist", topics.CMD_VEL, twist, moves=True),
    Row("cmd_vel", "geometry_msgs/msg/TwistStamped", topics.CMD_VEL, twist_stamped, moves=True),
    Row("action_plan", STRING, topics.ACTION_PLAN, plan),
    Row("robot/stop", STRING, topics.ROBOT_STOP, brake),
    Row("robot/resume", STRING, topics.ROBOT_RESUME, resume),
)


def message_of(row: Row, types: Types, io: Io, payload: bytes) -> m.Message:
    """The robot's message for a peer's payload, with a new id where it has none.

    Raises:
        ValueError: no message of the row's type, or one that cannot be meant; the text is the reason.
    """
    return checked(io, row.convert(io, types.decode(row.type, payload)))
