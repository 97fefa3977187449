"""The robot, its home and its objects as Foxglove's well-known messages.

Source: https://docs.foxglove.dev/docs/sdk/schemas
"""

from typing import Any

import numpy as np
from foxglove import messages as fm

from common import messages as m
from common.cells import unpacked
from common.geometry import Rectangle, yaw_quat
from common.household import Household
from common.kinds import kind_of
from common.messages.base import IDENTITY, Quat, Vec3
from common.naming.colours import COLOURS, UNKNOWN_COLOUR
from common.rendering.encode import jpeg
from common.robot.frames import LIDAR, MAP, FramePose, optical_frame
from common.robot.pictures import colours, millimetres, pinhole
from common.robot.shapes import Shape

QUALITY = 80
"""Of JPEG pictures [1 to 95]; chosen: no fault that a person sees."""
LABEL = 0.06
"""Height of the letters beside an object [m], and how far above it they stand."""
LEVELS = {"debug": "Debug", "info": "Info", "warning": "Warning", "error": "Error"}
Colour = tuple[float, float, float, float]
WALL: Colour = (0.85, 0.85, 0.82, 0.35)
RECEPTACLE: Colour = (0.45, 0.60, 0.75, 1.0)
"""Colours (red, green, blue, opacity, 0 to 1); chosen: through walls one sees the robot."""
SHEET = 0.01
"""Thickness of what shows where objects may stand [m]."""


def timestamp(t: float) -> Any:
    """Foxglove's Timestamp of a robot time [s]."""
    return fm.Timestamp.from_epoch_secs(max(t, 0.0))


def pose(position: Vec3, orientation: Quat) -> Any:
    """A pose with orientation (w, x, y, z)."""
    return fm.Pose(position=_vector(position), orientation=_quaternion(orientation))


def _quaternion(q: Quat) -> Any:
    return fm.Quaternion(x=q[1], y=q[2], z=q[3], w=q[0])


def _vector(v: Vec3) -> Any:
    return fm.Vector3(x=v[0], y=v[1], z=v[2])


def colour(rgba: Colour) -> Any:
    return fm.Color(r=rgba[0], g=rgba[1], b=rgba[2], a=rgba[3])


def frames(poses: list[FramePose]) -> Any:
    """Frames as a FrameTransforms."""
    return fm.FrameTransforms(
        transforms=[
            fm.FrameTransform(
                timestamp=timestamp(p.t),
                parent_frame_id=p.parent,
                child_frame_id=p.child,
                translation=_vector(p.position),
                rotation=_quaternion(p.orientation),
            )
            for p in poses
        ]
    )


def _entity(t: float, frame: str, name: str, solids: list[Shape], words: list[Any] | None = None) -> Any:
    """Solids in a frame that they move with."""
    parts: dict[str, list[Any]] = {"box": [], "cylinder": [], "sphere": []}
    for solid in solids:
        where, size = pose(solid.position, solid.orientation), _vector(solid.size)
        paint = colour(solid.colour)
        if solid.form == "cylinder":
            one: Any = fm.CylinderPrimitive(pose=where, size=size, bottom_scale=1.0, top_scale=1.0, color=paint)
        elif solid.form == "sphere":
            one = fm.SpherePrimitive(pose=where, size=size, color=paint)
        else:
            one = fm.CubePrimitive(pose=where, size=size, color=paint)
        parts[solid.form].append(one)
    return fm.SceneEntity(
        timestamp=timestamp(t),
        frame_id=frame,
        id=name,
        frame_locked=True,
        cubes=parts["box"],
        cylinders=parts["cylinder"],
        spheres=parts["sphere"],
        texts=words or [],
    )


def robot(solids: list[Shape]) -> Any:
    """The robot: an entity for each link, which its frame moves."""
    links = dict.fromkeys(solid.link for solid in solids)
    entities = [_entity(0.0, link, f"robot {link}", [s for s in solids if s.link == link]) for link in links]
    return fm.SceneUpdate(entities=entities)


def home(household: Household) -> Any:
    """Walls, furniture and places for objects as the robot was told of them."""
    solids = [_upright(w.footprint, 0.0, w.height, WALL) for w in household.walls]
    solids += [_upright(b.outline, b.center[2] - b.size[2] / 2, b.size[2], b.rgba) for b in household.furniture]
    solids += [_upright(r.outline, r.center[2] - SHEET, SHEET, RECEPTACLE) for r in household.receptacles]
    return fm.SceneUpdate(entities=[_entity(0.0, MAP, "home", solids)])


