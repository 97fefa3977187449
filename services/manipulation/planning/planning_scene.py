"""The planning scene: solids in the base frame for furniture, walls and known objects around the robot."""

import math
from collections.abc import Iterable, Sequence
from itertools import product

import numpy as np

from common.floor_plan import FloorPlan, Receptacle
from common.geometry import Array, Pose2, Rectangle, compose, inverse, quat_matrix, quat_yaw, to_frame, yaw_quat
from common.kinds import laid_on_a_side
from common.messages import ObjectRef, WorldObject
from services.manipulation.arm.arm_model import Obstacle
from services.manipulation.grasps.target import Target

RANGE = 1.4
"""Distance [m] from the base's centre up to which boxes count. Chosen: the arm's reach, its place on the base and an
object."""
SLAB = 0.14
"""Depth [m] below a surface that is modelled as solid. Chosen: more than the height of the hand, which cannot pass
under."""
MARGINS = (0.004, 0.0)
"""How much [m] known objects grow on every side beyond the spread of what was measured, in the order of trying.
Chosen: twice the error of a sighting at arm's length; in a crowd that may be all the room there is."""
MOST_FURNITURE = 14
"""Boxes of furniture and walls, nearest first; the rest of the `arm_model.BOXES` is for objects."""
BIN_WALL = 0.03
"""Thickness [m] of a bin's walls in the planning scene. Chosen: twice that of the walls themselves,
`furniture_parts.BIN_WALL`."""
TWICE = 0.03
"""Difference [m] of places and extents up to which two objects are one that is known twice: no two stand so near."""
LEAST_POINTS = 12
"""Fewer surface points say nothing of a shape."""
DIRECTIONS, GAPS = 16, (0.05, 0.08, 0.12)
"""In how many directions a spot beside an object is looked for, and how far [m] beyond both outlines. Chosen: room for
a finger and the error of a sighting at least."""
LATTICE, ELSEWHERE = 0.05, 0.08
"""Distance [m] between the points of a surface that are looked at, and from which on a spot is another one: nearer ones
fail alike. Chosen: what stands on a table is as large, and what the arm reaches changes within it."""
HAND_ROOM = 0.10
"""Free space [m] around what is put down from which on more is no better: the breadth of the open hand."""
EASY = 0.54
"""Distance [m] in front of the arm that is reached most easily at the height of tables: the middle of its reach."""
ASIDE = 0.35
"""How far beside the middle of a bin something is let go, as a share of the way to its wall. Chosen: what is as wide as
the hand opens clears the walls of a bin of 0.3 m, and what lies in its middle."""


def target_of(found: WorldObject, base: Pose2, floor_plan: FloorPlan) -> Target:
    """An object in the base frame; its height is snapped to the surface that it is said to stand on."""
    x, y, yaw = compose(inverse(base), (found.position[0], found.position[1], quat_yaw(found.orientation)))
    z = found.position[2]
    receptacle = floor_plan.receptacle(found.on)
    if receptacle is not None and not receptacle.depth:
        z = receptacle.center[2] + found.size[2] / 2
    return Target(
        found.label, found.kind, (x, y, z), yaw, found.size, tilt_of(found), found.shape, _points(found.points, base),
        found.spread, found.measured,
    )  # fmt: skip


def others(objects: Iterable[WorldObject], found: WorldObject) -> list[WorldObject]:
    """The objects but for one, by whatever label: what was moved may be known twice for a while."""
    return [o for o in objects if o.label != found.label and not _coincide(o, found)]


def _coincide(a: WorldObject, b: WorldObject) -> bool:
    as_large = all(abs(x - y) < TWICE for x, y in zip(sorted(a.size), sorted(b.size), strict=True))
    return as_large and math.dist(a.position, b.position) < TWICE


def tilt_of(found: WorldObject) -> float:
    """How far [rad] it is tilted. What was measured is told by its kind, which the person may have said: a box is taken
    for a book until then.
    """
    laid = found.measured and found.shape == "box" and laid_on_a_side(found.kind, found.size)
    return found.tilt or (math.pi / 2 if laid else 0.0)


