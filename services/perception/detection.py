"""What a detector reports of one object in one view."""

from dataclasses import dataclass, field

import numpy as np

from common.floor_plan import Vec3
from common.geometry import Array
from common.messages import End, ShapeFamily


@dataclass(frozen=True)
class Detection:
    """An object in frame map: `position` is its centre, `size` its full extent, `yaw` about z; `on` its surface.

    `tilt`: angle [rad] of its own axis to the vertical. Of what lies on its side the first extent is along that axis,
    which points along `yaw`. `whole`: all of it was in view, so that the position can be trusted; `share`: about how
    much of it was. `yaw_seen`: the yaw is no guess, as that of a mug whose handle is hidden, or of what may lie the
    other way round. `end`: what the upper end of what stands is, or the end of what lies that was seen.

    `known`: it is an object of the household, called `label`; otherwise the label is empty, `size` was measured, and
    `kinds` are what it may be, with shares that add up to 1. `colours`: shares of its pixels by the word for their
    colour; `spread` [m]: standard deviation of extents and position; `points` (n, 3) [map]: where its surface is.
    """

    label: str
    kind: str
    colour: str
    position: Vec3
    yaw: float
    size: Vec3
    confidence: float
    on: str
    distance: float
    known: bool = True
    whole: bool = True
    share: float = 1.0
    tilt: float = 0.0
    yaw_seen: bool = True
    end: End = ""
    shape: ShapeFamily = ""
    kinds: dict[str, float] = field(default_factory=dict)
    colours: dict[str, float] = field(default_factory=dict)
    spread: float = 0.0
    points: Array = field(default_factory=lambda: np.empty((0, 3)))
