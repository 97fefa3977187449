"""Segments of a view: the pixels that stand up from a surface, cut into objects. Pure.

The furniture of the floor plan says where surfaces can be; the image says how high they are. Everything above a
surface, inside its edges and not too tall is kept, cut where the depth jumps, and segments that stand in the same
spot are joined again.
"""

import numpy as np
from numpy.typing import NDArray

from common.floor_plan import FloorPlan, Receptacle
from common.furniture_tops import held_by
from common.geometry import Array, Mask, Rectangle
from services.perception.segments.dark import Blobs, blobs
from services.perception.segments.flat import patches
from services.perception.segments.floor import SEARCH, layers
from services.perception.segments.outlined import in_line, is_part, on_surface, with_parts, with_rest
from services.perception.segments.parts import JUMP, between_jumps, joined
from services.perception.segments.segment import DEPTH_NOISE, Segment, Surface, goes_on, with_top
from services.perception.views.view import View, Window
from services.perception.views.visible_plan import Cloud, Nearby, corners, inside

CLEARANCE, THIN = 0.008, 0.003
"""Height [m] above a surface from which points belong to objects, and above one whose slopes are measured, where noise
does not reach as high. Chosen: twice the depth noise at 1.5 m; a comb's thickness is 0.004."""
MAX_HEIGHT, TALLEST, SLIM = 0.30, 0.45, 0.16
"""Height [m] above a surface up to which points belong to objects, and up to which they do over what is no wider than
that [m]. Chosen: above most; above a bottle of wine; what a hand spans twice."""
REACHES = 0.01
"""Distance [m] from that height within which something goes on beyond it."""
PLANE_SEARCH = 0.025
"""How far [m] from the floor plan's height the surface itself is looked for. Chosen: errors of camera pose and
furniture."""
EDGE = 0.012
"""How far [m] inside its edge a surface begins: its own front is seen there."""
OVERHANG, MOSTLY_ON = 0.10, 0.25
"""How far [m] objects reach over a free edge, and the least share of one that is over the surface. Chosen: for what is
pulled there to be taken; what stands beside a table is none of its objects."""
WALL_EDGE = 0.035
"""The same for a bin, whose walls are seen, and for furniture, whose edge is soft."""
LOOKED_DOWN_ON = 0.2
"""How far [m] below the camera furniture ends whose top is seen."""
PEAK = 0.006
"""Distance [m] from a surface's plane within which its points are. Chosen: three times the noise of height at 2 m."""
TILTED_PLANE, PLANE_SAMPLE = 1500, 1500
"""Pixels of a surface from which its slopes are measured, and how many of them are used."""
MOST_TILT = 0.02
"""Largest slope that a camera a little off its drawing gives a surface: more is something else."""
GOES_ON = 0.15
"""Share of the band around a segment from which it goes on beyond its surface. Chosen: objects have .03 and less."""
MIN_PLANE = 60
"""Pixels from which the height of a surface is measured rather than taken from the floor plan."""
MIN_PIXELS = 24
"""Pixels of the smallest segment. Chosen: about a can of 66 mm at 3.5 m, half hidden."""
MAX_EXTENT, CROWD_EXTENT = 0.30, 0.60
"""Extents [m] on the floor plan from which a segment is no single object, and from which it is furniture."""
FAR = 2.3
"""Depth [m] from which its noise makes walls thick."""
FLOOR_RANGE = 3.0
"""Distance [m] up to which objects on the floor are looked for. Chosen: 25 mm over it stand out of the noise there."""
DEVIATIONS = 4.0
"""Standard deviations of height above the floor that are no object: it covers a thousand times the area of the noise's
bumps, of which one in a thousand is beyond three."""
ONE_DEVIATION = 68.3
"""Percentile of the distances from a plane that is one standard deviation of normal noise."""

Layer = tuple[Surface, Cloud, Cloud]
"""The floor or a rug, the pixels that stand up from it, and all over it."""


