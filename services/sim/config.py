"""Parameters of the simulation."""

from typing import Literal

from common.config import Config


class Obstacle(Config, frozen=True):
    """Something the static map does not have: stands at its first waypoint, or walks the waypoints to and fro."""

    name: str
    kind: Literal["box", "cylinder"] = "cylinder"
    size: tuple[float, float, float] = (0.4, 0.4, 1.6)
    waypoints: tuple[tuple[float, float], ...] = ()
    speed: float = 0.0


class SimConfig(Config, frozen=True):
    """`speed` is `realtime`, a factor, or `max`; `wait_for` names the participants that lockstep waits for.

    Wheel odometry: `slip` is the largest constant scale error, `veer` the largest constant turn [rad/m],
    `noise` a random walk [m and rad per sqrt(m)].
    """

    speed: str = "realtime"
    wait_for: tuple[str, ...] = ()
    viewer: bool = False
    max_speed: float = 0.5
    max_turn: float = 1.5
    acceleration: float = 0.7
    turn_acceleration: float = 2.5
    position_tolerance: float = 0.02
    angle_tolerance: float = 0.05
    stream_timeout: float = 0.25
    lidar_noise: float = 0.004
    odometry_slip: float = 0.02
    odometry_veer: float = 0.005
    odometry_noise: float = 0.005
    obstacles: tuple[Obstacle, ...] = ()
    snapshot_dir: str = ""
