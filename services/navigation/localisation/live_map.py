"""The map while it is being made: the mapping service's grid, and where it puts the wheels' frame."""

from common import messages as m
from common import topics
from common.bus.port import Io
from common.geometry import Pose2
from services.navigation.planning.costmap import Costmap


class LiveMap:
    """Gives each new grid to the costmap; `odom` is the pose of frame odom in the map, None before the first grid."""

    def __init__(self, io: Io, costmap: Costmap) -> None:
        self._io, self._costmap = io, costmap
        self._grid: m.MapGrid | None = None
        self.odom: Pose2 | None = None

    def update(self) -> None:
        """Take the newest grid."""
        grid = self._io.latest(topics.MAP_GRID)
        if grid is None or grid is self._grid:
            return
        self._grid = grid
        try:
            self._costmap.replace(grid)
        except ValueError as error:
            self._io.count_drop(topics.MAP_GRID.key, str(error))
            return
        self.odom = grid.odom
