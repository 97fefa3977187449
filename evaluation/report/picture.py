"""A picture of how a case ended, for the gallery of failures."""

import base64
from collections.abc import Callable

from common import topics
from common.bus import codec
from common.rendering.encode import jpeg
from common.rendering.free_camera import free_view
from common.rendering.renderer import Renderer

WIDTH, HEIGHT, QUALITY = 420, 300, 80
"""Size of the picture [px]; chosen: three beside each other in the report."""
Get = Callable[[str], bytes | None]


def last_picture(get: Get) -> str:
    """The world as it is now, around the robot: a JPEG in base64; "" when there is no simulation.

    Cast by rays, so that it neither needs nor disturbs a GL context. `get` answers like a zenoh `get`.
    """
    model, state = get(topics.SIM_MODEL.key), get(topics.SIM_STATE.key)
    if not model or not state:
        return ""
    seen = codec.decode(topics.SIM_STATE, state)
    described = codec.decode(topics.SIM_MODEL, model)
    renderer = Renderer(described.mjcf, "raycast", described.files)
    try:
        renderer.load(seen.qpos, seen.mocap)
        picture = renderer.picture(free_view(renderer), WIDTH, HEIGHT)
    except (ValueError, KeyError):
        return ""
    finally:
        renderer.close()
    return base64.b64encode(jpeg(picture, QUALITY)).decode("ascii")
