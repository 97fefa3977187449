"""Translation of the robot's messages to ROS: one row for each ROS topic."""

from collections.abc import Callable
from typing import Any, NamedTuple

import msgspec
import numpy as np

from common import messages as m
from common import topics
from common.cells import unpacked
from common.geometry import yaw_quat
from common.robot.frames import BASE_LINK, LIDAR, MAP, ODOM
from common.topic import Topic
from services.ros2.pictures import camera_info, depth, image
from services.ros2.types import Types
from services.ros2.wire import Qos

STRING, POSE = "std_msgs/msg/String", "geometry_msgs/msg/PoseStamped"
LATCHED = Qos(transient=True, depth=1)
OCCUPIED, FREE = 100, 0
"""Of a nav_msgs/OccupancyGrid."""
LEVELS = {"debug": 10, "info": 20, "warning": 30, "error": 40}
"""Of a rcl_interfaces/Log."""
Convert = Callable[[Types, Any], Any]


class Row(NamedTuple):
    """ROS topic `name` of `type` carries what `convert` makes of the robot's `topic`; where that is None, nothing.

    The name is below the namespace unless it begins with `/`.
    """

    name: str
    type: str
    topic: Topic[Any]
    convert: Convert
    qos: Qos = Qos()


def field(name: str) -> Convert:
    """A converter that puts one text field of a message into a String."""
    return lambda types, message: types.text(str(getattr(message, name)))


def whole(types: Types, message: m.Message) -> Any:
    """A whole message as JSON in a String."""
    return types.text(msgspec.json.encode(message).decode())


def joint_states(types: Types, message: m.JointStates) -> Any:
    """Joints as the robot names them; `gripper` is the width between the pads [m]."""
    position, velocity, effort = (np.array(v) for v in (message.position, message.velocity, message.effort))
    header = types.header(message.t, "")
    return types.new(
        "sensor_msgs/JointState", header=header, name=message.name, position=position, velocity=velocity, effort=effort
    )


def odometry(types: Types, message: m.Odometry) -> Any:
    """Covariances are not known: zeros."""
    pose = types.pose((message.x, message.y, 0.0), yaw_quat(message.theta))
    linear, angular = types.vector(message.vx, message.vy, 0.0), types.vector(0.0, 0.0, message.omega)
    twist = types.new("geometry_msgs/Twist", linear=linear, angular=angular)
    unknown = np.zeros(36)
    return types.new(
        "nav_msgs/Odometry",
        header=types.header(message.t, ODOM),
        child_frame_id=BASE_LINK,
        pose=types.new("geometry_msgs/PoseWithCovariance", pose=pose, covariance=unknown),
        twist=types.new("geometry_msgs/TwistWithCovariance", twist=twist, covariance=unknown),
    )


def scan(types: Types, message: m.LaserScan) -> Any:
    """Ranges beyond the lidar's reach are infinite (REP 117)."""
    ranges = np.frombuffer(message.ranges, "<f4")
    ranges = np.where(ranges > message.range_max, np.inf, ranges).astype(np.float32)
    return types.new(
        "sensor_msgs/LaserScan",
        header=types.header(message.t, LIDAR),
        angle_min=message.angle_min,
        angle_max=message.angle_min + message.angle_increment * max(0, len(ranges) - 1),
        angle_increment=message.angle_increment,
        time_increment=0.0,
        scan_time=1 / topics.SCAN.rate,
        range_min=message.range_min,
        range_max=message.range_max,
        ranges=ranges,
        intensities=np.zeros(0, np.float32),
    )


def occupancy(types: Types, message: m.Costmap) -> Any:
    """What stands in the way, without the room that the robot keeps from it.

    Raises:
        ValueError: not as many cells as it says.
    """
    cells = unpacked(message).ravel()
    info = types.new(
        "nav_msgs/MapMetaData",
        map_load_time=types.stamp(message.t),
        resolution=message.resolution,
        width=message.width,
        height=message.height,
        origin=types.pose((message.x, message.y, 0.0), yaw_quat(0.0)),
    )
    data = np.where(cells == 0, OCCUPIED, FREE).astype(np.int8)
    return types.new("nav_msgs/OccupancyGrid", header=types.header(message.t, MAP), info=info, data=data)


def path(types: Types, message: m.NavPath) -> Any:
    """Each pose looks towards the next."""
    points = np.array(message.points).reshape(-1, 2)
    steps = np.diff(points, axis=0)
    headings = np.arctan2(steps[:, 1], steps[:, 0]) if len(steps) else np.zeros(0)
    headings = np.append(headings, headings[-1:] if len(headings) else np.zeros(len(points)))
    poses = [
        types.pose_stamped(message.t, MAP, (float(x), float(y), 0.0), yaw_quat(float(heading)))
        for (x, y), heading in zip(points, headings, strict=True)
    ]
    return types.new("nav_msgs/Path", header=types.header(message.t, MAP), poses=poses)


