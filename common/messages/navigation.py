"""Navigation: goals, progress, pose and costmap."""

from typing import Literal

from common.messages.base import Message
from common.messages.perception import ObjectRef

NavStatus = Literal["idle", "navigating", "arrived", "failed"]
DriveState = Literal["driving", "free", "fixed"]


class NavigationGoal(Message):
    """`find <item>`, `goto <place>`, `return_to_start` or `stop`."""

    goal: str
    id: str = ""
    attempt: int = 1


class NavigationStatus(Message):
    status: NavStatus
    goal_id: str = ""
    attempt: int = 0
    code: str = ""
    detail: str = ""


class NavGoal(Message):
    """A standing pose [m, rad] to drive to; the answers come on `navigation_feedback`.

    `object`: what the pose is for. A navigator that knows where the arm reaches it from may stand elsewhere before it.
    """

    x: float
    y: float
    theta: float = 0.0
    frame: str = "map"
    id: str = ""
    attempt: int = 1
    object: ObjectRef | None = None


class NavigationFeedback(Message):
    """How a goal stands: `distance_remaining` [m], `eta` [s].

    `recoveries` counts other paths taken or tried since the goal was sent; the sender of a goal that failed BLOCKED
    adds to them only what is missing to two. One that failed PERSON_IN_WAY would have a way but for people, who walk
    on. An `attempt` of 0 is one that the navigator does not state. `map_fit` is the share of what the lidar saw lately
    that the map explains, `met` (x, y) [map] what held the base up last that no sensor sees, such as a pane of glass;
    empty: nothing.
    """

    goal_id: str
    status: NavStatus
    distance_remaining: float = 0.0
    eta: float = 0.0
    recoveries: int = 0
    code: str = ""
    attempt: int = 0
    detail: str = ""
    map_fit: float = 1.0
    met: list[float] = []


LOST = 1.0
"""Variance of a coordinate [m2] from which on the pose says nothing; chosen: no room can be told from the next."""


class PoseEstimate(Message):
    """The robot's pose in frame `map` as navigation believes it; `covariance` row-major 3 x 3.

    A robot that does not know where it is says so by a variance of x or y above 1 m2.
    """

    t: float
    x: float
    y: float
    theta: float
    covariance: list[float] = []

    @property
    def lost(self) -> bool:
        """The robot does not know where it is."""
        return len(self.covariance) == 9 and max(self.covariance[0], self.covariance[4]) > LOST


class DriveIntent(Message):
    """Where a robot stands and which way it takes next, for the other robots of its flat.

    `flat` names the frame `map` that they share: who tells another name stands somewhere else. `radius` is the
    footprint's [m]. `path` are points ahead [map], from where it stands; empty: it stays. `state`: it drives, it has
    nothing to do and gets out of anybody's way (`free`), or it stays where it is (`fixed`). `gives_way_to`: the robots
    for whom it waits or gets out of the way now; `cannot_yield_to`: those that it finds no room to let pass, so that
    they have to.
    """

    t: float
    flat: str
    x: float
    y: float
    theta: float
    radius: float
    state: DriveState = "driving"
    path: list[tuple[float, float]] = []
    gives_way_to: list[str] = []
    cannot_yield_to: list[str] = []


class NavPath(Message):
    """The path being followed, for viewers: points in frame map."""

    t: float
    points: list[tuple[float, float]]
    goal_id: str = ""


class Costmap(Message):
    """Room for the base's centre, for viewers: clearance of `width` x `height` cells of `resolution` [m].

    `cells` is zlib of uint8, row by row from the south-west corner (`x`, `y`): 0 occupied, 255 for `far` [m] or more.
    """

    t: float
    x: float
    y: float
    resolution: float
    width: int
    height: int
    far: float
    cells: bytes
