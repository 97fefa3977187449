"""Check of a floor plan's measures: sizes, heights and extents that cannot be. Pure."""

import math
from collections.abc import Iterator

from common.approach import HALF_WIDTH, clearance
from common.floor_plan import FloorPlan

TURN = 2 * math.pi
"""The most that a `yaw` is [rad]; more was meant in degrees."""


def measure_fault(plan: FloorPlan) -> str:
    """What makes the plan impossible, "" when nothing does."""
    return next(filter(None, _faults(plan)), "")


def _faults(plan: FloorPlan) -> Iterator[str]:
    (left, below), (right, above) = plan.low, plan.high
    boxes = [(f"furniture {f.name!r}", f.center, f.size, f.yaw) for f in plan.furniture]
    boxes += [(f"receptacle {r.name!r}", r.center, (*r.size, 1.0), r.yaw) for r in plan.receptacles]
    for name, center, size, yaw in boxes:
        if not all(0 < side < math.inf for side in size):
            yield f"{name} needs a positive size, not {size}"
        if not (left <= center[0] <= right and below <= center[1] <= above):
            yield f"{name} is at {center[:2]}, outside of low {plan.low} and high {plan.high}"
        if max(size[:2]) > math.dist(plan.low, plan.high):
            yield f"{name} is {max(size[:2])} m long, more than the building; lengths are metres"
        if abs(yaw) > TURN:
            yield f"{name} has yaw {yaw}; angles are radians ({yaw} degrees are {math.radians(yaw):.3f})"
    for n, wall in enumerate(plan.walls, 1):
        if wall.start == wall.end or min(wall.thickness, wall.height) <= 0:
            yield f"wall {n}, from {wall.start} to {wall.end}, needs two ends, a thickness and a height"
        if sunk := next((r.name for r in plan.receptacles if wall.footprint.contains(*r.center[:2])), ""):
            yield f"receptacle {sunk!r} has its middle in wall {n}, from {wall.start} to {wall.end}"
    for room in plan.rooms:
        if not (room.low[0] < room.high[0] and room.low[1] < room.high[1]):
            yield f"room {room.name!r}: low {room.low} is not below and left of high {room.high}"
    home = plan.home
    if not (left < home.x < right and below < home.y < above):
        yield f"home ({home.x}, {home.y}) is outside of low {plan.low} and high {plan.high}"
    if (room_there := clearance(plan, home.x, home.y)) < HALF_WIDTH:
        yield f"home ({home.x}, {home.y}) is {room_there:.2f} m from what stands there; the base needs {HALF_WIDTH} m"
