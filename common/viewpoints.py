"""Viewpoint planner: where the base stands so that the head camera sees the surfaces of a floor plan. Pure.

The surfaces are sample points, a viewpoint is a base pose (x, y, theta) [map] and the points that it shows. Whoever
searches keeps what was looked at and asks `Viewpoints.best` for the next pose.
"""

import math
from collections.abc import Callable, Collection
from functools import cached_property, lru_cache

import msgspec
import numpy as np
from numpy.typing import NDArray

from common.approach import BIN_RIM
from common.floor_plan import FloorPlan, Place, Receptacle
from common.free_sides import floor_from_home
from common.furniture_tops import seats
from common.geometry import Array, Mask, Pose2, Rectangle
from common.messages import CameraMount, RobotDescription

NOMINAL = CameraMount(x=-0.12, z=1.30, pitch=0.62, fovy=math.radians(62))
"""Camera of a robot whose description names none: the built-in robot's."""
ASPECT = 4 / 3
"""Width of a picture by its height [-]: perception asks for 640 x 480."""
USED = 0.92
"""Share of the picture's angles that counts [-]; chosen: what the picture's edge cuts off is not recognised."""
REACH = 2.2
"""Floor distance up to which an object is recognised [m]; chosen: well within the 3 m of bench.perception."""
NEAR = 1.4
"""The same for what lies flat, such as a comb [m]; chosen: 4 mm stand out of the noise of depth there."""
NEAREST = 0.2
"""Depth from which the camera sees [m]; chosen: the near limit of common RGB-D cameras."""
SPACING = 0.12
"""Distance between sample points [m]; chosen: about the size of the objects."""
INSET = 0.04
"""Distance of the outermost sample points from a surface's edge [m]; chosen: half of an object's width."""
LIFT = 0.05
"""Height of the sample points over their surface [m]; chosen: the middle of a small object."""
DISTANCES = (0.50, 0.85)
"""From the base's centre to the edge that it looks over [m]; chosen: as near as it can stand, and a step back."""
ALONG = 0.55
"""Step from one viewpoint to the next along an edge [m]; chosen: a picture at 0.5 m shows about twice as much."""
LOOK_COST = 2.0
"""What a look costs beside the way to it [m of way]; chosen: settling and a picture take as long as 1 m of driving."""
LEAST_GAIN = 3.0
"""New points that a view must show to be driven to [count]. Chosen: a thing at one or two points that nobody has seen
reaches far enough beside them to be seen there."""
SEE_OVER = 0.3
"""Furniture that ends less than this below the camera hides what is behind it [m]."""
APART, PATCH = 4, 2
"""From one spot of free floor to the next from which what is hidden is looked at [cells], 20 cm, and up to how many
hidden points are left alone [count]: beside them enough of a thing shows."""
HEADINGS = 12
"""Directions that are compared when the robot turns on the spot [count]: 30 degrees, half of what a picture shows."""


def viewpoints_of(floor_plan: FloorPlan, robot: RobotDescription | None) -> "Viewpoints":
    """The viewpoints of a floor plan for a robot's head camera; they take a while to work out and are made once."""
    camera = robot.head_camera if robot is not None else None
    return _made(_outlines(floor_plan), msgspec.structs.astuple(camera if camera is not None else NOMINAL))


def _outlines(plan: FloorPlan) -> FloorPlan:
    """What a camera can tell of a plan: names make no other viewpoints."""
    surfaces = tuple(
        msgspec.structs.replace(r, name="", aliases=(), named=True, colour="", spawn=True) for r in plan.receptacles
    )
    home = Place(name="", x=plan.home.x, y=plan.home.y)
    return FloorPlan(
        name="", low=plan.low, high=plan.high, home=home, walls=plan.walls, furniture=plan.furniture,
        receptacles=surfaces,
    )  # fmt: skip


@lru_cache(maxsize=4)
def _made(floor_plan: FloorPlan, camera: tuple[float, ...]) -> "Viewpoints":
    return Viewpoints(floor_plan, CameraMount(**dict(zip(CameraMount.__struct_fields__, camera, strict=True))))