def clock(types: Types, message: m.SimClockTick) -> Any:
    return types.new("rosgraph_msgs/Clock", clock=types.stamp(message.t))


def object_pose(types: Types, message: m.ObjectPose) -> Any | None:
    """Where it was seen last; nothing for what was not found."""
    if not message.found:
        return None
    return types.pose_stamped(message.seen_at, message.frame, message.position, message.orientation)


def nav_goal(types: Types, message: m.NavGoal) -> Any:
    """Stamped 0, the newest: the goal has no time."""
    return types.pose_stamped(0.0, message.frame, (message.x, message.y, 0.0), yaw_quat(message.theta))


def base_target(types: Types, message: m.BaseTarget) -> Any:
    return types.pose_stamped(0.0, ODOM, (message.x, message.y, 0.0), yaw_quat(message.theta))


def goal_reached(types: Types, message: m.GoalReached) -> Any:
    return types.new("std_msgs/Bool", data=message.reached)


def log(types: Types, message: m.LogRecord) -> Any:
    """A line of a service's log, with its fields."""
    fields = " ".join(f"{name}={value}" for name, value in message.fields.items())
    return types.new(
        "rcl_interfaces/Log",
        stamp=types.stamp(message.t),
        level=LEVELS.get(message.level, LEVELS["info"]),
        name=message.service,
        msg=f"{message.event} {fields}".rstrip(),
        file="",
        function="",
        line=0,
    )


def _camera(name: str, topic: Topic[m.Rgbd]) -> tuple[Row, ...]:
    return (
        Row(f"camera/{name}/image", "sensor_msgs/msg/Image", topic, image),
        Row(f"camera/{name}/depth", "sensor_msgs/msg/Image", topic, depth),
        Row(f"camera/{name}/camera_info", "sensor_msgs/msg/CameraInfo", topic, camera_info),
    )


ROWS = (
    Row("joint_states", "sensor_msgs/msg/JointState", topics.JOINT_STATES, joint_states),
    Row("odom", "nav_msgs/msg/Odometry", topics.ODOMETRY, odometry),
    Row("scan", "sensor_msgs/msg/LaserScan", topics.SCAN, scan),
    Row("map", "nav_msgs/msg/OccupancyGrid", topics.COSTMAP, occupancy, LATCHED),
    Row("plan", "nav_msgs/msg/Path", topics.NAV_PATH, path),
    Row("clock", "rosgraph_msgs/msg/Clock", topics.SIM_CLOCK, clock),
    *_camera("head", topics.HEAD_RGBD),
    *_camera("wrist", topics.WRIST_RGBD),
    Row("/rosout", "rcl_interfaces/msg/Log", topics.LOG, log),
    Row("system_status", STRING, topics.SYSTEM_STATUS, field("state"), LATCHED),
    Row("brain/speech_goal", STRING, topics.SPEECH_GOAL, field("goal")),
    Row("brain/speech_result", STRING, topics.SPEECH_RESULT, field("text")),
    Row("brain/navigation_goal", STRING, topics.NAVIGATION_GOAL, field("goal")),
    Row("brain/navigation_status", STRING, topics.NAVIGATION_STATUS, field("status")),
    Row("brain/manipulation_goal", STRING, topics.MANIPULATION_GOAL, field("goal")),
    Row("brain/manipulation_status", STRING, topics.MANIPULATION_STATUS, field("status")),
    Row("base/target_pose", POSE, topics.BASE_TARGET, base_target),
    Row("base/goal_reached", "std_msgs/msg/Bool", topics.GOAL_REACHED, goal_reached),
    Row("voice_command", STRING, topics.VOICE_COMMAND, field("text")),
    Row("plan_request", STRING, topics.PLAN_REQUEST, whole),
    Row("action_plan", STRING, topics.ACTION_PLAN, whole),
    Row("object_query", STRING, topics.OBJECT_QUERY, field("query")),
    Row("object_pose", POSE, topics.OBJECT_POSE, object_pose),
    Row("nav_goal", POSE, topics.NAV_GOAL, nav_goal),
    Row("navigation_feedback", STRING, topics.NAVIGATION_FEEDBACK, whole),
    Row("gripper_command", STRING, topics.GRIPPER_COMMAND, whole),
)
"""Beside these, `robot_description`, `tf` and `tf_static`, which are of several topics."""
