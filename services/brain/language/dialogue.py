"""Yes, no, or a correction: what an answer to "Did you say ...?" means. Pure."""

import re
from collections.abc import Sequence
from typing import Literal

from common.household import Household
from common.language.meaning import asks_for
from common.language.normalise import normalise, without_determiners

Reply = Literal["yes", "no", "cancel", "correction"]
_CORRECTION = re.compile(r"^(?:no|nope|wrong|not that|i said|i meant|i mean|actually|rather)\s+")


def reply(text: str) -> tuple[Reply, str]:
    """The kind of answer, and for a correction the words without its "no, I said"."""
    rest = normalise(text)
    match asks_for(rest, "yes", "no", "cancel"):
        case "yes":
            return "yes", ""
        case "no":
            return "no", ""
        case "cancel":
            return "cancel", ""
    while (shorter := _CORRECTION.sub("", rest)) != rest:
        rest = shorter
    return "correction", rest


def corrected(command: str, correction: str, household: Household) -> str:
    """The command with its object exchanged for the corrected one; a whole new command replaces it."""
    thing = " ".join(without_determiners(tuple(correction.split())))
    if household.thing(thing) is None:
        return correction
    words = normalise(command)
    names = sorted((n for o in household.things for n in (o.name, *o.aliases)), key=len, reverse=True)
    for name in names:
        if re.search(rf"\b{re.escape(name)}\b", words):
            return re.sub(rf"\b{re.escape(name)}\b", thing, words, count=1)
    return correction


def chosen(answer: str, options: Sequence[str]) -> str | None:
    """The one option that the answer's words single out; "the first" and "the second one" count too."""
    words = set(without_determiners(tuple(normalise(answer).split()))) - {"one", "the", "please"}
    for n, ordinal in enumerate(("first", "second", "third", "fourth")):
        if words == {ordinal} and n < len(options):
            return options[n]
    matching = [o for o in options if words and words <= set(o.split())]
    return matching[0] if len(matching) == 1 else None
