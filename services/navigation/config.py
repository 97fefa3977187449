"""Parameters of navigation."""

from common.approach import EDGE_DISTANCE, STAND_OFF
from common.config import Config


class NavigationConfig(Config, frozen=True):
    """Lengths in metres, speeds in m/s, times in seconds."""

    resolution: float = 0.05
    lidar_height: float = 0.2
    footprint_radius: float = 0.37
    clearance: float = 0.02
    inflation: float = 0.65
    lookahead: float = 0.5
    corridor: float = 0.34
    stand_off: float = STAND_OFF
    edge_distance: float = EDGE_DISTANCE
    obstacle_memory: float = 30.0
    blocked_wait: float = 4.0
    keep_off: float = 0.9
    back_off: float = 0.5
    back_off_time: float = 3.0
    retries: int = 2
    usual_speed: float = 0.4
    no_progress: float = 6.0
    min_average_speed: float = 0.12
    timeout_margin: float = 30.0
    scan_timeout: float = 0.5
    odometry_timeout: float = 0.5
    look_time: float = 2.0
    look_memory: float = 60.0
    find_timeout: float = 170.0
    find_spot: tuple[float, float, float] = (1.0, 1.0, 0.0)
