"""What a sentence asks for in the fetch pipeline: text in, intent out."""

import re
from typing import Literal

import msgspec

from common.household import Household
from common.language.clauses import without_fillers
from common.language.contractions import expand
from common.language.meaning import VERBS, asks_for, readings
from common.language.normalise import (
    Words,
    enumeration,
    infinitive,
    normalise,
    without_determiners,
)
from common.language.noun_phrase import WHICH, related
from common.language.politeness import without_politeness
from common.language.wording import Action
from common.thing import Thing

Kind = Literal["fetch", "return", "stop", "cancel", "none"]

_CONTROLS: dict[Action, Kind] = {"stop": "stop", "cancel": "cancel", "come_back": "return"}
_FETCH: frozenset[Action] = frozenset({"fetch", "get", "fetch_named", "pick_up", "find"})
_INDEFINITE = re.compile(r"\b(?:a|an|any|some)\s+\w")


class Intent(msgspec.Struct, frozen=True):
    """`item` is the object as spoken, `label` its name in the household; `reason` says why there is no intent."""

    kind: Kind
    item: str = ""
    label: str = ""
    reason: str = ""


def parse(text: str, household: Household) -> Intent:
    """The intent of a sentence; kind `none` with a reason that can be spoken when there is none."""
    if action := asks_for(text, *_CONTROLS):
        return Intent(_CONTROLS[action])
    words = tuple(without_politeness(without_fillers(expand(normalise(text)))).split())
    any_one = _INDEFINITE.search(" ".join(words)) is not None
    named = _object_phrases(words)
    for candidate in (item for variants in named for item in variants):
        label, _ = find_object(candidate, household, any_one)
        if label:
            exact = household.thing(candidate) is not None
            return Intent("fetch", item=candidate if exact else label, label=label)
    return Intent("none", reason=find_object(named[0][-1] if named else "", household)[1])


def _object_phrases(words: Words) -> list[list[str]]:
    """Per reading of the sentence what it may name, the most literal first."""
    words = (infinitive(words[0], VERBS), *words[1:]) if words else words
    phrases = [slots["thing"] for wording, slots in readings(words, "command", "name") if wording.action in _FETCH]
    return [_variants(without_determiners(phrase)) for phrase in phrases]


def _variants(phrase: Words) -> list[str]:
    """A noun phrase as it is, without where the object is, and without its size."""
    bare = min((without_determiners(head) for head, _, _ in related(phrase)), key=len, default=phrase)
    return [" ".join(phrase), " ".join(bare), " ".join(w for w in bare if w not in WHICH)]


def find_object(thing: str, household: Household, any_one: bool = False) -> tuple[str, str]:
    """(household name, "") of the object meant, else ("", why not); with `any_one` the first of several will do."""
    known = household.thing(thing)
    if known is not None:
        return known.name, ""
    words = thing.split()
    if not words:
        return "", "I did not hear what to bring."
    nouns = _nouns(household)
    colours = {o.colour for o in household.things}
    for split in range(len(words)):
        noun = " ".join(words[split:])
        kind = nouns.get(noun) or nouns.get(noun.removesuffix("s"))
        if kind is None or not set(words[:split]) <= colours:
            continue
        named = [o for o in household.things if o.kind == kind and (not split or o.colour in words[:split])]
        if len(named) == 1 or (named and any_one):
            return named[0].name, ""
        if named:
            return "", f"Which {noun}: {_choice(named)}?"
    if len(words) == 2 and words[1] in nouns:
        return "", f"I know no {thing}, only the {_choice([o for o in household.things if o.kind == nouns[words[1]]])}."
    return "", f"I do not know what {thing!r} is."


def _nouns(household: Household) -> dict[str, str]:
    """Words for kinds of objects: the kinds, and what aliases leave when the colour is taken off."""
    nouns: dict[str, str] = {o.kind: o.kind for o in household.things}
    for spec in household.things:
        for name in (spec.name, *spec.aliases):
            if name.startswith(f"{spec.colour} "):
                nouns.setdefault(name.removeprefix(f"{spec.colour} "), spec.kind)
    return nouns


def _choice(specs: list[Thing]) -> str:
    return enumeration([s.name for s in specs], "or")
