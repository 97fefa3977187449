"""Recovery of a blocked goal: back a little the way the robot came, or aside for a person who waits for it."""

from collections.abc import Sequence

from common.geometry import Pose2
from services.navigation.config import NavigationConfig
from services.navigation.ended import Ended
from services.navigation.motion.breadcrumbs import Breadcrumbs
from services.navigation.motion.obstacle_tracker import Obstacle
from services.navigation.motion.path_follower import PathFollower
from services.navigation.motion.progress import Standoff
from services.navigation.motion.retreat import PassingPlace, Retreat, passing_place
from services.navigation.planning.costmap import Costmap
from services.navigation.planning.planner import PathPlanner

OUT_OF_SIGHT = 3.0
"""Age from which what was seen may be gone when there is no path [s]; chosen: longer than somebody hides a cell."""


class Recovery:
    """The recoveries of one goal; `under_way` is the motion back or aside that is being carried out, None for none."""

    def __init__(self, config: NavigationConfig, costmap: Costmap, planner: PathPlanner) -> None:
        self._config, self._map, self._planner = config, costmap, planner
        self._breadcrumbs = Breadcrumbs()
        self._standoff = Standoff()
        self._retries = 0
        self.under_way: Retreat | PassingPlace | None = None

    @property
    def stands_its_ground(self) -> bool:
        """True once people have come back again and again after room was made: the robot then makes none any more."""
        return self._standoff.again

    def made_room(self, now: float) -> None:
        """Note that the robot makes room; call in each step in which it stops or steps aside for somebody."""
        self._standoff.met(now)

    def note_pose(self, pose: Pose2) -> None:
        """Note where the robot is [map], in each step, for the way back."""
        self._breadcrumbs.add(pose)

    def relocated(self) -> None:
        """Forget the way back: the pose estimate has jumped."""
        self.under_way, self._breadcrumbs = None, Breadcrumbs()

    def back_off(self, pose: Pose2, now: float, why: str, code: str, touching: bool = False) -> None:
        """Begin to go back the way the robot came, then plan anew; `touching`: away from what it touches.

        These are all the retries of a blocked path: whoever sent the goal adds none.

        Raises:
            Ended: `code`, after the last retry.
        """
        if self._retries >= self._config.retries:
            raise Ended("failed", code, f"{why} after {self._retries} retries")
        self._retries += 1
        self._map.obstacles.doubt(now, OUT_OF_SIGHT, pose[:2])
        config = self._config
        radius = config.footprint_radius
        if touching:
            radius = min(radius, self._map.clearance(pose[0], pose[1]) - self._map.resolution / 2)
        back = self._breadcrumbs.retreat(pose, self._map, radius, config.back_off)
        self.under_way = Retreat(back, now + config.back_off_time, config.corridor)

    def let_pass(self, pose: Pose2, people: Sequence[Obstacle], now: float) -> None:
        """Begin to step aside for a person who waits for the robot; call in each step with a person before it.

        Not once it goes on behind them: who it loses sight of is soon forgotten to be a person.
        """
        if self._map.people_pass:
            return
        person = self._standoff.with_whom((pose[0], pose[1]), people, now)
        if person is None:
            return
        path = passing_place(pose, person, self._map, self._planner)
        if path is not None:
            config = self._config
            follower = PathFollower(path, (*path[-1], pose[2]), config.lookahead, config.corridor)
            self.under_way = PassingPlace(follower, person, self._map, config.footprint_radius, now)
