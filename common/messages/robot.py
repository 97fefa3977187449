"""The robot's drivers and sensors: what a real base, arm, gripper and lidar take and give."""

from common.messages.base import Message


class BaseTarget(Message):
    x: float
    y: float
    theta: float
    id: str = ""


class GoalReached(Message):
    reached: bool
    target_id: str = ""


class JointStates(Message):
    """100 Hz. base_x base_y base_yaw joint_1..joint_7 gripper; the gripper's position is its width [m]."""

    t: float
    name: list[str]
    position: list[float]
    velocity: list[float]
    effort: list[float]


class GripperCommand(Message):
    """`position` 0 open .. 1 closed; `max_effort` [N]."""

    position: float
    max_effort: float = 40.0


class RobotStop(Message):
    reason: str = ""
    source: str = ""


class RobotResume(Message):
    """Releases the brake. `go_on`: the brain also takes up the mission that the stop has cut short."""

    source: str = ""
    go_on: bool = False


class CmdVel(Message):
    """Base velocity in the robot's own frame [m/s, m/s, rad/s]; 0.25 s of silence means hold."""

    vx: float
    vy: float
    omega: float


class ArmCommand(Message):
    """Joint set-points [rad] to be reached `period` seconds after receipt; a stream, 0.25 s of silence means hold."""

    position: list[float]
    period: float = 0.02
    t: float = 0.0


class Odometry(Message):
    """Wheel odometry: pose in frame `odom`, velocity in the robot's frame."""

    t: float
    x: float
    y: float
    theta: float
    vx: float = 0.0
    vy: float = 0.0
    omega: float = 0.0


class BatteryState(Message):
    """`charge` from 0 empty to 1 full, `power` drawn now [W]."""

    t: float
    charge: float
    power: float = 0.0
    charging: bool = False


class LaserScan(Message):
    """Ranges [m] counter-clockwise from `angle_min` in the lidar's frame; > range_max means nothing seen.

    `ranges` is float32 little-endian; the lidar sits at (`x`, `y`) in the base frame.
    """

    t: float
    ranges: bytes
    angle_min: float = -3.141592653589793
    angle_increment: float = 0.017453292519943295
    range_min: float = 0.05
    range_max: float = 10.0
    x: float = 0.0
    y: float = 0.0


class CameraMount(Message):
    """Where a camera sits on the base and how much it sees.

    `x`, `y`, `z`: its optical centre in frame `base` [m]. `yaw`: where it looks from straight ahead, counter-clockwise,
    `pitch`: how far down from level, `fovy`: the vertical angle of its pictures [rad].
    """

    x: float
    z: float
    pitch: float
    fovy: float
    y: float = 0.0
    yaw: float = 0.0


class RobotDescription(Message):
    """Robot-only MJCF, the robot's drawing as on `robot_description`; `head_camera` is its camera `head`."""

    mjcf: str
    head_camera: CameraMount | None = None
