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
    """`speed` is `realtime`, a factor, or `max`; `wait_for` names the participants that lockstep waits for.

    `robot`: `tidybot`, or `official` for the same drawn with MuJoCo Menagerie's meshes.

    `sensors`: `bought`, or `ideal`: a lidar without noise (standard deviation `lidar_noise` [m]) of which every ray
    returns (`lidar_missing` is the share that does not). Source: Slamtec RPLIDAR A2 datasheet, 1 % of up to 1 m.

    Wheel odometry: `slip` is the largest constant scale error, `veer` the largest constant turn [rad/m],
    `noise` a random walk [m and rad per sqrt(m)]. `obstacles`: tables, or names of the scene's; `none`: not even those
    that the scene places.

    `guests`: other robots of the same make in this world. The simulation plays each one's drivers and sensors in its
    namespace, on the same router; its other services run as for a robot of its own. Such a world always begins anew.

    `battery`: its charge at the beginning, 0 empty to 1 full.

    `run` names the run of the whole robot that this simulation belongs to: within one, a simulation that was killed
    or restarted goes on with the same world; "" always begins anew.
    """

    speed: str = "realtime"
    robot: str = "tidybot"
    wait_for: tuple[str, ...] = ()
    viewer: bool = False
    max_speed: float = 0.5
    max_turn: float = 1.5
    acceleration: float = 0.7
    turn_acceleration: float = 2.5
    position_tolerance: float = 0.02
    angle_tolerance: float = 0.05
    stream_timeout: float = 0.25
    target_timeout: float = 0.2
    sensors: Literal["bought", "ideal"] = "bought"
    lidar_noise: float = 0.01
    lidar_missing: float = 0.01
    odometry_slip: float = 0.02
    odometry_veer: float = 0.005
    odometry_noise: float = 0.005
    obstacles: tuple[Obstacle | str, ...] | str = ()
    guests: tuple[Guest, ...] = ()
    snapshot_dir: str = ""
    run: str = ""
    battery: float = 1.0