def _upright(outline: Rectangle, bottom: float, height: float, paint: Colour) -> Shape:
    place = (outline.x, outline.y, bottom + height / 2)
    return Shape(MAP, "box", place, yaw_quat(outline.yaw), (outline.length, outline.width, height), paint)


def objects(message: m.WorldObjects, gone: set[str]) -> Any:
    """What perception knows of, each with its label; `gone`: labels of before that it knows no more."""
    entities = []
    for one in message.objects:
        x, y, z = one.position
        above = pose((x, y, z + one.size[2] / 2 + LABEL), IDENTITY)
        text = fm.TextPrimitive(
            pose=above, billboard=True, font_size=LABEL, color=colour((0.1, 0.1, 0.1, 1.0)), text=one.label
        )
        entities.append(_entity(message.t, MAP, f"object {one.label}", [_solid(one)], [text]))
    deletions = [
        fm.SceneEntityDeletion(
            timestamp=timestamp(message.t), type=fm.SceneEntityDeletionType.MatchingId, id=f"object {label}"
        )
        for label in sorted(gone)
    ]
    return fm.SceneUpdate(deletions=deletions, entities=entities)


def _solid(one: m.WorldObject) -> Shape:
    solid = kind_of(one.kind).shape
    form: Any = {"sphere": "sphere", "turned": "cylinder"}.get(solid, "box") if one.tilt == 0 else "box"
    return Shape(MAP, form, one.position, one.orientation, one.size, (*COLOURS.get(one.colour, UNKNOWN_COLOUR), 1.0))


def grid(message: m.Costmap) -> Any:
    """Clearance as a Grid of bytes, 0 where something stands.

    Raises:
        ValueError: not as many cells as it says.
    """
    field = fm.PackedElementField(name="clearance", offset=0, type=fm.PackedElementFieldNumericType.Uint8)
    return fm.Grid(
        timestamp=timestamp(message.t),
        frame_id=MAP,
        pose=pose((message.x, message.y, 0.0), IDENTITY),
        column_count=message.width,
        cell_size=fm.Vector2(x=message.resolution, y=message.resolution),
        row_stride=message.width,
        cell_stride=1,
        fields=[field],
        data=unpacked(message).tobytes(),
    )


def scan(message: m.LaserScan) -> Any:
    """The lidar's rays; what they did not meet is infinitely far."""
    ranges = np.frombuffer(message.ranges, "<f4")
    ranges = np.where(ranges > message.range_max, np.inf, ranges)
    return fm.LaserScan(
        timestamp=timestamp(message.t),
        frame_id=LIDAR,
        pose=pose((0.0, 0.0, 0.0), IDENTITY),
        start_angle=message.angle_min,
        end_angle=message.angle_min + message.angle_increment * max(0, len(ranges) - 1),
        ranges=ranges.tolist(),
        intensities=[],
    )


def path(message: m.NavPath) -> Any:
    """The path being followed."""
    poses = [pose((x, y, 0.0), IDENTITY) for x, y in message.points]
    return fm.PosesInFrame(timestamp=timestamp(message.t), frame_id=MAP, poses=poses)


def log(message: m.LogRecord) -> Any:
    """A line of a service's log, with its fields."""
    fields = " ".join(f"{name}={value}" for name, value in message.fields.items())
    level = getattr(fm.LogLevel, LEVELS.get(message.level, "Info"))
    words = f"{message.event} {fields}".rstrip()
    return fm.Log(timestamp=timestamp(message.t), level=level, message=words, name=message.service)


def image(message: m.Rgbd) -> Any:
    """The colours of a picture as a JPEG.

    Raises:
        ValueError: not as many pixels as it says.
    """
    data = jpeg(colours(message), QUALITY)
    return fm.CompressedImage(
        timestamp=timestamp(message.t), frame_id=optical_frame(message.camera), data=data, format="jpeg"
    )


def depth(message: m.Rgbd) -> Any:
    """Depth of a picture in millimetres, 0 where nothing is seen.

    Raises:
        ValueError: not as many pixels as it says.
    """
    return fm.RawImage(
        timestamp=timestamp(message.t),
        frame_id=optical_frame(message.camera),
        width=message.width,
        height=message.height,
        encoding="16UC1",
        step=2 * message.width,
        data=millimetres(message).tobytes(),
    )


def calibration(message: m.Rgbd) -> Any:
    """The camera of a picture as a pinhole without distortion."""
    matrix, projection = pinhole(message)
    return fm.CameraCalibration(
        timestamp=timestamp(message.t),
        frame_id=optical_frame(message.camera),
        width=message.width,
        height=message.height,
        distortion_model="",
        D=[],
        K=matrix,
        R=[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        P=projection,
    )
