"""What the person sees of the robot: the object that it shows, and how fast it drives."""

import math
from collections.abc import Mapping

from common.floor_plan import Vec3
from judge.evidence import Sample

SHOWN, NEAREST = 0.10, 0.05
"""Distance [m] of an object from the place that the robot shows, up to which it is what is seen there, and by how much
any other has to be farther. Chosen: the size of an object, and half of one; between two neighbours one sees neither."""


def seen_at(place: Vec3 | None, objects: Mapping[str, Vec3]) -> str:
    """The object that a person sees at the place that the robot shows them; "" for none."""
    if place is None:
        return ""
    apart = sorted((math.dist(at, place), name) for name, at in objects.items())
    alone = len(apart) == 1 or (len(apart) > 1 and apart[1][0] > apart[0][0] + NEAREST)
    return apart[0][1] if alone and apart[0][0] < SHOWN else ""


class Onlooker:
    """Looks at every sample of the world; `about` is the place [map] that the robot shows, `shown` what is seen there,
    `speed` [m/s] its base's."""

    def __init__(self) -> None:
        self.about: Vec3 | None = None
        self.shown, self.speed = "", 0.0
        self._was = (0.0, (0.0, 0.0))

    def see(self, t: float, sample: Sample) -> None:
        """The world at robot time `t` [s]."""
        self.shown = seen_at(self.about, {name: o.position for name, o in sample.things.items()})
        (before, there), here = self._was, sample.base[:2]
        self._was = t, here
        self.speed = math.dist(there, here) / max(t - before, 0.01) if before else 0.0
