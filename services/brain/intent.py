"""What a sentence asks for in the fetch pipeline: text in, intent out."""

import re
from typing import Literal

import msgspec

from common.scene import ObjectSpec, Scene

Kind = Literal["fetch", "return", "stop", "cancel", "none"]

STOP = frozenset({"stop", "stop it", "stop now", "halt", "freeze", "emergency stop", "stop moving"})
CANCEL = frozenset({"cancel", "cancel that", "cancel it", "abort", "never mind", "nevermind", "forget it"})
RETURN = frozenset({"come back", "come home", "go home", "return", "return home", "return to start", "go back"})

_POLITE = re.compile(
    r"^(?:(?:hey|hello|hi|ok|okay|jarvis|robot|tidybot|please|now|and|so|"
    r"(?:can|could|would|will) you|would you mind|i (?:would like|want|need) you to|i'd like you to)\s+)+"
)
_TRAILING = re.compile(
    r"(?:\s+(?:please|now|here|over here|over|back|quickly|for me|to me|thanks|thank you|will you|robot|jarvis))+$"
)
_VERB = re.compile(
    r"^(?:bring|fetch|get|grab|give|hand|find|pick up|pick|take|carry|pass|"
    r"i (?:want|need|would like)|i'd like|go (?:and )?(?:get|fetch|find)|go)\s+"
)
_ME = re.compile(r"^(?:to )?(?:me|us|up)\s+")
_DETERMINER = re.compile(r"^(?:(?:the|a|an|my|that|this|some|any|one|your|our)\s+)+")
_WHERE = re.compile(r"\s+(?:from|on|in|at|off|under|near|next to|that is|which is)\s+.*$")
_INDEFINITE = re.compile(r"\b(?:a|an|any|some)\s+\w")
_SIZES = frozenset({"big", "small", "little", "large"})


class Intent(msgspec.Struct, frozen=True):
    """`item` is the thing as spoken, `label` its name in the scene; `reason` says why there is no intent."""

    kind: Kind
    item: str = ""
    label: str = ""
    reason: str = ""


def normal(text: str) -> str:
    """Lower case, words separated by single spaces, no punctuation."""
    return " ".join(re.sub(r"[^\w' ]+", " ", text.lower().replace("_", " ")).split())


def parse(text: str, scene: Scene) -> Intent:
    """The intent of a sentence; kind `none` with a reason that can be spoken when there is none."""
    whole = _POLITE.sub("", normal(text) + " ").strip()
    words = _TRAILING.sub("", whole)
    controls: tuple[tuple[Kind, frozenset[str]], ...] = (("stop", STOP), ("cancel", CANCEL), ("return", RETURN))
    for kind, phrases in controls:
        if words in phrases or whole in phrases:
            return Intent(kind)
    any_one = _INDEFINITE.search(words) is not None
    for candidate in _things(words):
        label, _ = find_object(candidate, scene, any_one)
        if label:
            exact = scene.object(candidate) is not None
            return Intent("fetch", item=candidate if exact else label, label=label)
    thing = _things(words)[-1]
    return Intent("none", reason=find_object(thing, scene)[1])


def _things(words: str) -> list[str]:
    """Readings of the object part, the most literal first."""
    bare = _DETERMINER.sub("", words)
    without_verb = _DETERMINER.sub("", _ME.sub("", _VERB.sub("", words)))
    readings = [bare, without_verb, _TRAILING.sub("", _WHERE.sub("", without_verb))]
    readings += [" ".join(w for w in readings[-1].split() if w not in _SIZES)]
    return list(dict.fromkeys(readings))


def find_object(thing: str, scene: Scene, any_one: bool = False) -> tuple[str, str]:
    """(scene name, "") of the object meant, else ("", why not); with `any_one` the first of several will do."""
    known = scene.object(thing)
    if known is not None:
        return known.name, ""
    words = thing.split()
    if not words:
        return "", "I did not hear what to bring."
    nouns = _nouns(scene)
    colours = {o.colour for o in scene.objects}
    for split in range(len(words)):
        noun = " ".join(words[split:])
        kind = nouns.get(noun) or nouns.get(noun.removesuffix("s"))
        if kind is None or not set(words[:split]) <= colours:
            continue
        named = [o for o in scene.objects if o.kind == kind and (not split or o.colour in words[:split])]
        if len(named) == 1 or (named and any_one):
            return named[0].name, ""
        if named:
            return "", f"Which {noun}: {_choice(named)}?"
    if len(words) == 2 and words[1] in nouns:
        return "", f"I know no {thing}, only the {_choice([o for o in scene.objects if o.kind == nouns[words[1]]])}."
    return "", f"I do not know what {thing!r} is."


def _nouns(scene: Scene) -> dict[str, str]:
    """Words for kinds of objects: the kinds, and what aliases leave when the colour is taken off."""
    nouns: dict[str, str] = {o.kind: o.kind for o in scene.objects}
    for spec in scene.objects:
        for name in (spec.name, *spec.aliases):
            if name.startswith(f"{spec.colour} "):
                nouns.setdefault(name.removeprefix(f"{spec.colour} "), spec.kind)
    return nouns


def _choice(specs: list[ObjectSpec]) -> str:
    names = [s.name for s in specs]
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} or {names[-1]}"