def _points(raw: bytes, base: Pose2) -> Array | None:
    """The surface points (n, 3) [m] of a message along the axes of the base frame; None when there are too few."""
    points = np.frombuffer(raw[: len(raw) // 6 * 6], "<i2").reshape(-1, 3) / 1000.0
    return points @ quat_matrix(yaw_quat(base[2])) if len(points) >= LEAST_POINTS else None


def turned(was: Target, new: Target) -> float:
    """The angle [rad] between two poses of an object with flat sides; equal sides are not told apart."""
    alike = math.isclose(new.size[0], new.size[1])
    return abs(math.remainder(new.yaw - was.yaw, math.pi / 2 if alike else math.pi))


def _box(base: Pose2, center: tuple[float, float, float], size: tuple[float, float, float], yaw: float) -> Obstacle:
    x, y, turn = compose(inverse(base), (center[0], center[1], yaw))
    return Obstacle((x, y, center[2]), size, turn)


def _near(box: Obstacle) -> float:
    """Distance [m] from the base's centre to the box, seen from above."""
    return Rectangle(box.center[0], box.center[1], box.size[0], box.size[1], box.yaw).distance(0.0, 0.0)


def _receptacle(r: Receptacle, base: Pose2) -> list[Obstacle]:
    x, y, z = r.center
    sx, sy = r.size
    if not r.depth:
        return [_box(base, (x, y, z - SLAB / 2), (sx, sy, SLAB), r.yaw)]
    walls = []
    for i, j in ((1, 0), (-1, 0), (0, 1), (0, -1)):
        size = (BIN_WALL if i else sx, BIN_WALL if j else sy, r.depth)
        walls.append(_box(base, (*r.outline.to_map(i * sx / 2, j * sy / 2), r.depth / 2), size, r.yaw))
    return walls


def obstacles(
    floor_plan: FloorPlan, base: Pose2, objects: Iterable[WorldObject], without: str = "", margin: float = MARGINS[0]
) -> list[Obstacle]:
    """The floor, then everything within reach, nearest first; the objects are solids of their family that grow by
    `margin` and, unless that is 0, by the spread of their measures; `without` names the one to leave out."""
    found = [Obstacle((0.0, 0.0, -SLAB / 2), (2 * RANGE, 2 * RANGE, SLAB), floor=True)]
    for r in floor_plan.receptacles:
        found += _receptacle(r, base)
    found += [_box(base, f.center, f.size, f.yaw) for f in floor_plan.furniture]
    for wall in floor_plan.walls:
        x, y, length, width, yaw = wall.footprint
        found.append(_box(base, (x, y, wall.height / 2), (length, width, wall.height), yaw))
    near = sorted((b for b in found if _near(b) < RANGE), key=_near)
    boxes = []
    for o in objects:
        if o.label != without and not o.held:
            boxes.append(target_of(o, base, floor_plan).grown(margin + min(o.spread, margin)))
    return near[:MOST_FURNITURE] + sorted((b for b in boxes if _near(b) < RANGE), key=_near)


def with_object(around: Sequence[Obstacle], box: Obstacle) -> list[Obstacle]:
    """The obstacles with the box of one more object, after the furniture and before the other objects."""
    return [*around[:MOST_FURNITURE], box, *around[MOST_FURNITURE:]]


def spots(
    r: Receptacle,
    base: Pose2,
    footprint: float,
    taken: Iterable[WorldObject],
    forward: float,
    beside: WorldObject | ObjectRef | None = None,
) -> list[tuple[float, float]]:
    """Free points of a surface in the base frame, those easiest to reach first; the arm stands `forward` [m] on it.

    `beside`: only points around this object, which is given in frame map.
    """
    others = [(o.position[0], o.position[1], max(o.size[0], o.size[1]) / 2) for o in taken if not o.held]
    radius = footprint / 2
    rated = []
    half = [max(0.0, v / 2 - radius - 0.02) for v in r.size]
    rows = product(*(np.linspace(-h, h, 2 * math.ceil(h / LATTICE) + 1) for h in half))
    for u, v in _ring_of(r, radius, beside) if beside else rows:
        if abs(u) > half[0] + 1e-9 or abs(v) > half[1] + 1e-9:
            continue
        x, y = r.outline.to_map(float(u), float(v))
        room = min((math.hypot(x - ox, y - oy) - radius - other for ox, oy, other in others), default=HAND_ROOM)
        spot = to_frame(base, (x, y))
        ideal = math.hypot(spot[0] - forward - EASY, 0.6 * spot[1])
        if room > 0.03 and ideal < 0.6:
            rated.append((ideal + max(0.0, HAND_ROOM - room), spot))
    ranked = [spot for _, spot in sorted(rated)]
    first: list[tuple[float, float]] = []
    for spot in ranked:
        if all(math.dist(spot, other) > ELSEWHERE for other in first):
            first.append(spot)
    return [*first, *(spot for spot in ranked if spot not in first)]


def bin_spots(r: Receptacle, base: Pose2, inside: Iterable[WorldObject], forward: float) -> list[tuple[float, float]]:
    """Points of a bin's opening in the base frame: its middle, or first those farthest from what is `inside` already.

    The arm stands `forward` [m] on the base. What is let go above something else would stand on it, out of the bin.
    """
    lying = [(o.position[0], o.position[1]) for o in inside]
    u, v = (ASIDE * size / 2 for size in r.size)
    grid = [(0.0, 0.0), *product((-u, u), (-v, v))] if lying else [(0.0, 0.0)]
    points = [r.outline.to_map(*point) for point in grid]

    def unwanted(point: tuple[float, float]) -> tuple[float, float]:
        room = min((math.dist(point, other) for other in lying), default=0.0)
        x, y = to_frame(base, point)
        return -round(room, 2), math.hypot(x - forward - EASY, y)

    return [to_frame(base, point) for point in sorted(points, key=unwanted)]


def _ring_of(r: Receptacle, radius: float, beside: WorldObject | ObjectRef) -> list[tuple[float, float]]:
    """Points on a receptacle, in its own frame, around an object with room for another of `radius` [m]."""
    cx, cy = r.outline.to_local(beside.position[0], beside.position[1])
    near = max(beside.size[0], beside.size[1]) / 2 + radius
    turns = np.linspace(0.0, 2 * math.pi, DIRECTIONS, endpoint=False)
    return [
        (cx + (near + gap) * math.cos(turn), cy + (near + gap) * math.sin(turn)) for gap in GAPS for turn in turns
    ]  # fmt: skip
