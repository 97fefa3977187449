"""Parameters of the cameras."""

from typing import Literal

from common.config import Config


class CameraConfig(Config, frozen=True):
    """`backend` auto takes EGL or OSMesa where they work and MuJoCo's own ray casting otherwise.

    `sensors`: `bought`, with the noise and the gaps of a stereo depth camera (see sensor.py), or `ideal`.
    `max_width`, `max_height`: as fine per angle as the colour imager of the D435 at 1920 x 1080 (69 degrees across).
    `calibration`: the file of `tidybot calibrate` for this robot; without one the cameras are where their drawing says.
    """

    backend: Literal["auto", "egl", "osmesa", "raycast"] = "auto"
    sensors: Literal["bought", "ideal"] = "bought"
    calibration: str = ""
    max_width: int = 1920
    max_height: int = 1440
    render_seconds: float = 0.1
