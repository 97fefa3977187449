"""A scene and a seed as MJCF: apartment, robot, free objects."""

import xml.etree.ElementTree as ET
from collections.abc import Iterable, Sequence

from common.furniture_parts import parts
from common.scene import Receptacle, Scene
from services.sim import covers, objects
from services.sim.layout import Placement
from services.sim.model import Robot, beside, own
from services.sim.robot import GLASS_GROUP
from services.sim.things import primitives

STATIC = 'contype="1" conaffinity="3"'
_WOOD, _WHITE, _STEEL = "0.62 0.46 0.32 1", "0.90 0.89 0.86 1", "0.72 0.74 0.76 1"
_COLOURS = {"grey": "0.45 0.46 0.48 1", "green": "0.25 0.50 0.30 1", "yellow": "0.80 0.68 0.25 1"}
_GLASS = "0.75 0.85 0.88 0.2"
CCD_TOLERANCE = 1e-8
"""Tolerance of the search for contacts [m]. With MuJoCo's own, 1e-6, one contact in 16,000 of a pad with a cylinder
that it hardly touches is found on the far side of the pad, 8 mm deep, and what is held is struck with 200 N."""


class _Names:
    """Names of geoms, of which MuJoCo allows each once: of the robot's parts and the world's a `palm` may be either."""

    def __init__(self, taken: Iterable[str]) -> None:
        self._taken = set(taken)

    def free(self, name: str) -> str:
        """The name, with an underscore behind it for each that has it already."""
        name = name.replace(" ", "_")
        while name in self._taken:
            name += "_"
        self._taken.add(name)
        return name


def _names(bodies: Iterable[str]) -> _Names:
    parts = (geom.get("name") for body in bodies for geom in ET.fromstring(f"<body>{body}</body>").iter("geom"))
    return _Names(["floor", *(name for name in parts if name)])


def _box(name: str, center: Sequence[float], size: Sequence[float], rgba: str, yaw: float = 0.0, group: int = 0) -> str:
    half = " ".join(f"{v / 2:.4f}" for v in size)
    pos = " ".join(f"{v:.4f}" for v in center)
    kind = f'type="box" group="{group}" rgba="{rgba}"'
    return f'<geom name="{name}" {kind} pos="{pos}" size="{half}" euler="0 0 {yaw}" {STATIC}/>'


def _apart(box: str) -> str:
    """A part in a body of its own: one large body around all would be searched for every link of the robot."""
    return f"<body>{box}</body>"


def _walls(scene: Scene, names: _Names) -> str:
    parts = []
    for n, wall in enumerate(scene.walls):
        around = wall.footprint
        center, size = (around.x, around.y, wall.height / 2), (around.length, around.width, wall.height)
        rgba, group = (_GLASS, GLASS_GROUP) if wall.glass else ("0.86 0.84 0.80 1", 0)
        parts.append(_apart(_box(names.free(f"wall_{n}"), center, size, rgba, around.yaw, group)))
    return "".join(parts)


def _furniture(scene: Scene, names: _Names) -> str:
    parts = []
    for box in scene.furniture:
        rgba = " ".join(f"{v:g}" for v in box.rgba)
        parts.append(_apart(_box(names.free(box.name), box.center, box.size, rgba, box.yaw)))
    return "".join(parts)


def _receptacle(r: Receptacle, names: _Names) -> str:
    own = _COLOURS.get(r.colour, _COLOURS["grey"])
    looks = {"bin": (own, own), "tray": ("0.35 0.36 0.40 1", "0.20 0.55 0.55 1"), "counter": (_WHITE, _STEEL)}
    rgba, top = looks.get(r.kind, (_WOOD, _WOOD))
    boxes = "".join(_box(names.free(r.name + p.name), p.center, p.size, rgba if p.name else top) for p in parts(r))
    return f'<body pos="{r.center[0]} {r.center[1]} 0" euler="0 0 {r.yaw}">{boxes}</body>'


def world_files(scene: Scene, placements: Sequence[Placement]) -> dict[str, bytes]:
    """The pictures that the model refers to, by file name."""
    return covers.files(scene) | {n: data for p in placements for n, data in objects.made(p.spec).files.items()}


def world_mjcf(
    scene: Scene,
    placements: Sequence[Placement],
    mocap: str = "",
    robot: Robot | None = None,
    robots: Sequence[str] = ("",),
) -> str:
    """The complete model. `mocap` adds bodies of moving obstacles; `robot` None is our own.

    `robots` names those that are in it, all of one make; "" is the one whose parts bear their own names.
    """
    robot = robot or own()
    parts = [beside(robot, name) if name else (robot.body, robot.rest) for name in robots]
    center = ((scene.low[0] + scene.high[0]) / 2, (scene.low[1] + scene.high[1]) / 2)
    extent = (scene.high[0] - scene.low[0] + 2, scene.high[1] - scene.low[1] + 2)
    names = _names(body for body, _ in parts)
    bodies = "".join(objects.body_xml(p) for p in placements)
    assets = "".join(objects.made(p.spec).assets for p in placements)
    return f"""<mujoco model="{scene.name}">
<compiler angle="radian" autolimits="true"/>
<option timestep="0.0025" integrator="implicitfast" cone="elliptic" impratio="10" jacobian="dense"
  ccd_tolerance="{CCD_TOLERANCE}"/>
<statistic center="{center[0]} {center[1]} 0.5" extent="6"/>
<visual>
  <global offwidth="1280" offheight="960"/>
  <quality offsamples="0" shadowsize="0"/>
  <headlight ambient="0.35 0.35 0.35" diffuse="0.25 0.25 0.25" specular="0 0 0"/>
  <map znear="0.005" zfar="30"/>
</visual>
<asset>
  <texture name="sky" type="skybox" builtin="gradient" rgb1=".75 .82 .90" rgb2=".95 .96 .98" width="64" height="64"/>
  <texture name="floor" type="2d" builtin="checker" rgb1=".72 .66 .58" rgb2=".68 .62 .54" width="128" height="128"/>
  <material name="floor" texture="floor" texrepeat="{extent[0]:.0f} {extent[1]:.0f}"/>
{primitives.materials(p.spec for p in placements)}{robot.assets}{assets}{covers.assets(scene)}</asset>
<worldbody>
  {covers.lights(scene)}
  <geom name="floor" type="plane" pos="{center[0]} {center[1]} 0" size="{extent[0] / 2} {extent[1] / 2} 0.1"
        material="{covers.floor(scene)}" {STATIC}/>
  {covers.walls(scene)}{covers.tables(scene)}
  {_walls(scene, names)}{_furniture(scene, names)}{"".join(_receptacle(r, names) for r in scene.receptacles)}
  {"".join(body for body, _ in parts)}
  {bodies}
  {mocap}
</worldbody>
{"".join(rest for _, rest in parts)}
</mujoco>"""
