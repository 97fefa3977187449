"""Parameters of mapping."""

from common.config import Config


class MappingConfig(Config, frozen=True):
    """How mapping explores and what it writes. Lengths in metres, angles in radians, times in seconds."""

    out: str = "map"
    """Directory that the map is written to."""
    resume: str = ""
    """Directory of a map to go on with; "" begins anew."""
    name: str = "mapped home"
    """Name of the household that is written."""
    keyframe_distance: float = 0.30
    """Way between two scans that are kept; chosen: a tenth of a room."""
    keyframe_turn: float = 0.35
    """Turn between two scans that are kept; chosen: 20 degrees."""
    picture_period: float = 0.4
    """Time between two pictures while it drives; chosen: 0.2 m at the speed of the base."""
    settle: float = 0.5
    """Rest before the pictures of a view; chosen: the base has come to a stop and the state is no longer stale."""
    view_pictures: int = 2
    """Pictures of each view [count]; chosen: their noise is independent."""
    width: int = 320
    """Columns of a picture [pixels]."""
    height: int = 240
    """Rows of a picture [pixels]."""
    goal_timeout: float = 90.0
    """Time for the drive to one view; chosen: across a large flat and two waits."""
    match_seconds: float = 0.05
    """What one scan takes in the worker, in lockstep."""
    plan_seconds: float = 0.3
    """What the choice of a view takes in the worker, in lockstep."""
    save_seconds: float = 2.0
    """What the last optimisation and the files take in the worker, in lockstep."""
