"""The tops of furniture as receptacles: nobody lists them, and things come to lie there."""

from common.floor_plan import Box, FloorPlan, Receptacle, Vec2

BACK = 0.10
"""How much higher [m] what stands on a piece of furniture is than its seat to be its back, over which nothing is taken.
Chosen: more than a cushion."""
BESIDE = 0.3
"""Room [m] that somebody who stands before furniture has at least: half of a base."""
SEAT, SEAT_SIDE = (0.20, 0.65), 0.35
"""Heights [m] of what people sit and lie on, from a floor cushion to a high bed, and the least side [m] of a seat."""


def support_at(plan: FloorPlan, x: float, y: float) -> Receptacle | None:
    """What holds a thing at the point (x, y) [map]: a receptacle, else a piece of furniture as one."""
    if (surface := plan.surface_at(x, y)) is not None:
        return surface
    under = [f for f in plan.standing if f.outline.contains(x, y)]
    return held_by(plan, max(under, key=lambda f: f.top), (x, y)) if under else None


def seats(plan: FloorPlan) -> list[Receptacle]:
    """The tops of sofas, beds and chairs."""
    return [
        held_by(plan, f, f.center[:2])
        for f in plan.standing
        if SEAT[0] <= f.top <= SEAT[1]
        and min(f.size[:2]) >= SEAT_SIDE
        and not plan.surface_at(*f.center[:2])
        and not any(other.top > f.top and other.outline.contains(*f.center[:2]) for other in plan.standing)
    ]


def held_by(plan: FloorPlan, box: Box, at: Vec2) -> Receptacle:
    """The top of a box; a side is free where nothing higher is between a point on it and the floor before it."""
    higher = [f.outline for f in plan.standing if f.top > box.top + BACK] + [w.footprint for w in plan.walls]
    u, v = box.outline.to_local(*at)
    length, width = box.size[0] / 2 + BESIDE, box.size[1] / 2 + BESIDE
    edges = {(1, 0): (length, v), (-1, 0): (-length, v), (0, 1): (u, width), (0, -1): (u, -width)}
    free = tuple(
        side for side, edge in edges.items() if not any(o.meets(at, box.outline.to_map(*edge)) for o in higher)
    )
    middle = box.center[0], box.center[1], box.top
    return Receptacle(name=box.name, kind="table", center=middle, size=box.size[:2], yaw=box.yaw, approach=free)