class Viewpoints:
    """`points` (p, 3) [m] on the surfaces, `poses` (v) to look from, `shows` (v, p): which points each pose shows.

    `surface` (p,): the number of each point's surface, among those that are no bins; sofas and beds come after them.
    `listed` (p,): the point is on a surface that the floor plan lists.
    """

    def __init__(self, floor_plan: FloorPlan, camera: CameraMount) -> None:
        self.camera, self.plan = camera, floor_plan
        self._surfaces = [*(r for r in floor_plan.receptacles if r.kind != "bin"), *seats(floor_plan)]
        found = [_points_on(r) for r in self._surfaces]
        self.points: Array = np.concatenate(found or [np.empty((0, 3))])
        self.surface = np.repeat(np.arange(len(found)), [len(points) for points in found])
        self.listed: Mask = self.surface < len(found) - len(seats(floor_plan))
        self._screens = _screens(floor_plan, camera.z)
        self._across = math.tan(USED * math.atan(math.tan(camera.fovy / 2) * ASPECT))
        self._upright = math.tan(USED * camera.fovy / 2)

    @cached_property
    def _views(self) -> list[tuple[Pose2, Mask]]:
        before = [pose for r in self._surfaces for pose in _poses_before(r)]
        views = [(pose, shown) for pose in before if (shown := self.visible(pose)).any()]
        return views + self._from_elsewhere(views)

    def _from_elsewhere(self, views: list[tuple[Pose2, Mask]]) -> list[tuple[Pose2, Mask]]:
        """Poses from any free floor for what shows from no view where the base fits: a passage before a dresser may be
        too narrow for each of them."""
        cells, floor = floor_from_home(self.plan)
        hidden = ~np.any(
            [np.zeros(len(self.points), bool)] + [s for p, s in views if floor[cells.cell(*p[:2])]], axis=0
        )
        spots = cells.centres()[::APART, ::APART][floor[::APART, ::APART]]
        found: list[tuple[Pose2, Mask]] = []
        while hidden.any():
            best, most = None, PATCH
            for x, y in spots.tolist():
                to = self.points[hidden, :2] - (x, y)
                if not len(near := to[np.hypot(*to.T) < REACH]):
                    continue
                pose = (round(x, 3), round(y, 3), round(float(math.atan2(*near.mean(axis=0)[::-1])), 3))
                shown = self.visible(pose)
                if (count := int(np.count_nonzero(shown & hidden))) > most:
                    best, most = (pose, shown), count
            if best is None:
                break
            found.append(best)
            hidden &= ~best[1]
        return found

    @cached_property
    def poses(self) -> list[Pose2]:
        """Base poses that face a surface from before one of its free edges, and show something."""
        return [pose for pose, _ in self._views]

    @cached_property
    def shows(self) -> NDArray[np.bool_]:
        """Which points (v, p) each of the poses shows."""
        return np.array([shown for _, shown in self._views], bool).reshape(len(self._views), len(self.points))

    @cached_property
    def near(self) -> NDArray[np.bool_]:
        """Which of these points (v, p) are so near that flat things are recognised."""
        return np.array([self.visible(pose, NEAR) for pose in self.poses], bool).reshape(self.shows.shape)

    def visible(self, pose: Pose2, reach: float = REACH) -> Mask:
        """Which points (p,) the camera sees from a base pose: in the picture, within `reach`, nothing tall between."""
        camera = self.camera
        heading = pose[2] + camera.yaw
        cos, sin = math.cos(heading), math.sin(heading)
        turn, side = math.cos(pose[2]), math.sin(pose[2])
        eye = np.array([pose[0] + camera.x * turn - camera.y * side, pose[1] + camera.x * side + camera.y * turn])
        to = self.points[:, :2] - eye
        ahead, left = cos * to[:, 0] + sin * to[:, 1], cos * to[:, 1] - sin * to[:, 0]
        up = self.points[:, 2] - camera.z
        tilt, drop = math.cos(camera.pitch), math.sin(camera.pitch)
        depth, down = ahead * tilt - up * drop, -(ahead * drop + up * tilt)
        inside: Mask = (depth > NEAREST) & (np.hypot(to[:, 0], to[:, 1]) < reach)
        inside &= (np.abs(left) < depth * self._across) & (np.abs(down) < depth * self._upright)
        for screen in self._screens:
            if not inside.any():
                break
            inside[inside] = ~_crosses(eye, self.points[inside, :2], screen)
        return inside

    def covered(self, looked_from: Collection[Pose2], reach: float = REACH) -> Mask:
        """Which points (p,) one of the poses shows within `reach` [m]."""
        seen = np.zeros(len(self.points), bool)
        for pose in looked_from:
            seen |= self.visible(pose, reach)
        return seen

    def turn(self, pose: Pose2, worth: Array) -> Pose2 | None:
        """The heading at this spot that shows the most; None when turning shows nothing that is worth it."""
        turned = [(pose[0], pose[1], math.remainder(math.tau * k / HEADINGS, math.tau)) for k in range(HEADINGS)]
        gains = [float(worth[self.visible(view)].sum()) for view in turned]
        best = int(np.argmax(gains))
        return turned[best] if gains[best] >= LEAST_GAIN else None

    def best(
        self,
        worth: Array,
        tried: Collection[Pose2],
        cost: Callable[[Pose2], float],
        free: Callable[[Pose2], bool],
        likelihood: Array | None = None,
    ) -> Pose2 | None:
        """The pose, not yet `tried`, that shows the most for its way; None when none is worth it.

        `worth` (p,) is what each point counts, `cost` the way to a pose [m], inf where none leads, `free` whether the
        base can stand there. `likelihood` (p,) that what is looked for is at a point, the mean being 1, decides what
        is looked at first, and nothing about what is looked at in the end.
        """
        news = self.shows @ worth
        gains = news if likelihood is None else self.shows @ (worth * likelihood)
        best, best_score = None, 0.0
        for n in np.flatnonzero(news >= LEAST_GAIN).tolist():
            pose = self.poses[n]
            # The way is asked last: it is the dearest to know.
            if gains[n] / LOOK_COST <= best_score or pose in tried or not free(pose):
                continue
            score = float(gains[n]) / (cost(pose) + LOOK_COST)
            if score > best_score:
                best, best_score = pose, score
        return best


