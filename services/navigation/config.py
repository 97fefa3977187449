"""Parameters of navigation."""

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
    stand_off: float = 0.56
    edge_distance: float = 0.40
    obstacle_memory: float = 4.0
    blocked_wait: float = 4.0
    retries: int = 2
    no_progress: float = 6.0
    min_average_speed: float = 0.12
    timeout_margin: float = 30.0
    scan_timeout: float = 0.5
    odometry_timeout: float = 0.5
