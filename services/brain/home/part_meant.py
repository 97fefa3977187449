"""Which part of the home a person means: by name, by a point of the map, or by what the robot stands before. Pure."""

import math
from dataclasses import dataclass

from common.floor_plan import Receptacle, Room
from common.geometry import Pose2, Rectangle, to_frame
from common.household import Household
from common.messages import EditCode, HouseholdEdit, PartKind
from common.naming.part_names import kind_named

BEFORE, WIDE = 1.3, 1.2
"""Distance [m] of the base's centre from a surface's outline, and angle [rad] to the heading of its nearest point, up
to which the robot stands before it. Chosen: it grasps from 0.35 to 0.8 m, and people point past it."""
CLEARLY, PER_RADIAN = 0.25, 0.6
"""How much nearer [m] the surface meant by "this" must be than the next, and the distance that a radian counts for."""
CLICKED = 0.1
"""Distance [m] of a click from the outline of the surface that it means."""
GROWTH = 0.1
"""Step [m] by which the sides of a room without a map are found."""


@dataclass(frozen=True)
class Meant:
    """The part, or the place itself with both None; without a `kind` it is not clear: `code` and `detail` say why."""

    kind: PartKind | None
    surface: Receptacle | None = None
    room: Room | None = None
    code: EditCode = ""
    detail: str = ""


def meant(edit: HouseholdEdit, home: Household, base: Pose2) -> Meant:
    """The part that is to have `edit.name`."""
    if edit.part:
        return _called(edit.part, home)
    kind = edit.kind or kind_named(edit.name)
    if edit.position is not None:
        return _at((edit.position[0], edit.position[1]), kind, home)
    if kind == "surface":
        return _before(edit.name, home, base)
    if kind == "room":
        return Meant("room", room=home.room_at(base[0], base[1]))
    return Meant("place")


def _called(name: str, home: Household) -> Meant:
    if surface := home.receptacle(name):
        return Meant("surface", surface=surface)
    if room := next((r for r in home.rooms if name == r.name or name in r.aliases), None):
        return Meant("room", room=room)
    return Meant(None, code="NO_PART", detail=f"I know no {name}")


def _at(point: tuple[float, float], kind: PartKind | None, home: Household) -> Meant:
    surface = home.surface_at(*point, margin=CLICKED)
    if surface is not None and kind in (None, "surface"):
        return Meant("surface", surface=surface)
    if kind == "surface":
        return Meant(None, code="NO_PART", detail="I know no surface there")
    room = home.room_at(*point)
    return Meant("place") if kind == "place" else Meant("room", room=room)


def _before(name: str, home: Household, base: Pose2) -> Meant:
    """The surface that the robot faces, of the kind that the name's last word is if there is one."""
    near = sorted((c, r.name, r) for r in home.receptacles if (c := _aside(r.outline, base)) is not None)
    kin = [row for row in near if row[2].kind == name.split()[-1]]
    fit = kin or near
    if not fit:
        return Meant(None, code="NO_PART", detail="I stand before no surface; send me there first")
    close = [r for cost, _, r in fit if cost < fit[0][0] + CLEARLY]
    if len(close) > 1:
        names = " or the ".join(r.name for r in close)
        return Meant(None, code="AMBIGUOUS", detail=f"you could mean the {names}; tell me which")
    return Meant("surface", surface=close[0])


def _aside(outline: Rectangle, base: Pose2) -> float | None:
    """How far [m] a surface is from what one means by "this", None when it is not before the robot."""
    ahead, left = to_frame(base, outline.nearest(base[0], base[1]))
    distance, angle = math.hypot(ahead, left), abs(math.atan2(left, ahead))
    return distance + PER_RADIAN * angle if distance < BEFORE and angle < WIDE else None


Corners = tuple[tuple[float, float], tuple[float, float]]


def room_around(home: Household, x: float, y: float) -> Corners:
    """Corners of the room at a point of the map [m]: each side grows until it meets a wall; doors do not end it."""
    low, high = [x - GROWTH, y - GROWTH], [x + GROWTH, y + GROWTH]
    limits_low, limits_high = home.low, home.high
    walls = [wall.outline for wall in home.walls]
    growing = {(axis, end) for axis in (0, 1) for end in (0, 1)}
    while growing:
        for axis, end in sorted(growing):
            side = (low, high)[end]
            moved = side[axis] + (GROWTH if end else -GROWTH)
            outside = moved > limits_high[axis] if end else moved < limits_low[axis]
            if outside or _meets(walls, axis, moved, low[1 - axis], high[1 - axis]):
                growing.discard((axis, end))
            else:
                side[axis] = moved
    return (round(low[0], 2), round(low[1], 2)), (round(high[0], 2), round(high[1], 2))


def _meets(walls: list[Rectangle], axis: int, at: float, start: float, end: float) -> bool:
    """Is there a wall on the side at coordinate `at` of an axis, from `start` to `end` along the other?"""
    samples = max(2, math.ceil((end - start) / GROWTH))
    along = [start + (end - start) * n / (samples - 1) for n in range(samples)]
    points = [(at, v) if axis == 0 else (v, at) for v in along]
    return any(wall.contains(px, py, GROWTH / 2) for wall in walls for px, py in points)
