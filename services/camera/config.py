"""Parameters of the cameras."""

from typing import Literal

from common.config import Config


class CameraConfig(Config, frozen=True):
    """How pictures are rendered, with which sensor errors, and in which size."""

    backend: Literal["auto", "egl", "osmesa", "raycast"] = "auto"
    """`auto` takes EGL or OSMesa where they work and MuJoCo's own ray casting otherwise."""
    sensors: Literal["bought", "ideal"] = "bought"
    """`bought`: with the noise and the gaps of a stereo depth camera (see sensor.py); or `ideal`."""
    calibration: str = ""
    """File of `tidybot calibrate` for this robot; "": the cameras are where their drawing says."""
    max_width: int = 1920
    """Columns of the finest picture [pixels]; as fine per angle as the D435's colour imager, 69 degrees across."""
    max_height: int = 1440
    """Rows of the finest picture [pixels]."""
    render_seconds: float = 0.1
    """What a picture takes in lockstep [s]."""
