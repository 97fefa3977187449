"""Lamps, and coverings of floors, walls and table tops: thin textured geoms that collide with nothing."""

import math

from common.scene import Lamp, Scene
from services.sim.things import finish
from services.sim.things.primitives import GROUP

AWAY = 0.001
"""How far [m] before a surface its picture hangs: nothing that a depth camera could tell."""
CEILING = 3.5
"""Height [m] of the lamps of rooms that have none of their own."""


def lights(scene: Scene) -> str:
    """MJCF of the world's lamps, or of one for each room where it has none."""
    usual = [Lamp(position=(*room.middle, CEILING), colour=(1.0, 1.0, 0.97)) for room in scene.rooms]
    return "".join(_light(lamp) for lamp in scene.lamps or usual)


def _light(lamp: Lamp) -> str:
    pos = " ".join(f"{v:g}" for v in lamp.position)
    diffuse = " ".join(f"{v * lamp.brightness:.4g}" for v in lamp.colour)
    return f'<light pos="{pos}" dir="0 0 -1" diffuse="{diffuse}" specular="0.05 0.05 0.05" castshadow="false"/>'


def _used(scene: Scene) -> list[str]:
    chosen = scene.finish
    return sorted({chosen.floor, chosen.walls, chosen.tables} - {""})


def assets(scene: Scene) -> str:
    """MJCF of the materials and textures."""
    return "".join(finish.assets(name) for name in _used(scene))


def files(scene: Scene) -> dict[str, bytes]:
    """The pictures, by file name."""
    return dict(finish.file(name) for name in _used(scene))


def floor(scene: Scene) -> str:
    """Name of the floor's material."""
    return f"finish_{scene.finish.floor}" if scene.finish.floor else "floor"


def _sheet(name: str, material: str, half: tuple[float, float], pos: tuple[float, ...], euler: str) -> str:
    at = " ".join(f"{v:.4f}" for v in pos)
    return (
        f'<geom name="{name}" type="plane" size="{half[0]:.4f} {half[1]:.4f} 0.1" pos="{at}" euler="{euler}" '
        f'material="finish_{material}" contype="0" conaffinity="0" group="{GROUP}"/>'
    )


def walls(scene: Scene) -> str:
    """MJCF of wallpaper on both sides of every wall."""
    if not scene.finish.walls:
        return ""
    sheets = []
    for n, wall in enumerate(scene.walls):
        x, y, length, thickness, yaw = wall.footprint
        for side in (1, -1):
            out = side * (thickness / 2 + AWAY)
            pos = (x - out * math.sin(yaw), y + out * math.cos(yaw), wall.height / 2)
            # A plane looks along its z: turned up about x, then to the wall's side about the vertical.
            turn = yaw + (math.pi if side > 0 else 0.0)
            half = (length / 2, wall.height / 2)
            sheets.append(
                f'<body pos="{pos[0]:.4f} {pos[1]:.4f} {pos[2]:.4f}" euler="0 0 {turn:.6f}">'
                f"{_sheet(f'wall_{n}_face_{side}', scene.finish.walls, half, (0, 0, 0), '1.570796 0 0')}</body>"
            )
    return "".join(sheets)


def tables(scene: Scene) -> str:
    """MJCF of cloth, wood or stone on every table top."""
    if not scene.finish.tables:
        return ""
    return "".join(
        _sheet(
            f"{r.name.replace(' ', '_')}_cover", scene.finish.tables, (r.size[0] / 2, r.size[1] / 2),
            (r.center[0], r.center[1], r.center[2] + AWAY / 3), f"0 0 {r.yaw}",
        )
        for r in scene.receptacles
        if r.kind == "table"
    )  # fmt: skip