def _points_on(r: Receptacle) -> Array:
    """Sample points (n, 3) of a surface, LIFT above it."""
    counts = [max(2, math.ceil(extent / SPACING)) for extent in r.size]
    inner = [extent / 2 - INSET for extent in r.size]
    u, v = (np.linspace(-half, half, n) for half, n in zip(inner, counts, strict=True))
    x, y = (axis.ravel() for axis in np.meshgrid(u, v))
    return np.stack([*r.outline.to_map(x, y), np.full(x.shape, r.center[2] + LIFT)], 1)


def _poses_before(r: Receptacle) -> list[Pose2]:
    """Poses before each free edge that face the surface."""
    found = []
    for ax, ay in r.approach:
        dx, dy = r.outline.direction(-ax, -ay)
        edge, length = (r.size[0] / 2, r.size[1]) if ax else (r.size[1] / 2, r.size[0])
        count = max(1, math.ceil(length / ALONG) - 1)
        sides = (np.arange(count) - (count - 1) / 2) * ALONG
        for distance in DISTANCES:
            out = edge + distance + (BIN_RIM if r.depth else 0.0)
            for side in sides.tolist():
                x, y = r.outline.to_map(ax * out, side) if ax else r.outline.to_map(side, ay * out)
                found.append((round(x, 3), round(y, 3), round(math.atan2(dy, dx), 3)))
    return found


def _screens(floor_plan: FloorPlan, height: float) -> list[Rectangle]:
    """What a camera at `height` [m] does not look over: walls, and furniture nearly as high."""
    tall = [box.outline for box in floor_plan.furniture if box.top > height - SEE_OVER]
    return [wall.footprint for wall in floor_plan.walls] + tall


def _crosses(eye: Array, points: Array, rectangle: Rectangle) -> Mask:
    """Which lines of sight from `eye` (2,) to `points` (n, 2) pass through a rectangle; slab method."""
    start = np.array(rectangle.to_local(eye[0], eye[1]))
    way = np.stack(rectangle.to_local(points[:, 0], points[:, 1]), 1) - start
    way[np.abs(way) < 1e-9] = 1e-9
    half = np.array([rectangle.length, rectangle.width]) / 2
    one, two = (-half - start) / way, (half - start) / way
    enters, leaves = np.minimum(one, two).max(axis=1), np.maximum(one, two).min(axis=1)
    found: Mask = (enters < leaves) & (leaves > 0.0) & (enters < 0.98)
    return found
