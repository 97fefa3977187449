"""Simultaneous localisation and mapping: keyframes from scans and odometry, matched, joined and optimised."""

import math

import numpy as np

from common.geometry import Array, Pose2, compose, inverse
from services.mapping.pose_graph import Edge, PoseGraph
from services.mapping.scan import Scan
from services.mapping.scan_matching import Target, placed

BESIDE, OLDEST = 1.0, 5
"""Distance [m] of keyframes that the newest is matched to beside the last one, and how many of them, the oldest ones.
Chosen: they see the same walls; where the robot turns on the spot or comes again, no error adds up."""
AROUND = 4
"""Keyframes before and after the nearest old one that a loop is closed to with it [count]; chosen: they show the same
room."""
NEAR, AGO = 2.5, 20
"""Distance [m] and age [count] of keyframes that a loop may close to; chosen: they see the same walls."""
LOOP_EVERY = 4
"""Keyframes between two attempts to close a loop [count]; chosen: a metre of way."""
LOOP_FIT, SCAN_FIT = 0.75, 0.5
"""Share of points that must lie on the other scans for a loop, and for a match, to count; chosen: rooms look alike."""
LOOP_SHIFT = (0.5, 0.15)
"""Greatest correction [m, rad] that a loop is believed; chosen: far beyond the drift of a matched flat."""
LOOP_REACH = 0.5
"""Greatest distance of points that are taken for the same while a loop closes [m]; chosen: LOOP_SHIFT."""
BENT = 0.01
"""Motion of a keyframe [m] by optimisation after which the grid is drawn anew: a fifth of a cell."""


class Trajectory:
    """Keyframes with their scans; `odom` is the pose of frame odom in the map."""

    def __init__(self) -> None:
        self.graph = PoseGraph()
        self.scans: list[Scan] = []
        self._odometry: list[Pose2] = []
        self.loops = 0
        self.runs = [0]
        """Keyframes with which runs of the robot began."""
        self.odom: Pose2 = (0.0, 0.0, 0.0)
        self._tried = 0

    def __len__(self) -> int:
        return len(self.scans)

    @property
    def poses(self) -> list[Pose2]:
        return self.graph.poses

    def resume(self, graph: PoseGraph, scans: list[Scan], runs: list[int]) -> None:
        """Go on with an older map, whose runs began at the keyframes `runs`; the robot stands where it began."""
        self.graph, self.scans = graph, list(scans)
        self._odometry = [(math.nan,) * 3] * len(scans)
        self.runs = [*runs, len(scans)]

    def due(self, odometry: Pose2, distance: float, turn: float) -> bool:
        """True when the base has moved far enough since the last keyframe for another."""
        if not self._odometry or math.isnan(self._odometry[-1][0]):
            return True
        dx, dy, angle = compose(inverse(self._odometry[-1]), odometry)
        return math.hypot(dx, dy) >= distance or abs(angle) >= turn

    def add(self, scan: Scan, odometry: Pose2) -> bool:
        """Add a keyframe; True when earlier ones have moved by a loop closure."""
        if not self.scans or math.isnan(self._odometry[-1][0]):
            return self._first(scan, odometry)
        step = compose(inverse(self._odometry[-1]), odometry)
        last = len(self.scans) - 1
        guess = compose(self.poses[last], step)
        edges = [Edge(last, last + 1, step, "odometry")]
        near = [i for i in range(last) if math.dist(self.poses[i][:2], guess[:2]) < BESIDE][:OLDEST]
        if len(points := self._points([*near, last])):
            match = Target(points).match(scan.points, guess)
            if match.fit >= SCAN_FIT and math.dist(match.pose[:2], guess[:2]) < 0.2:
                guess = match.pose
                anchor = near[0] if near else last
                edges.append(Edge(anchor, last + 1, compose(inverse(self.poses[anchor]), guess), "scan"))
        self._keep(scan, odometry, guess, edges)
        return self._close()

    def _first(self, scan: Scan, odometry: Pose2) -> bool:
        """The first keyframe of a run: the map's origin, or matched to an older map from there."""
        if not self.scans:
            self._keep(scan, odometry, odometry, [])
            return False
        pose = odometry
        near = [i for i, p in enumerate(self.poses) if math.dist(p[:2], pose[:2]) < NEAR]
        edges: list[Edge] = []
        if near:
            match = Target(self._points(near)).match(scan.points, pose, LOOP_REACH)
            pose = match.pose
            edges = [Edge(i, len(self.scans), compose(inverse(self.poses[i]), pose), "loop") for i in near[:3]]
        else:
            edges = [Edge(0, len(self.scans), compose(inverse(self.poses[0]), pose), "odometry")]
        self._keep(scan, odometry, pose, edges)
        return False

    def _keep(self, scan: Scan, odometry: Pose2, pose: Pose2, edges: list[Edge]) -> None:
        self.graph.add(pose, *edges)
        self.scans.append(scan)
        self._odometry.append(odometry)
        self.odom = compose(pose, inverse(odometry))

    def _points(self, numbers: list[int]) -> Array:
        """End points (n, 2) [map] of some keyframes."""
        parts = [placed(self.scans[i].points, self.poses[i]) for i in numbers if len(self.scans[i].points)]
        return np.concatenate(parts) if parts else np.empty((0, 2))

    def _close(self) -> bool:
        """Match the newest keyframe to the oldest ones that are near, and bend the graph when that fits."""
        here = len(self.scans) - 1
        if here - self._tried < LOOP_EVERY:
            return False
        pose = self.poses[here]
        old = [i for i in range(here - AGO) if math.dist(self.poses[i][:2], pose[:2]) < NEAR]
        if not old:
            return False
        self._tried = here
        nearest = min(old, key=lambda i: math.dist(self.poses[i][:2], pose[:2]))
        around = [i for i in old if abs(i - nearest) <= AROUND]
        match = Target(self._points(around)).match(self.scans[here].points, pose, LOOP_REACH)
        shift = compose(inverse(pose), match.pose)
        if match.fit < LOOP_FIT or math.hypot(*shift[:2]) > LOOP_SHIFT[0] or abs(shift[2]) > LOOP_SHIFT[1]:
            return False
        self.graph.edges.append(Edge(nearest, here, compose(inverse(self.poses[nearest]), match.pose), "loop"))
        self.loops += 1
        moved = self.graph.optimise()
        self.odom = compose(self.poses[here], inverse(self._odometry[here]))
        return moved > BENT
