"""Parameters of the simulation."""

from typing import Literal

from common.config import Config
from common.geometry import Pose2
from common.scene import Obstacle


class Guest(Config, frozen=True):
    """Another robot in the same world: its namespace, and where it starts [m, m, rad]."""

    name: str
    x: float
    y: float
    theta: float = 0.0

    @property
    def pose(self) -> Pose2:
        return self.x, self.y, self.theta


class SimConfig(Config, frozen=True):
    """Which robot, how fast, with which errors. Lengths in metres, speeds in m/s or rad/s, times in seconds."""

    speed: str = "realtime"
    """`realtime`, a factor, or `max`."""
    robot: str = "tidybot"
    """`tidybot`, or `official` for the same drawn with MuJoCo Menagerie's meshes."""
    wait_for: tuple[str, ...] = ()
    """Participants that lockstep waits for."""
    viewer: bool = False
    """Open MuJoCo's own window."""
    max_speed: float = 0.5
    """Largest speed of the base."""
    max_turn: float = 1.5
    """Largest turn of the base."""
    acceleration: float = 0.7
    """Largest acceleration and braking of the base [m/s2]."""
    turn_acceleration: float = 2.5
    """The same of its turn [rad/s2]."""
    position_tolerance: float = 0.02
    """Distance from a target pose at which it is reached; fixed by the contract."""
    angle_tolerance: float = 0.05
    """Angle from a target pose at which it is reached [rad]; fixed by the contract."""
    stream_timeout: float = 0.25
    """Silence after which a stream of velocities or joint targets ends and the robot brakes."""
    target_timeout: float = 0.2
    """Silence after which target poses count as single ones, not as a stream."""
    sensors: Literal["bought", "ideal"] = "bought"
    """`bought`: with the errors below; `ideal`: a lidar without noise of which every ray returns."""
    lidar_noise: float = 0.01
    """Standard deviation of a range. Source: Slamtec RPLIDAR A2 datasheet, 1 % of up to 1 m."""
    lidar_missing: float = 0.01
    """Share of the rays that do not return."""
    odometry_slip: float = 0.02
    """Largest constant scale error of the wheels; with the next two 0, odometry is exact."""
    odometry_veer: float = 0.005
    """Largest constant turn that they do not notice [rad/m]."""
    odometry_noise: float = 0.005
    """Random walk [m and rad per sqrt(m)]."""
    obstacles: tuple[Obstacle | str, ...] | str = ()
    """What the robot's map lacks: tables, or names of the scene's; `none`: not even those that the scene places."""
    guests: tuple[Guest, ...] = ()
    """Other robots of the same make in this world: their drivers and sensors are played in their namespaces, on the
    same router; their other services run as for a robot of its own. Such a world always begins anew."""
    snapshot_dir: str = ""
    """Where pictures of the scene are written; "" for `out`."""
    run: str = ""
    """Run of the whole robot that this simulation belongs to: within one, a simulation that was killed or restarted
    goes on with the same world; "" always begins anew."""
    battery: float = 1.0
    """Charge at the beginning, 0 empty to 1 full."""
