"""What is known of how each object looks: crops of its sides, and what was made of them."""

import math
from dataclasses import dataclass, field

from common.messages import WorldObject
from services.perception.naming.appearance import Look
from services.perception.naming.crop import Crop, crop_of
from services.perception.naming.memory import with_look
from services.perception.naming.text import Line, merged, sure_words
from services.perception.views.view import View

RENEWED = 3.0
"""Time [s] after which an object is looked at anew though it shows no other side. Chosen: three pictures under way."""
MAX_SIDES = 4
"""Looks kept of an object in sight; the newest count."""
LEGIBLE = 1000.0
"""Pixels per metre from which print of a package is legible: letters of 8 mm have 8 pixels."""
ROUGHLY = 650.0
"""Pixels per metre from which words that were read for sure are those that are printed (measured: 1.8 m)."""
APART = 0.5
"""Angle [rad] between two directions from which different sides are read. Chosen: what goes around a can is read up to
1.15 to either side, at the edge with few letters."""
SIDES = 3
"""Directions from which an object is read before it is one without print. Chosen: the front of a box is on one side in
four, and two in three of its neighbours show it slanting."""


@dataclass
class Sight:
    """One object: the newest crop, `looks` at its sides, `lines` read on it.

    `looked_at`: robot time [s] of the newest look; `legible`: pixels per metre of the finest crop that was read;
    `read_from`: directions [rad, map] from it to the camera from which its print was legible, if there is any.
    """

    crop: Crop | None = None
    looks: list[Look] = field(default_factory=list)
    lines: list[Line] = field(default_factory=list)
    looked_at: float = -1e9
    legible: float = 0.0
    read_from: list[float] = field(default_factory=list)

    @property
    def read(self) -> bool:
        """It was near enough, or fine enough a picture, for its print to be read if it has any on this side."""
        return bool(self.read_from)

    @property
    def exhausted(self) -> bool:
        """It was read from so many sides that another shows nothing new."""
        return len(self.read_from) >= SIDES

    @property
    def named(self) -> bool:
        """Words were read on it for sure."""
        return bool(sure_words(self.lines))

    @property
    def told(self) -> bool:
        """Words were read on it for sure, from near enough not to take others for them."""
        return self.named and self.legible >= ROUGHLY

    def unread_side(self, crop: Crop) -> bool:
        """A crop shows a side that was not read yet, or shows it more finely."""
        return self.legible < crop.pixels_per_metre or self._new_side(crop)

    def _new_side(self, crop: Crop) -> bool:
        angle = _azimuth(crop)
        return all(abs(math.remainder(angle - other, math.tau)) >= APART for other in self.read_from)

    def add(self, look: Look, now: float) -> None:
        """Take a look: in place of one from the same side, else beside the others."""
        kept = with_look(self.looks, look)
        self.looks = [*(other for other in kept if other is not look), look][-MAX_SIDES:]
        self.looked_at = now

    def add_lines(self, lines: list[Line], crop: Crop) -> None:
        """Take what was read on a crop, be it nothing."""
        self.lines = merged(self.lines, lines)
        self.legible = max(self.legible, crop.pixels_per_metre)
        if crop.pixels_per_metre >= LEGIBLE and self._new_side(crop):
            self.read_from.append(_azimuth(crop))


def _azimuth(crop: Crop) -> float:
    """Direction [rad, map] from the object to the camera."""
    return math.atan2(crop.bearing[1], crop.bearing[0])


class Sights:
    """All objects in sight, by their id in `world/objects`; the newest `view`, and the ids of those that it has
    `shown`."""

    def __init__(self) -> None:
        self.by_id: dict[str, Sight] = {}
        self.view: View | None = None
        self.shown: list[str] = []

    def see(self, view: View, objects: list[WorldObject]) -> list[str]:
        """Cut the objects out of a view; ids of those that it shows. What is held is not cut: fingers are before it."""
        self.view, self.shown = view, []
        known = {o.id for o in objects}
        self.by_id = {key: sight for key, sight in self.by_id.items() if key in known}
        for o in objects:
            crop = None if o.held or not o.id else crop_of(view, o)
            if crop is not None:
                self.by_id.setdefault(o.id, Sight()).crop = crop
                self.shown.append(o.id)
        return self.shown
