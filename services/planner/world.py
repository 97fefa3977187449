"""The believed world: the objects that the planner was told of, where they are, what is in the hand. Pure."""

from collections.abc import Sequence

import msgspec

from common.floor_plan import Receptacle
from common.household import Household
from common.messages import BatteryState, History, HouseholdEdits, KnownWorld, Sighting, Vec3, WorldObject

Pose2 = tuple[float, float, float]


class BelievedObject(msgspec.Struct, frozen=True):
    """An object by the name that plans use. `seen` is False for one that the household names and nobody has seen."""

    label: str
    kind: str
    colour: str = ""
    position: Vec3 | None = None
    on: str = ""
    size: Vec3 = (0.0, 0.0, 0.0)
    seen: bool = True
    seen_at: float = 0.0
    held: bool = False
    names: tuple[str, ...] = ()
    text: str = ""
    colours: frozenset[str] = frozenset()

    def is_of(self, colour: str) -> bool:
        """Is it of this colour, or is it one of several on it?"""
        return colour == self.colour or colour in self.colours


class World(msgspec.Struct):
    """`objects`: seen or held; `specs`: the known things of the household; `pose`: the robot's in the map.

    `edits`: what people told of the home; `sightings`: what was seen where over the days, by the clock of `seen_until`;
    `battery`: None where nobody tells of it.
    """

    household: Household
    objects: list[BelievedObject] = []
    specs: list[BelievedObject] = []
    places: list[str] = []
    pose: Pose2 = (0.0, 0.0, 0.0)
    now: float = 0.0
    history: History = msgspec.field(default_factory=History)
    edits: HouseholdEdits = msgspec.field(default_factory=HouseholdEdits)
    sightings: list[Sighting] = []
    seen_until: float = 0.0
    battery: BatteryState | None = None

    @property
    def held(self) -> BelievedObject | None:
        return next((t for t in self.objects if t.held), None)

    @property
    def names(self) -> frozenset[str]:
        """Labels and kinds of things that were seen or that the household has."""
        return frozenset(name for t in (*self.objects, *self.specs) for name in (t.label, t.kind))

    def receptacle_of(self, item: BelievedObject) -> Receptacle | None:
        """What a thing stands on or in."""
        return self.household.receptacle(item.on) if item.on else None

    def room_of(self, item: BelievedObject) -> str:
        """The room a thing is in, "" when unknown."""
        where = item.position
        if where is None and (r := self.receptacle_of(item)):
            where = r.center
        room = self.household.room_at(where[0], where[1]) if where else None
        return room.name if room else ""

    def distance(self, item: BelievedObject) -> float:
        """From the robot [m]; inf when its position is unknown."""
        where = item.position
        if where is None and (r := self.receptacle_of(item)):
            where = r.center
        if where is None:
            return float("inf")
        return float(((where[0] - self.pose[0]) ** 2 + (where[1] - self.pose[1]) ** 2) ** 0.5)

    def current(self, item: BelievedObject) -> BelievedObject:
        """What is believed now of a thing mentioned before."""
        return next((t for t in self.objects if t.label == item.label), item)

    def copy(self) -> "World":
        return msgspec.structs.replace(self, objects=list(self.objects))

    # --- what steps do to it
    def grasp(self, label: str) -> None:
        self._change(label, held=True, on="", position=None)

    def put(self, where: str) -> None:
        """What is held is now on `where`, "" for an unknown spot."""
        if held := self.held:
            self._change(held.label, held=False, on=where, position=None)

    def _change(self, label: str, **fields: object) -> None:
        for i, item in enumerate(self.objects):
            if item.label == label and (fields["held"] != item.held):
                self.objects[i] = msgspec.structs.replace(item, **fields)
                return
        spec = next((t for t in self.specs if t.label == label), BelievedObject(label, label))
        self.objects.append(msgspec.structs.replace(spec, seen=True, **fields))


def believed(
    household: Household,
    told: KnownWorld,
    objects: Sequence[WorldObject],
    pose: Pose2 = (0.0, 0.0, 0.0),
    now: float = 0.0,
    history: History | None = None,
) -> World:
    """The world from a request's own list and the latest `world/objects`; the request says what is held."""
    specs = [
        BelievedObject(label=o.name, kind=o.kind, colour=o.colour, size=o.size, seen=False) for o in household.things
    ]
    named = {t.label: t for t in specs}
    held = _canonical(told.held, household)
    found: list[BelievedObject] = []
    for o in objects:
        if not o.label.strip():
            continue
        spec = named.get(_canonical(o.label, household))
        in_hand = bool(held) and _canonical(o.label, household) == held and not any(t.held for t in found)
        found.append(
            BelievedObject(
                label=spec.label if spec else o.label,
                kind=o.kind or (spec.kind if spec else ""),
                colour=o.colour or (spec.colour if spec else ""),
                position=None if in_hand else o.position,
                on="" if in_hand else _canonical_part(o.on, household) or _resting_on(o.position, household),
                size=o.size if any(o.size) else (spec.size if spec else o.size),
                seen_at=o.seen_at,
                held=in_hand,
                names=tuple(o.names),
                text=o.text,
                colours=frozenset(o.colours),
            )
        )
    labels = {t.label for t in found}
    for label in (*told.objects, told.held):
        name = _canonical(label, household)
        if name.strip() and name not in labels:
            labels.add(name)
            spec = named.get(name, BelievedObject(name, name))
            found.append(msgspec.structs.replace(spec, seen=True, held=name == held))
    told_of = history or History()
    return World(household, found, specs, list(told.places), pose, now, told_of)


def _canonical(label: str, household: Household) -> str:
    spec = household.thing(label)
    return spec.name if spec else label


def _canonical_part(name: str, household: Household) -> str:
    part = household.receptacle(name) if name else None
    return part.name if part else name


def _resting_on(position: Vec3, household: Household) -> str:
    """Name of the surface that an object rests on; "" when there is none."""
    surface = household.resting_place(position)
    return surface.name if surface else ""
