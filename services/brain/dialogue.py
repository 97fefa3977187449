"""Yes, no, or a correction: what an answer to "Did you say ...?" means. Pure."""

import re
from collections.abc import Sequence
from typing import Literal

from common.scene import Scene
from services.brain.intent import CANCEL, normal

Reply = Literal["yes", "no", "cancel", "correction"]
YES = frozenset({
    "yes", "yeah", "yep", "yes please", "yes i did", "correct", "right", "that's right", "that is right", "exactly",
    "sure", "ok", "okay", "go ahead", "do it", "please do", "affirmative",
})  # fmt: skip
NO = frozenset(
    {"no", "nope", "no i did not", "no i didn't", "wrong", "that's wrong", "that is wrong", "negative", "not that"}
)
_LEAD = re.compile(r"^(?:no|nope|wrong|not that|i said|i meant|i mean|actually|rather)\s+")
_DETERMINER = re.compile(r"^(?:the|a|an|my|that)\s+")


def reply(text: str) -> tuple[Reply, str]:
    """The kind of answer, and for a correction the words without its "no, I said"."""
    words = normal(text)
    if words in YES:
        return "yes", ""
    if words in NO:
        return "no", ""
    if words in CANCEL:
        return "cancel", ""
    rest = words
    while (shorter := _LEAD.sub("", rest)) != rest:
        rest = shorter
    return "correction", rest


def corrected(command: str, correction: str, scene: Scene) -> str:
    """The command with its object exchanged for the corrected one; a whole new command replaces it."""
    thing = _DETERMINER.sub("", correction)
    if scene.object(thing) is None:
        return correction
    words = normal(command)
    names = sorted((n for o in scene.objects for n in (o.name, *o.aliases)), key=len, reverse=True)
    for name in names:
        if re.search(rf"\b{re.escape(name)}\b", words):
            return re.sub(rf"\b{re.escape(name)}\b", thing, words, count=1)
    return correction


def chosen(answer: str, options: Sequence[str]) -> str | None:
    """The one option that the answer's words single out; "the first" and "the second one" count too."""
    words = set(_DETERMINER.sub("", normal(answer)).split()) - {"one", "the", "please"}
    for n, ordinal in enumerate(("first", "second", "third", "fourth")):
        if words == {ordinal} and n < len(options):
            return options[n]
    matching = [o for o in options if words and words <= set(o.split())]
    return matching[0] if len(matching) == 1 else None
