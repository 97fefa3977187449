"""The growing map: trajectory, grid and pictures, each picture fixed to a keyframe so that it moves with it."""

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from common import messages as m
from common.files.map_file import OCCUPIED
from common.floor_plan import Vec2
from common.geometry import Pose2, compose, inverse
from services.mapping.barriers import Met, panes, shut
from services.mapping.depth import CameraModel, Picture
from services.mapping.grid import Grid
from services.mapping.scan import Scan
from services.mapping.scan_matching import placed
from services.mapping.trajectory import Trajectory
from services.mapping.views import FRONTIER_RANGE, SURFACE_RANGE, Survey, shown, survey


class Shot(NamedTuple):
    """A picture taken at `pose` in the frame of keyframe `keyframe`; `still`: the robot stood."""

    keyframe: int
    pose: Pose2
    picture: Picture
    still: bool


class Mapper:
    """Builds the map; to be called in the service's worker, since every call may take some tens of milliseconds.

    `met`: what held the robot up unseen, each in the frame of a keyframe, `panes` what that tells of [map].
    """

    def __init__(self, low: tuple[float, float], high: tuple[float, float]) -> None:
        self.trajectory = Trajectory()
        self.grid = Grid(low, high)
        self.shots: list[Shot] = []
        self.met: list[tuple[int, Met]] = []
        self.panes: list[tuple[Vec2, Vec2]] = []
        self._camera = CameraModel()
        self._unread: list[tuple[m.Rgbd, int, Pose2, bool]] = []

    def add_scan(self, scan: Scan, odometry: Pose2) -> NDArray[np.uint8]:
        """Take a keyframe; returns the states of all cells."""
        if self.trajectory.runs[-1] == len(self.trajectory) > 0:
            self.grid.fade()
        bent = self.trajectory.add(scan, odometry)
        if bent:
            self.draw()
        else:
            self.grid.add_scan(self.trajectory.scans[-1], self.trajectory.poses[-1])
        return self.grid.states()

    def add_picture(self, image: m.Rgbd, odometry: Pose2, still: bool) -> NDArray[np.uint8]:
        """Take a picture from when the base was at `odometry` [odom]; returns the states of all cells.

        Raises:
            PictureError: the picture's data do not have its size.
        """
        keyframe = len(self.trajectory) - 1
        pose = compose(inverse(self.trajectory.poses[keyframe]), compose(self.trajectory.odom, odometry))
        if still and not self._camera.learned:
            self._camera.learn(image)
        if not self._camera.learned:
            if still:
                self._unread.append((image, keyframe, pose, still))
            return self.grid.states()
        unread, self._unread = [*self._unread, (image, keyframe, pose, still)], []
        for other, at, seen_from, stood in unread:
            shot = Shot(at, seen_from, self._camera.read(other), stood)
            self.shots.append(shot)
            self._draw(shot)
        return self.grid.states()

    def _draw(self, shot: Shot) -> None:
        base = compose(self.trajectory.poses[shot.keyframe], shot.pose)
        self.grid.add_picture(placed(shot.picture.floor, base), placed(shot.picture.above, base))
        if shot.still:
            walls, tall = self.grid.walls, self.grid.tall
            self.grid.near |= shown(self.grid, base, SURFACE_RANGE, tall)
            in_view = shown(self.grid, base, FRONTIER_RANGE, walls) | shown(self.grid, base, SURFACE_RANGE, tall)
            self.grid.looked += in_view & (self.grid.looked < 250)

    def draw(self) -> None:
        """Draw the grid anew from the present poses of all keyframes."""
        self.grid.clear()
        self.grid.near[:], self.grid.looked[:] = False, 0
        runs = [*self.trajectory.runs, len(self.trajectory)]
        for first, end in pairwise(runs):
            if first:
                self.grid.fade()
            for scan, pose in zip(self.trajectory.scans[first:end], self.trajectory.poses[first:end], strict=True):
                self.grid.add_scan(scan, pose)
            for shot in self.shots:
                if first <= shot.keyframe < end:
                    self._draw(shot)

    def meet(self, met: Met) -> NDArray[np.uint8]:
        """Take a place where something unseen held the base up; returns the states of all cells."""
        keyframe = len(self.trajectory) - 1
        back = inverse(self.trajectory.poses[keyframe])
        self.met.append((keyframe, _moved(met, back)))
        return self.states()

    def states(self) -> NDArray[np.uint8]:
        """FREE, OCCUPIED or UNKNOWN for each cell; fits panes anew, as more of their frames may be known."""
        barriers = [_moved(met, self.trajectory.poses[keyframe]) for keyframe, met in self.met]
        self.grid.shut[:] = False
        states = self.grid.states()
        self.panes = panes(barriers, states, self.grid)
        self.grid.shut = shut(barriers, self.panes, self.grid)
        states[self.grid.shut] = OCCUPIED
        return states

    def survey(self, here: Pose2, barred: list[Vec2]) -> tuple[Survey, NDArray[np.uint8]]:
        """What is left to be seen and the next view, with the states of all cells."""
        states = self.states()
        return survey(self.grid, states, here, barred), states


def _moved(met: Met, frame: Pose2) -> Met:
    here, ahead = (compose(frame, (*point, 0.0))[:2] for point in met)
    return Met(here, ahead)
