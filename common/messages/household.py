"""What people tell of their home: names of its parts, where things belong; and what was seen where."""

from typing import Literal

from common.messages.base import Message, Vec3

PartKind = Literal["room", "surface", "place"]
EditAction = Literal["name", "forget", "rule", "forget rule"]
EditCode = Literal[
    "", "NO_NAME", "NAME_TAKEN", "NO_PART", "AMBIGUOUS", "UNKNOWN_NAME", "NO_RULE", "TOO_MANY", "NOT_KEPT"
]


class PlaceName(Message):
    """A name that a person gave. `part`: the surface or room that has it, as the household file calls it, `at` its
    middle: a home that is mapped again may number its parts anew.

    Without a `part` it is a standing place at `pose` (x, y, theta), or a room that no map has, between `low` and
    `high`.
    """

    name: str
    kind: PartKind
    part: str = ""
    pose: Vec3 = (0.0, 0.0, 0.0)
    low: tuple[float, float] = (0.0, 0.0)
    high: tuple[float, float] = (0.0, 0.0)
    at: Vec3 | None = None


class TidyRule(Message):
    """Where things belong: those of all `kinds` and `colours` that are not empty, or of these `names`, go to the first
    surface of `to` that the home has. `things`: the words that a person used; `at`: the middle of the first surface."""

    things: str
    to: list[str]
    kinds: list[str] = []
    colours: list[str] = []
    names: list[str] = []
    at: Vec3 | None = None


class HouseholdEdits(Message):
    """All that people have told and not taken back, the newest last."""

    names: list[PlaceName] = []
    rules: list[TidyRule] = []


class HouseholdEdit(Message):
    """Something to keep: a `name`, a name to `forget`, a tidying `rule`, or a `forget rule`.

    The part meant by `name` is the one called `part`; else what `position` (frame map) lies on or in; else what the
    robot stands before, in or at. `kind` narrows it; "" lets the name say whether it is a room or a surface.
    `forget rule` takes back the rule about `name`, with "" the newest.
    """

    do: EditAction = "name"
    name: str = ""
    id: str = ""
    attempt: int = 0
    part: str = ""
    kind: PartKind | Literal[""] = ""
    position: Vec3 | None = None
    rule: TidyRule | None = None


class EditResult(Message):
    """What came of a `HouseholdEdit`, once it is on disk. `part`: what had been called otherwise before, or where the
    things of a rule go; `detail` says to people why it was not done."""

    goal_id: str
    ok: bool
    attempt: int = 0
    name: str = ""
    part: str = ""
    kind: PartKind | Literal[""] = ""
    code: EditCode = ""
    detail: str = ""


class HomePart(Message):
    """A room, surface or standing place as it is called now; `given`: by a person. `room`: where a surface is."""

    name: str
    kind: PartKind
    room: str = ""
    given: bool = False
    x: float = 0.0
    y: float = 0.0


class HomeParts(Message):
    """All that the home has names for."""

    parts: list[HomePart]


class Sighting(Message):
    """How often a thing was seen on a surface. `thing`: its label or a taught name; `part` as the household file calls
    the surface or furniture, "" for the floor.

    `weight`: visits on which it was there, older ones counting less, as of `last` [s since 1970, or robot time within
    an evaluation], when it was last seen there, at `position`.
    """

    thing: str
    kind: str
    colour: str
    part: str
    weight: float
    last: float
    position: Vec3 = (0.0, 0.0, 0.0)


class Sightings(Message):
    """What was seen where over the days, at the time `t` of the same clock."""

    t: float
    sightings: list[Sighting] = []