def segments(view: View, floor_plan: FloorPlan, max_range: float, robot: Mask | None = None) -> list[Segment]:
    """The objects that stand on the surfaces of the floor plan. `robot` marks the pixels that show the robot itself."""
    near = Nearby(floor_plan, float(view.position[0]), float(view.position[1]), max_range)
    own = robot if robot is not None else np.zeros(view.shape, bool)
    usable = (view.depth > 0.05) & (view.depth < max_range) & ~own
    dark = blobs(view)
    found: list[Segment] = []
    for r in near.receptacles:
        surface = Surface(r.name, r.center[2])
        outline = r.outline.grown(-WALL_EDGE if r.depth else -EDGE)
        cloud = _over(view, usable, outline, surface.height)
        beyond = None if r.depth else _beyond(view, usable, r, outline)
        found += [s for s in _on(view, surface, cloud, near, own, dark, beyond) if r.depth or _stands_on(s, r)]
    for f, on_it in near.tops(float(view.position[2]) - LOOKED_DOWN_ON):
        surface = Surface(f.name, f.center[2] + f.size[2] / 2)
        outline, top = f.outline.grown(-WALL_EDGE), held_by(floor_plan, f, f.center[:2])
        over, beyond = _over(view, usable, outline, surface.height), _beyond(view, usable, top, outline)
        on_top = _on(view, surface, over.outside(on_it), near, own, dark, beyond.outside(on_it))
        found += [s for s in on_top if _stands_on(s, top)]
    above = _above_floor(view, usable)
    looked_at = np.zeros(view.shape, bool)
    for _, _, ground in above:
        looked_at.ravel()[ground.outside(near.boxes).pixels] = True
    for surface, over, ground in above:
        found += _on(view, surface, over.outside(near.boxes), near, own, dark, ground=ground, looked_at=looked_at)
    return found


def _over(view: View, usable: Mask, outline: Rectangle, height: float) -> Cloud:
    """The usable pixels over a surface of that outline and height."""
    low, high = height - PLANE_SEARCH, height + MAX_HEIGHT
    cloud = _between(view, usable, low, high, view.window(corners(outline, low, high)))
    return cloud.kept(inside(cloud.x, cloud.y, outline))


def _beyond(view: View, usable: Mask, r: Receptacle, outline: Rectangle) -> Cloud:
    """The usable pixels before the free edges of a receptacle: its own front, and what reaches over them."""
    depth, width = (side / 2 - EDGE for side in r.size)
    left, right, below, above = (OVERHANG * (way in r.approach) for way in ((-1, 0), (1, 0), (0, -1), (0, 1)))
    left, right, below, above = -depth - left, depth + right, -width - below, width + above
    x, y = r.outline.to_map((left + right) / 2, (below + above) / 2)
    wider = Rectangle(x, y, right - left, above - below, r.yaw)
    low, high = r.center[2] - PLANE_SEARCH, r.center[2] + MAX_HEIGHT
    cloud = _between(view, usable, low, high, view.window(corners(wider, low, high)))
    return cloud.kept(inside(cloud.x, cloud.y, wider) & ~inside(cloud.x, cloud.y, outline))


def _stands_on(segment: Segment, r: Receptacle) -> bool:
    """Of what is seen by its outline alone there may be no point; its middle says where it stands."""
    if segment.shape is not None:
        return r.contains(segment.shape.x, segment.shape.y, 0.0)
    x, y = segment.points[:, :2].T.astype(np.float32)
    return bool(np.count_nonzero(inside(x, y, r.outline)) > MOSTLY_ON * len(x))


def _above_floor(view: View, usable: Mask) -> list[Layer]:
    """The floor and the rugs on it, the usable pixels that stand up from each by more than noise, and all over it.

    What stands across the edge of a rug is of the layer on which most of it stands.
    """
    found = []
    for height, cloud in layers(
        _between(view, usable & (view.depth < FLOOR_RANGE), -SEARCH, MAX_HEIGHT, view.everywhere)
    ):
        noise = DEVIATIONS * DEPTH_NOISE * float(view.position[2]) * view.depth.ravel()[cloud.pixels]
        found.append((Surface("", height), cloud.kept(cloud.z > height + np.maximum(noise, CLEARANCE)), cloud))
    return found if len(found) < 2 else _undivided(view, found)


