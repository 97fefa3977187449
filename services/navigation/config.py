"""Parameters of navigation."""

from typing import Literal

from common.approach import EDGE_DISTANCE, FOOTPRINT, STAND_OFF
from common.config import Config


class NavigationConfig(Config, frozen=True):
    """Lengths in metres, speeds in m/s, times in seconds."""

    map: Literal["household", "mapping"] = "household"
    """Whose map it drives by: the floor plan of the household, or the growing one of the mapping service."""
    resolution: float = 0.05
    """Of the costmap; chosen: a door of 0.9 m is 18 cells, a plan for the flat takes a fraction of a second."""
    lidar_height: float = 0.2
    """Of the lidar's plane over the floor: as the robot carries it."""
    footprint_radius: float = FOOTPRINT
    """Of the circle around the base."""
    initial_pose: Literal["home", "unknown"] = "home"
    """Where the robot is when navigation starts: at the household's home until the lidar says otherwise, or anywhere.
    """
    flat: str = ""
    """What several robots on one router share: those that tell the same name keep out of each other's way. "": the
    simulation that they are in, or else the map; "none": it is told of nobody and tells nobody."""
    lost_patience: float = 90.0
    """How long a goal waits for a robot that is lost; chosen: time to look into the next room and the one after."""
    clearance: float = 0.02
    """Added to the footprint when paths are planned; chosen: the error of the pose."""
    inflation: float = 0.65
    """Clearance from which on a path costs no more than its length; chosen: the middle of a door is still preferred."""
    lookahead: float = 0.5
    """Of the path follower; chosen: short enough for doors, long enough not to waver."""
    corridor: float = FOOTPRINT - 0.02
    """Half of the width that must be free of lidar points; chosen: below the footprint, or door frames brake."""
    stand_off: float = STAND_OFF
    """From the base's centre to an object to grab."""
    edge_distance: float = EDGE_DISTANCE
    """From the base's centre to the edge of a surface that it stands before, at least."""
    obstacle_memory: float = 30.0
    """How long something out of sight is remembered; chosen: a drive through the flat takes about as long."""
    lasting_after: float = 300.0
    """How far apart two sightings of what the map does not have make it a part of the map; chosen: nobody stands for
    five minutes without moving a foot."""
    blocked_wait: float = 4.0
    """Wait before another path is tried; chosen: a person clears a door in that time."""
    keep_off: float = 0.9
    """Distance kept from what blocks the only path; chosen: room to turn and for a person to pass."""
    back_off: float = 0.5
    """How far it goes back before another path is tried, at most; chosen: out of a door."""
    back_off_time: float = 3.0
    """How long it goes back; chosen: `back_off` at a low speed."""
    retries: int = 2
    """Other paths tried when one is blocked [count]; fixed by the contract."""
    usual_speed: float = 0.4
    """For the estimate of the time that is left; chosen: the average between doors."""
    no_progress: float = 6.0
    """Time without progress on a free path before it recovers; chosen: longer than a turn on the spot."""
    min_average_speed: float = 0.12
    """For the time limit of a path; chosen: a third of the usual speed."""
    timeout_margin: float = 30.0
    """Added to the time limit of a path; chosen: two waits and retreats."""
    scan_timeout: float = 0.5
    """Silence of the lidar after which the goal fails: five scans at 10 Hz."""
    odometry_timeout: float = 0.5
    """Silence of the wheels after which the goal fails: fifty samples at 100 Hz."""
    look_time: float = 2.0
    """Rest at each viewpoint of a search; chosen: perception takes and reads a picture in about a second."""
    look_memory: float = 60.0
    """How long what a search looked at counts as known to the next; chosen: nobody has moved much since."""
    find_timeout: float = 170.0
    """Time limit of a search; chosen: below the brain's for a navigation goal."""
    find_spot: tuple[float, float, float] = (1.0, 1.0, 0.0)
    """Where an item is looked for without eyes, [m, m, rad]; the contract's example."""
