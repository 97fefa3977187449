"""The words for objects and places: from the household, from what was seen, and from the configuration. Pure."""

from collections.abc import Iterable

import msgspec

from common.floor_plan import Receptacle
from common.household import Household
from common.language.normalise import Words, enumeration, normalise, without_determiners
from services.planner.config import PlannerConfig
from services.planner.world import World

ANY = frozenset({"thing", "object", "item", "stuff", "mess", "one"})
WHOLE = frozenset({"everything", "anything", "something", "all", "mess"})
_HERE = frozenset({"me", "us", "here", "home", "start", "over here", "back"})


class Sense(msgspec.Struct, frozen=True):
    """What a noun can mean: objects of these kinds, or of these names; `every`: any object at all."""

    kinds: frozenset[str] = frozenset()
    names: frozenset[str] = frozenset()
    every: bool = False
    prefer: str = ""


class Spot(msgspec.Struct, frozen=True):
    """A place to go to or to put things: exactly one of the receptacle, the room, a standing place, or the person."""

    name: str
    receptacle: Receptacle | None = None
    room: bool = False
    home: bool = False


class Vocabulary:
    """Built for one request."""

    def __init__(self, world: World, config: PlannerConfig) -> None:
        self._household = household = world.household
        known = [*world.specs, *world.objects]
        self.kinds = {t.kind for t in known if t.kind}
        self.colours = {c: c for c in {*(t.colour for t in known), *(r.colour for r in household.receptacles)} if c}
        self.colours |= {word: c for word, c in config.colours.items() if c in self.colours}
        self._nouns: dict[str, Sense] = {}
        self._aliases(household)
        for item in known:
            self._nouns.setdefault(normalise(item.label), Sense(names=frozenset({item.label})))
        for kind in self.kinds:
            named = self._nouns.get(kind, Sense())
            only = next(iter(named.names)) if len(named.names) == 1 else ""
            self._nouns[kind] = Sense(kinds=frozenset({kind}), prefer=only)
        for word, group in config.groups.items():
            if members := frozenset(k for k in group if k in self.kinds):
                self._nouns.setdefault(normalise(word), Sense(kinds=members))
        self._mass = frozenset(map(normalise, config.mass))
        self._places = self._standing(household, world.places)

    def _aliases(self, household: Household) -> None:
        for spec in household.things:
            for alias in (spec.name, *spec.aliases):
                self._nouns[normalise(alias)] = Sense(names=frozenset({spec.name}))
            for alias in spec.aliases:
                noun = normalise(alias).removeprefix(f"{spec.colour} ")
                if noun != normalise(alias):
                    self._nouns.setdefault(noun, Sense(kinds=frozenset({spec.kind})))

    def _standing(self, household: Household, told: Iterable[str]) -> dict[str, Spot]:
        spots = {normalise(p): Spot(p) for p in told if household.receptacle(p) is None}
        for place in household.places:
            spots |= {normalise(n): Spot(place.name) for n in (place.name, *place.aliases)}
        for room in household.rooms:
            spots |= {normalise(n): Spot(room.name, room=True) for n in (room.name, *room.aliases)}
        home = Spot(household.home.name, home=True)
        return spots | {normalise(n): home for n in (household.home.name, *household.home.aliases, *_HERE)}

    # --- nouns
    def noun(self, phrase: str) -> tuple[Sense, str, bool] | None:
        """(meaning, singular form, is it a plural) of a noun without colours; None if unknown."""
        if phrase in WHOLE:
            return Sense(every=True), "thing", phrase in ("everything", "all", "mess")
        for form, plural in _singulars(phrase):
            if form in ANY:
                return Sense(every=True), form, plural
            if sense := self._nouns.get(form):
                return sense, form, plural or form in self._mass
        return None

    # --- spots
    def spot(self, words: Words, room: str = "") -> list[Spot]:
        """Every place that the words can mean, the best alone when one is meant by name; [] if unknown."""
        phrase = " ".join(without_determiners(words))
        if not phrase:
            return []
        for preposition in ("in", "of", "from", "at"):
            head, found, tail = phrase.partition(f" {preposition} ")
            where = self._places.get(" ".join(without_determiners(tuple(tail.split())))) if found else None
            if where is not None and where.room:
                return self.spot(tuple(head.split()), where.name)
        if not room and (place := self._places.get(phrase)):
            return [place]
        named = [r for r in self._household.receptacles if phrase in map(normalise, (r.name, *r.aliases))]
        colour, _, rest = phrase.partition(" ")
        meant = self.colours.get(colour)
        kin = [
            r
            for r in self._household.receptacles
            if r.kind == phrase
            or f" {normalise(r.name)}".endswith(f" {phrase}")
            or (meant and _coloured(r, meant, rest))
        ]
        if room:
            named, kin = [r for r in named if self._is_in(r, room)], [r for r in kin if self._is_in(r, room)]
        return [Spot(r.name, receptacle=r) for r in named or kin]

    def _is_in(self, r: Receptacle, room: str) -> bool:
        found = self._household.room_at(r.center[0], r.center[1])
        return found is not None and found.name == room

    def furniture(self, words: Words) -> str:
        """The furniture meant, which is in the way but no place to put things."""
        phrase = " ".join(without_determiners(words))
        return next((f.name for f in self._household.furniture if phrase and phrase in normalise(f.name)), "")

    def position(self, place: Spot) -> tuple[float, float] | None:
        """The middle of a surface, or where one stands at a place [m]; None for a room."""
        if place.receptacle is not None:
            return place.receptacle.center[0], place.receptacle.center[1]
        stands = (self._household.home, *self._household.places)
        return next(((p.x, p.y) for p in stands if p.name == place.name and not place.room), None)

    def surfaces(self, room: str = "") -> list[Receptacle]:
        """Where things may lie, in a room or everywhere."""
        return [
            r for r in self._household.receptacles if r.spawn and not r.depth and (not room or self._is_in(r, room))
        ]

    def receptacles_named(self) -> str:
        return enumeration([r.name for r in self._household.receptacles], "or")


def _coloured(r: Receptacle, colour: str, rest: str) -> bool:
    return r.colour == colour and rest in (r.kind, *r.name.split(), r.name, *r.aliases)


def _singulars(phrase: str) -> list[tuple[str, bool]]:
    forms = [(phrase, False)]
    if phrase.endswith("s"):
        forms += [(phrase[:-1], True)]
    if phrase.endswith("es"):
        forms += [(phrase[:-2], True)]
    first, _, rest = phrase.partition(" of ")
    if rest and first.endswith("s"):
        forms += [(f"{first[:-1]} of {rest}", True)]
    return forms
