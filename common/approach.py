"""Approach poses: where the base stands so that the arm reaches an object or a surface. Pure."""

import math
from collections.abc import Iterator

from common.floor_plan import FloorPlan, Receptacle
from common.geometry import Point, Pose2, from_segment

FOOTPRINT = 0.29
"""Radius of the circle around the base [m]: its bumper's rounded corners are 0.284 from its centre."""
HALF_WIDTH = 0.24
"""Half of the base's width and length over the bumper [m]: what is nearer to its centre on both axes is its own."""
STAND_OFF = 0.55
"""From the base's centre to the object [m]: nearer, flat grasps of low tables are out of the arm's reach, farther away
those from above on high ones."""
EDGE_DISTANCE = FOOTPRINT + 0.06
"""From the base's centre to the edge it stands before [m]: what navigation plans with, and a cell of its grid."""
ROOM = FOOTPRINT + 0.02
"""Clearance that the base's centre needs [m], as navigation plans with."""
BIN_RIM = 0.02
"""Thickness of a bin's walls, which its `size` does not contain [m]: 15 mm and the play of the map's grid."""
WHEELS = 0.2
"""Distance of the wheels from the base's middle [m]: what turning on the spot rolls, and errs by."""
WAY_COST = 0.15
"""What the way to an approach pose adds to its penalty [m/m]; chosen: a better stance is worth a way round a table."""
HANDED, BEFORE = 0.65, math.radians(45)
"""Distance [m] and direction against ahead [rad] of the edge of a surface up to which what is brought can be put on it
from the robot's home: the arm reaches 0.1 m farther, without a step aside."""
LATERAL = (0.0, 0.10, -0.10, 0.20, -0.20, 0.30, -0.30)
"""Steps aside [m] from straight before the object: beside a corner or a bin only the farthest may have room."""
RING, FARTHER = 16, (0.0, 0.1, 0.2)
"""Candidates around an object [count], one every 22.5 degrees, and how much farther away others are [m]: what lies on a
sofa or a bed may be too far behind its edge for the nearest. Chosen: the arm reaches 0.2 beyond the stand-off."""
TOLERANCE, DISTANCE_COST = 0.04, 4.0
"""Distance beyond the stand-off that costs nothing [m], and what more costs [m/m]."""


def poses_for(
    target: Point,
    receptacle: Receptacle | None,
    stand_off: float = STAND_OFF,
    edge_distance: float = EDGE_DISTANCE,
) -> list[tuple[float, Pose2]]:
    """Candidate base poses that face `target`, each with a penalty [m] for how far from ideal it is.

    On a receptacle the base stands before one of its free edges, `edge_distance` off it at least; elsewhere on rings.
    """
    x, y = target
    found: list[tuple[float, Pose2]] = []
    if receptacle is None or not receptacle.approach:
        for away in FARTHER:
            distance, penalty = stand_off + away, DISTANCE_COST * max(0.0, away - TOLERANCE)
            for k in range(RING):
                a = 2 * math.pi * k / RING
                found.append((penalty, (x - distance * math.cos(a), y - distance * math.sin(a), a)))
        return found
    outline = receptacle.outline
    lx, ly = outline.to_local(x, y)
    for ax, ay in receptacle.approach:
        edge = receptacle.size[0] / 2 if ax else receptacle.size[1] / 2
        inset = max(0.0, edge - (lx * ax + ly * ay))
        rim = BIN_RIM if receptacle.depth else 0.0
        distance = max(stand_off, inset + rim + edge_distance)
        ux, uy = outline.direction(ax, ay)
        for side in LATERAL:
            bx, by = x + ux * distance - uy * side, y + uy * distance + ux * side
            theta = math.atan2(y - by, x - bx)
            far = max(0.0, math.hypot(distance, side) - stand_off - TOLERANCE)
            found.append((DISTANCE_COST * far + 1.5 * abs(side), (bx, by, theta)))
    return found


def delivers_at_home(floor_plan: FloorPlan) -> bool:
    """True when the robot delivers from its home pose: there is no delivery surface, or its home is before it."""
    receptacle, home = floor_plan.receptacle(floor_plan.delivery), floor_plan.home
    if receptacle is None:
        return True
    x, y = receptacle.outline.nearest(home.x, home.y)
    bearing = math.atan2(y - home.y, x - home.x) - home.theta
    return math.dist((x, y), (home.x, home.y)) <= HANDED and abs(math.remainder(bearing, 2 * math.pi)) <= BEFORE


def clearance(floor_plan: FloorPlan, x: float, y: float) -> float:
    """Distance [m] from a point on the floor to the nearest wall, furniture or surface; 0 within one."""
    return min(_distances(floor_plan, x, y), default=math.inf)


def _distances(floor_plan: FloorPlan, x: float, y: float) -> Iterator[float]:
    for wall in floor_plan.walls:
        yield max(0.0, from_segment(x, y, wall.start, wall.end) - wall.thickness / 2)
    for footprint in floor_plan.footprints:
        yield footprint.distance(x, y)
