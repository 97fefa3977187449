"""The kinds of objects: one row each, with what every service needs of shape, rest and hold.

Perception fits the shape to what it sees, manipulation takes the grasps, the brain asks whether an object stands, the
page draws the volume, the simulation builds its body from the same measures. A kind that is not in the table is taken
for a box without an upper side (`UNKNOWN`).
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal

from common.naming.looks import Look

Shape = Literal["box", "sphere", "turned"]
Rest = Literal["face", "side", "upside down"]
Hold = Literal["around", "faces", "rim"]
Segment = tuple[tuple[float, float], tuple[float, float]]
"""A piece of an outline between two points (radius, height above the surface) [m]."""
Outline = Callable[["Kind", float, float], list[Segment]]
"""Of a kind, the outer radius and the height [m]: the outline that is turned about the vertical axis."""


@dataclass(frozen=True)
class GraspRule:
    """How an upright object is approached: `angles` [deg] below horizontal, in order of trying.

    `hold`: `around` the axis from any side, on two opposite `faces`, with one finger inside the `rim`. `height` is
    where, as a share of the object's height. The rule is for objects between `least` and `most` [m] high.
    """

    hold: Hold
    angles: tuple[int, ...]
    height: float = 0.5
    least: float = 0.0
    most: float = math.inf


@dataclass(frozen=True)
class Kind:
    """What is common to all objects of a kind; an object's own `size` is in the scene file. Angles were measured with
    `python -m bench.grasp` for a parallel gripper of 85 mm.

    `shape`: the solid that stands for it, `turned` about its vertical axis by `outline` (a cylinder without one).
    `upright`: it has an upper side and is to stand on its foot. `rests`: how else it may come to rest: a box on any
    `face`, round objects on their `side` or `upside down`. `ends_alike`: top and bottom cannot be told apart.
    `lean` [rad] and `wall` [m] of a vessel's wall; `handle`: how far one reaches beyond the body [m]. `facets`: how
    much wider [m] than `size` a grip around it may be: the simulated wall has flat pieces. Lying it is taken
    `lying_point` of its length from the middle towards the top, from `lying_angles` [deg] below horizontal. `highest`:
    height [m] of the highest surface that the arm takes it from, standing; inf where none was met. `look`: the
    measures by which perception takes an object that nobody listed for one of this kind; without it, it never does.
    """

    name: str
    shape: Shape
    grasps: tuple[GraspRule, ...]
    outline: Outline | None = None
    upright: bool = True
    rests: frozenset[Rest] = frozenset()
    ends_alike: bool = False
    lean: float = 0.0
    wall: float = 0.0
    handle: float = 0.0
    facets: float = 0.0
    lying_angles: tuple[int, ...] = (75, 90, 60)
    lying_point: float = 0.0
    highest: float = math.inf
    look: Look | None = field(default=None, compare=False)

    @property
    def by_the_rim(self) -> bool:
        """True when an object of the kind is held at its wall, whose width is no measure of the object."""
        return any(rule.hold == "rim" for rule in self.grasps)

    @property
    def open_above(self) -> bool:
        """A vessel that may be found on its side."""
        return self.rests >= {"side", "upside down"}

    @property
    def straight(self) -> bool:
        """Round with a vertical wall, or a ball: any part of its surface tells where its axis is."""
        return self.shape == "sphere" or (self.shape == "turned" and not self.lean)

    def profile(self, size: tuple[float, float, float]) -> list[Segment]:
        """The outline of an object of this kind and full extents `size` (x, y, z) [m]."""
        return (self.outline or _cylinder)(self, size[0] / 2, size[2])

    def foot(self, size: tuple[float, float, float]) -> float:
        """Radius [m] of the part on which a round object of full extents `size` stands."""
        return size[0] / 2 - size[2] * math.tan(self.lean)


PLATE_FOOT = 0.6
"""Radius of the flat of a plate, as a share of the whole; chosen: dinner plates have 0.55 to 0.7."""


def _cylinder(kind: Kind, r: float, h: float) -> list[Segment]:
    return [((r, 0), (r, h)), ((r, h), (0, h))]


def _mug(kind: Kind, r: float, h: float) -> list[Segment]:
    inner, floor = r - kind.wall, 0.008
    return [((r, 0), (r, h)), ((inner, floor), (inner, h)), ((inner, h), (r, h)), ((0, floor), (inner, floor))]


def _bowl(kind: Kind, r: float, h: float) -> list[Segment]:
    base, floor = r - h * math.tan(kind.lean), 0.010
    wall = kind.wall / math.cos(kind.lean)
    return [((base, 0), (r, h)), ((base - wall, 0), (r - wall, h)), ((0, floor), (base, floor))]


def _bottle(kind: Kind, r: float, h: float) -> list[Segment]:
    neck, low = 0.014, 0.72 * h
    return [((r, 0), (r, low)), ((r, low), (neck, low)), ((neck, low), (neck, h)), ((neck, h), (0, h))]


def _plate(kind: Kind, r: float, h: float) -> list[Segment]:
    foot, flat = PLATE_FOOT * r, 0.006
    return [((foot, 0), (r, h)), ((0, flat), (foot, flat)), ((0, 0), (foot, 0))]


_ROLLING = (GraspRule("around", (90, 65, 45, 30)),)
# What is low is taken from above, what is tall from the side.
_ON_FACES = (GraspRule("faces", (90, 65, 45, 30), most=0.09), GraspRule("faces", (15, 30, 45), least=0.09))
UNKNOWN = Kind("", "box", _ON_FACES, upright=False)
_HOLLOW, _OPEN_OR_HID = (1.0, 0.45), (1.0, 0.6)
"""An open vessel's inside is seen from above, not from afar."""
_TABLE = (
    Kind(
        "mug", "turned", (GraspRule("around", (40, 55, 25), 0.55),), _mug, rests=frozenset({"side", "upside down"}),
        wall=0.004, handle=0.024, facets=0.002, lying_angles=(60, 75, 90, 50),
        look=Look(
            {"round": 1, "bowl": 0.3}, (0.062, 0.115), (0.065, 0.13), (0.7, 1.7), hollow=_HOLLOW, handle=(1, 0.7),
        ),
    ),
    Kind(
        "can", "turned", (GraspRule("around", (15, 25, 5, 40), 0.55),), rests=frozenset({"side"}), ends_alike=True,
        lying_angles=(75, 60, 90),
        look=Look({"round": 1, "long": 1}, (0.045, 0.105), (0.055, 0.19), (0.6, 2.8), handle=(0.03, 1)),
    ),
    Kind(
        "bottle", "turned", (GraspRule("around", (15, 25, 5, 40), 0.42),), _bottle, rests=frozenset({"side"}),
        lying_angles=(75, 90, 60), lying_point=-0.14,
        look=Look(
            {"round": 1, "long": 1, "box": 0.1, "irregular": 0.2}, (0.03, 0.13), (0.1, 0.38), (1.6, 8.0),
            neck=(1, 0.35), handle=(0.3, 1),
        ),
    ),
    Kind(
        "apple", "sphere", _ROLLING, upright=False,
        look=Look({"ball": 1, "round": 0.3, "irregular": 0.1}, (0.055, 0.105), (0.045, 0.105), (0.75, 1.2),
                  colours=frozenset({"red", "green", "yellow"}), share=0.8),
    ),
    Kind(
        "ball", "sphere", _ROLLING, upright=False,
        look=Look({"ball": 1, "round": 0.15}, (0.025, 0.25), (0.025, 0.25), (0.8, 1.25), share=0.9),
    ),
    Kind(
        "block", "box", _ON_FACES, upright=False, ends_alike=True, highest=1.0,
        look=Look({"box": 1}, (0.02, 0.085), (0.02, 0.11), (1.0, 1.7)),
    ),
    Kind(
        "box", "box", (GraspRule("faces", (15, 30, 45), 0.6), GraspRule("faces", (90, 70), 0.8)),
        rests=frozenset({"face"}), ends_alike=True,
        look=Look({"box": 1}, (0.025, 0.3), (0.07, 0.45), (1.0, 7.0)),
    ),
    Kind(
        "bowl", "turned", (GraspRule("rim", (65, 72, 58, 80, 90)),), _bowl, rests=frozenset({"upside down"}),
        lean=0.55, wall=0.006, highest=0.86,
        look=Look({"bowl": 1, "round": 0.3}, (0.09, 0.3), (0.03, 0.14), (0.2, 0.8), hollow=_OPEN_OR_HID),
    ),
    Kind(
        "cup", "turned", (GraspRule("around", (40, 55, 25), 0.55),), rests=frozenset({"side", "upside down"}),
        look=Look({"round": 1, "bowl": 0.5}, (0.05, 0.105), (0.05, 0.15), (0.6, 2.0), hollow=_HOLLOW, share=0.5),
    ),
    Kind(
        "jar", "turned", (GraspRule("around", (15, 25, 5, 40), 0.55),), rests=frozenset({"side"}),
        look=Look(
            {"round": 1, "long": 0.5}, (0.045, 0.13), (0.05, 0.2), (0.7, 2.2), hollow=(0.15, 1), neck=(0.3, 1),
            share=0.5,
        ),
    ),
    Kind(
        "carton", "box", (GraspRule("faces", (15, 30, 45), 0.6), GraspRule("faces", (90, 70), 0.8)),
        rests=frozenset({"face"}),
        look=Look({"box": 1, "irregular": 0.2}, (0.045, 0.13), (0.09, 0.33), (1.2, 4.0), (1.0, 1.7), share=0.8),
    ),
    Kind(
        "book", "box", _ON_FACES, rests=frozenset({"face"}), upright=False, ends_alike=True,
        look=Look({"box": 1}, (0.006, 0.06), (0.11, 0.36), (2.8, 50.0), (2.2, 40.0), (1.0, 2.2)),
    ),
    Kind(
        "plate", "turned", (GraspRule("rim", (65, 72, 58, 80, 90)),), _plate, upright=False,
        look=Look({"bowl": 1, "round": 1, "irregular": 0.2}, (0.13, 0.33), (0.008, 0.045), (0.0, 0.2), hollow=(1, 1)),
    ),
    Kind(
        "orange", "sphere", _ROLLING, upright=False,
        look=Look({"ball": 1, "round": 0.3, "irregular": 0.1}, (0.055, 0.105), (0.05, 0.105), (0.8, 1.2),
                  colours=frozenset({"orange"})),
    ),
    Kind(
        "lemon", "sphere", _ROLLING, upright=False,
        look=Look({"ball": 1, "round": 0.5, "long": 1, "irregular": 0.3}, (0.04, 0.075), (0.045, 0.1), (0.9, 1.7),
                  colours=frozenset({"yellow"}), share=0.7),
    ),
    Kind(
        "banana", "box", _ON_FACES, upright=False,
        look=Look({"long": 1, "irregular": 1, "box": 0.4}, (0.025, 0.07), (0.11, 0.25), (2.2, 8.0),
                  colours=frozenset({"yellow"})),
    ),
    Kind(
        "toy", "box", _ON_FACES, upright=False,
        look=Look({"irregular": 1}, (0.02, 0.2), (0.04, 0.3), hollow=(0.5, 1), neck=(1, 1), handle=(1, 1), share=0.7),
    ),
    Kind(
        "tool", "box", _ON_FACES, upright=False,
        look=Look({"long": 0.7, "irregular": 0.8, "box": 0.2}, (0.003, 0.07), (0.09, 0.42), (3.2, 80.0), neck=(1, 1)),
    ),
)  # fmt: skip
KINDS = {kind.name: kind for kind in _TABLE}
LOOKS = {kind.name: kind.look for kind in _TABLE if kind.look is not None}


def kind_of(name: str) -> Kind:
    """The row of a kind by its name."""
    return KINDS.get(name, UNKNOWN)


LONGER = 1.15
"""Length by height from which a box that stands on its end lies. Chosen: what is measured is off by less."""
FLAT = 0.035
"""Height [m] as it rests up to which a pack is kept lying: butter, chocolate, a dessert to be mixed. Chosen: cereal and
tea, which are kept standing, come in boxes of 40 mm and more."""


def laid_on_a_side(kind: str, size: tuple[float, float, float]) -> bool:
    """Something that stands on its end lies on a side, by its extents as it rests, the longer level one first.

    What is longest level and higher than deep stands as it is sold: a box of tea bags, a pack of tissues. What is flat
    stays as it was found.
    """
    row = kind_of(kind)
    level = size[0] > LONGER * size[2] and LONGER * size[1] > size[2]
    return row.upright and "face" in row.rests and level and size[2] > FLAT