def _undivided(view: View, found: list[Layer]) -> list[Layer]:
    """The layers with each connected part of what stands up from them in one."""
    layer = np.full(view.shape, -1)
    for n, (_, over, _) in enumerate(found):
        layer.ravel()[over.pixels] = n
    rows, columns = np.nonzero(layer >= 0)
    for part in between_jumps(view, rows, columns, MIN_PIXELS // 3) if len(rows) else ():
        layer[part] = np.bincount(layer[part]).argmax()
    every = found[0][1]
    for _, over, _ in found[1:]:
        every = every.joined(over)
    own = layer.ravel()[every.pixels]
    return [(surface, every.kept(own == n), ground) for n, (surface, _, ground) in enumerate(found)]


def _between(view: View, usable: Mask, low: float, high: float, window: Window) -> Cloud:
    """The usable (h, w) pixels of a window whose points are between two heights."""
    z = view.points[window][..., 2]
    chosen = usable[window] & (z > low)
    chosen &= z < high
    found = np.flatnonzero(chosen)
    if window != view.everywhere:
        rows, columns = np.divmod(found, chosen.shape[1] or 1)
        found = (rows + window[0].start) * view.shape[1] + columns + window[1].start
    x, y, z = (plane.ravel()[found] for plane in np.moveaxis(view.points, -1, 0))
    return Cloud(found, x, y, z)


def _on(
    view: View,
    expected: Surface,
    cloud: Cloud,
    near: Nearby,
    own: Mask,
    dark: Blobs | None,
    beyond: Cloud | None = None,
    ground: Cloud | None = None,
    looked_at: Mask | None = None,
) -> list[Segment]:
    """Pieces above one surface, whose plane is measured where enough of it is visible; of the pixels `beyond` its edges
    those above its front. `ground`: all pixels over it, where `cloud` is what stands up from it, and `looked_at` (h, w)
    all over it and other layers."""
    plane, least, rough = _plane(view, cloud, expected)
    if beyond is not None:
        front = plane[0] * beyond.x + plane[1] * beyond.y + plane[2]
        cloud = cloud.joined(beyond.kept(beyond.z > front + CLEARANCE))
    taken = [] if ground is None else near.boxes
    outlined = on_surface(view, expected.name, plane, ground or cloud, own, dark, taken) if dark else []
    by_walls = np.zeros(view.shape, bool)
    by_walls.ravel()[cloud.pixels] = True
    cloud = cloud.outside(near.walls)
    if len(cloud.pixels) < MIN_PIXELS:
        return outlined
    by_walls.ravel()[cloud.pixels] = False
    over_it = np.zeros(view.shape, bool) if looked_at is None else looked_at.copy()
    over_it.ravel()[cloud.pixels] = True
    height = plane[0] * cloud.x + plane[1] * cloud.y + plane[2]
    noise = DEVIATIONS * rough * _noise(view, cloud, expected)
    over = (cloud.z > height + np.maximum(noise, least)) & (cloud.z < height + MAX_HEIGHT)
    kept = cloud.kept(over)
    far = view.depth.ravel()[kept.pixels] > FAR
    farther = kept.kept(far).outside(near.far_walls).pixels
    above = np.concatenate([kept.pixels[~far], farther])
    if least == THIN:
        flat = patches(view, cloud.pixels, cloud.z - height, over)
        above = np.union1d(above, flat[0] * view.shape[1] + flat[1])
    if len(above) < MIN_PIXELS:
        return outlined
    rows, columns = np.unravel_index(above, view.shape)
    cut = between_jumps(view, rows, columns, MIN_PIXELS // 3)
    over_it[rows, columns] = True
    parts = [_to_its_top(view, p, own) for p in joined(view, expected.name, plane, cut, own, dark)]
    left = [p for p in parts if len(p.rows) >= MIN_PIXELS and _is_thing(p)]
    whole = []
    for one in outlined:
        own_parts = [p for p in left if one.shape is not None and is_part(p.points, one.shape)]
        left = [p for p in left if not any(p is part for part in own_parts)]
        whole.append(with_parts(view, one, own_parts))
        rest = [p for p in left if in_line(whole[-1], p)]
        left = [p for p in left if not any(p is part for part in rest)]
        whole[-1] = with_rest(whole[-1], rest)
    return whole + [p for p in left if not _is_of_furniture(view, p, over_it, by_walls)]


def _is_of_furniture(view: View, segment: Segment, over_it: Mask, by_walls: Mask) -> bool:
    """A segment goes on where no objects are looked for; what is level with it `by_walls` (h, w) is the rest of it."""
    rest = by_walls & (view.points[..., 2] < segment.points[:, 2].max() + PEAK)
    return goes_on(view, segment, over_it | rest, CLEARANCE, JUMP) >= GOES_ON


def _noise(view: View, cloud: Cloud, surface: Surface) -> NDArray[np.float32]:
    """Standard deviation (n,) [m] of the heights of a surface's pixels."""
    return DEPTH_NOISE * (float(view.position[2]) - surface.height) * view.depth.ravel()[cloud.pixels]


def _plane(view: View, cloud: Cloud, expected: Surface) -> tuple[Array, float, float]:
    """Slopes and height (3,) of a surface: z = a x + b y + c, as it is seen, or as it is expected where it is not.

    And the height [m] above it from which points belong to objects, and its noise by the camera's (what is dark has
    more).
    A camera that is tilted by 0.3 degrees more than it is believed to be sees a counter of 2 m rise by 10 mm.
    """
    level = np.array([0.0, 0.0, expected.height])
    near = np.abs(cloud.z - expected.height) < PLANE_SEARCH
    if not expected.name or np.count_nonzero(near) < MIN_PLANE:
        return level, CLEARANCE, 1.0
    x, y, z = (axis[near].astype(np.float64) for axis in (cloud.x, cloud.y, cloud.z))
    counts, edges = np.histogram(z, bins=25)
    peak = int(counts.argmax())
    close = np.abs(z - (edges[peak] + edges[peak + 1]) / 2) < PEAK
    level[2] = float(np.median(z[close]))
    if np.count_nonzero(close) < TILTED_PLANE:
        return level, CLEARANCE, 1.0
    step = max(1, len(x) // PLANE_SAMPLE)
    rows = np.stack([x, y, np.ones_like(x)], axis=1)[::step]
    heights, close = z[::step], (np.abs(z - level[2]) < 2 * PEAK)[::step]
    plane = level
    for _ in range(3):
        if np.count_nonzero(close) < MIN_PLANE:
            return level, CLEARANCE, 1.0
        plane = np.asarray(np.linalg.lstsq(rows[close], heights[close], rcond=None)[0], np.float64)
        close = np.abs(heights - rows @ plane) < PEAK
    if np.hypot(plane[0], plane[1]) >= MOST_TILT:
        return level, CLEARANCE, 1.0
    off = np.abs(heights - rows @ plane)[close] / _noise(view, cloud, expected)[near][::step][close]
    return plane, THIN, max(1.0, float(np.percentile(off, ONE_DEVIATION)))


def _to_its_top(view: View, segment: Segment, own: Mask) -> Segment:
    """What is slim and reaches as high as objects are looked for, with what is seen of it above."""
    floor = segment.surface.height
    if segment.top < MAX_HEIGHT - REACHES or extent(segment) >= SLIM:
        return segment
    return with_top(view, segment, own, floor + MAX_HEIGHT - REACHES, floor + TALLEST)


def _is_thing(segment: Segment) -> bool:
    """Neither as wide as furniture nor reaching up like a wall; it may be several objects that touch."""
    high = TALLEST if extent(segment) < SLIM else MAX_HEIGHT
    return extent(segment) < CROWD_EXTENT and segment.top < high - REACHES


def extent(segment: Segment) -> float:
    """The larger extent [m] of a segment on the floor plan."""
    return float(np.ptp(segment.points[:, :2], axis=0).max())
