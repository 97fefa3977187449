"""The pose graph: keyframes joined by odometry, scan matches and loop closures, optimised by gtsam.

Source: Grisetti et al., "A tutorial on graph-based SLAM", 2010; Dellaert, "Factor graphs and GTSAM", 2012.
"""

from typing import Any, Literal, NamedTuple

import numpy as np

from common.geometry import Pose2

Kind = Literal["odometry", "scan", "loop"]
SIGMAS: dict[Kind, tuple[float, float, float]] = {
    "odometry": (0.03, 0.03, 0.02),
    "scan": (0.01, 0.01, 0.004),
    "loop": (0.015, 0.015, 0.006),
}
"""Standard deviation of a constraint [m, m, rad]. Odometry: 2 % of the way between keyframes, and its noise; chosen on
the safe side. Matches: the lidar's noise of 1 cm over some hundred rays, that err together."""
FIRST = (1e-4, 1e-4, 1e-4)
"""Of the first keyframe, which is the map's origin."""
HUBER = 2.0
"""Error in standard deviations beyond which a match pulls less: one that is wrong does not bend the map."""


class Edge(NamedTuple):
    """A constraint: the pose of keyframe `end` in the frame of keyframe `start`."""

    start: int
    end: int
    pose: Pose2
    kind: Kind


class PoseGraph:
    """`poses` [map] of the keyframes in order, `edges` between them."""

    def __init__(self) -> None:
        self.poses: list[Pose2] = []
        self.edges: list[Edge] = []

    def add(self, pose: Pose2, *edges: Edge) -> int:
        """Add a keyframe with a guess of its pose [map]; returns its number."""
        self.poses.append(pose)
        self.edges += edges
        return len(self.poses) - 1

    def optimise(self) -> float:
        """Move the keyframes to the optimum of all constraints; returns the farthest that one moved [m]."""
        if not self.edges:
            return 0.0
        import gtsam

        graph, values = gtsam.NonlinearFactorGraph(), gtsam.Values()
        for number, pose in enumerate(self.poses):
            values.insert(number, gtsam.Pose2(*pose))
        graph.add(gtsam.PriorFactorPose2(0, gtsam.Pose2(*self.poses[0]), _noise(FIRST)))
        huber = gtsam.noiseModel.mEstimator.Huber.Create(HUBER)
        for edge in self.edges:
            noise = _noise(SIGMAS[edge.kind])
            if edge.kind != "odometry":
                noise = gtsam.noiseModel.Robust.Create(huber, noise)
            graph.add(gtsam.BetweenFactorPose2(edge.start, edge.end, gtsam.Pose2(*edge.pose), noise))
        found = gtsam.LevenbergMarquardtOptimizer(graph, values).optimize()
        before = np.array(self.poses)
        moved = [found.atPose2(number) for number in range(len(self.poses))]
        self.poses = [(p.x(), p.y(), p.theta()) for p in moved]
        return float(np.hypot(*(np.array(self.poses) - before)[:, :2].T).max())


def _noise(sigmas: tuple[float, float, float]) -> Any:
    import gtsam

    return gtsam.noiseModel.Diagonal.Sigmas(np.array(sigmas))
