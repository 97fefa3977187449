"""The words for places: rooms, surfaces, standing places and furniture, from the household. Pure."""

import re
from collections.abc import Iterable, Mapping

from common.floor_plan import Receptacle
from common.household import Household
from common.language.normalise import Words, normalise, without_determiners
from common.language.noun_phrase import UNSEEN
from services.planner.grammar.senses import HERE, Spot, singulars

BESIDE_FURNITURE = 0.8
"""Farthest the middle of a surface is from furniture that it stands by [m] (chosen: a small table's width)."""


class Spots:
    """`colours`: words for colours, with the colour that each means; `told`: names of places beside the plan's."""

    def __init__(self, household: Household, told: Iterable[str], colours: Mapping[str, str]) -> None:
        self._household, self.colours = household, dict(colours)
        self._places = self._standing(household, told)
        self._called = [(r, normalise(r.name), frozenset(map(normalise, r.aliases))) for r in household.receptacles]
        self._found: dict[tuple[Words, str], list[Spot]] = {}

    def _standing(self, household: Household, told: Iterable[str]) -> dict[str, Spot]:
        spots = {normalise(p): Spot(p) for p in told if household.receptacle(p) is None}
        for place in household.places:
            spots |= {normalise(n): Spot(place.name) for n in (place.name, *place.aliases)}
        for room in household.rooms:
            spots |= {normalise(n): Spot(room.name, room=True) for n in (room.name, *room.aliases)}
        home = Spot(household.home.name, home=True)
        return spots | {normalise(n): home for n in (household.home.name, *household.home.aliases, *HERE)}

    def spot(self, words: Words, room: str = "") -> list[Spot]:
        """Every place that the words can mean, the best alone when one is meant by name; [] if unknown."""
        key = words, room  # the same spans of a sentence come again and again
        if key not in self._found:
            self._found[key] = self._spot(words, room)
        return self._found[key]

    def _spot(self, words: Words, room: str) -> list[Spot]:
        phrase = " ".join(without_determiners(words))
        if not phrase:
            return []
        if whole := [r for r, name, _ in self._called if not room and phrase == name]:
            return [Spot(whole[0].name, receptacle=whole[0])]
        for preposition in ("in", "of", "from", "at"):
            head, found, tail = phrase.partition(f" {preposition} ")
            where = self._places.get(" ".join(without_determiners(tuple(tail.split())))) if found else None
            if where is not None and where.room:
                return self.spot(tuple(head.split()), where.name)
        for preposition in ("on", "at", "by"):
            head, found, tail = phrase.partition(f" {preposition} ")
            head = re.sub(r" (?:that|which) (?:is|are|stands|lies)$", "", head)
            inside = self._places.get(" ".join(without_determiners(tuple(head.split())))) if found else None
            if inside is not None and inside.room:  # in the bedroom on the dresser
                return self.spot(tuple(tail.split()), inside.name)
        for at in range(1, len(phrase.split())) if not room else ():  # the living room table
            around = self._places.get(" ".join(phrase.split()[:at]))
            if around is not None and around.room and (there := self.spot(tuple(phrase.split()[at:]), around.name)):
                return there
        if words and without_determiners(words)[0] in UNSEEN and len(phrase.split()) > 1:
            return self.spot(without_determiners(words)[1:], room)
        if not room and (place := self._places.get(phrase)):
            return [place]
        named = [r for r, name, aliases in self._called if phrase == name or phrase in aliases]
        colour, _, rest = phrase.partition(" ")
        meant = self.colours.get(colour)
        kin = [
            r
            for r, name, _ in self._called
            if r.kind == phrase or f" {name}".endswith(f" {phrase}") or (meant and _coloured(r, meant, rest))
        ]
        if room:
            named, kin = [r for r in named if self._is_in(r, room)], [r for r in kin if self._is_in(r, room)]
        if not (named or kin) and phrase.endswith("s") and not phrase.endswith("ss"):
            return self.spot((*without_determiners(words)[:-1], words[-1][:-1]), room)
        if not (named or kin or room):
            return self._turned_round(phrase)
        return [Spot(r.name, receptacle=r) for r in named or kin]

    def _turned_round(self, phrase: str) -> list[Spot]:
        """`tray for deliveries` as the delivery tray, `shelf of books` as the bookshelf."""
        head, of, tail = re.sub(r" for ", " of ", phrase).partition(" of ")
        of_what = " ".join(without_determiners(tuple(tail.split())))
        for form, _ in singulars(of_what) if of and of_what else ():
            form = f"{form[:-2]}y" if form.endswith("ie") else form
            for name in (f"{form} {head}", f"{form}{head}"):
                if found := self.spot((*name.split(),)):
                    return found
        return []

    def _is_in(self, r: Receptacle, room: str) -> bool:
        found = self._household.room_at(r.center[0], r.center[1])
        return found is not None and found.name == room

    def furniture(self, words: Words) -> str:
        """The furniture meant, which is in the way but no place to put things."""
        phrase = " ".join(without_determiners(words))
        return next((f.name for f in self._household.furniture if phrase and phrase in normalise(f.name)), "")

    def surfaces_by(self, words: Words) -> list[Spot]:
        """The surfaces beside a piece of furniture that is none itself, as the bedside table is by the bed."""
        name = self.furniture(words)
        boxes = [f.outline for f in self._household.furniture if f.name == name]
        return [
            Spot(r.name, receptacle=r)
            for r in self._household.receptacles
            if any(box.distance(*r.center[:2]) < BESIDE_FURNITURE for box in boxes)
        ]

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


def _coloured(r: Receptacle, colour: str, rest: str) -> bool:
    return r.colour == colour and rest in (r.kind, *r.name.split(), r.name, *r.aliases)
