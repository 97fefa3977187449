"""A question that no wording covers, read by the thing and the place it names. Pure.

`what number of mugs is there on the desk` comes to `how many mugs are there on the desk`. An answer moves nothing, so
such a reading is answered at once.
"""

import re
from itertools import pairwise

from common.language.lexicon import HANDLING
from common.language.normalise import Words
from services.planner.grammar.chunks import POINTING, Chunk, chunks
from services.planner.grammar.vocabulary import Vocabulary

_QUESTION = re.compile(
    r"^(?:\w+ ){0,3}?(?:where(?! you)|whereabouts|what(?! (?:about|do you say|i|we)\b)|which|who|how many|count|"
    r"whether|^(?:tell|see|say|know|check)(?: me| us)? if\b(?!.* (?:could|can|should)\b)|(?:is|are) there|any "
    r"(?:sign|idea|clue|trace))\b|\bwhere(?:abouts)?$|"
    r"^(?:is|are(?! you\b)|was|were|did|does|has)\b|^(?:do|have) (?:you|we|i) (?!mind\b)|"
    r"^(?:can|could|might) (?:i|we) (?:find|see)\b"
)
"""How questions about the world begin or end."""
_REQUESTED = re.compile(
    r"^(?:is|would|could|will|can|may|might|do|are) .*\b(?:if|that|for) you\b(?! (?:are|were|have|had|did|do)\b)"
)
"""What makes a request of a question: `is it okay if you ...`."""
_BELONGS = re.compile(r"\b(?:should|ought|does|do|is to|supposed)\b.* (?:go|belong|put|kept|live|stored|placed)\b")
_CORRECTS = frozenset({"sorry", "no", "rather", "actually", "wait", "mean", "meant", "correction"})
"""Words between what was said and what was meant."""


def is_asked(words: Words) -> bool:
    """Are the words a question about the world rather than a request in the form of one?"""
    text = " ".join(words)
    return words[0] not in HANDLING and _QUESTION.search(text) is not None and not _REQUESTED.search(text)


def questions(words: Words, vocabulary: Vocabulary) -> list[str]:
    """Plain questions that the words may come to, the likeliest first; [] if they name nothing."""
    found = _meant(words, chunks(words, vocabulary, pronouns=True))
    things = [c.text for c in found if c.kind == "thing"]
    thing = next((t for t in things if t not in POINTING), next(iter(things), ""))
    spot = next((c.text for c in found if c.kind == "spot"), "")
    return _of(thing, spot, " ".join(words)) if thing or spot else []


def _meant(words: Words, found: list[Chunk]) -> list[Chunk]:
    """Without things and places that were taken back: `the red mug sorry the red can`."""
    wrong = [a for a, b in pairwise(found) if a.kind == b.kind and _CORRECTS & set(words[a.end : b.begin])]
    return [chunk for chunk in found if chunk not in wrong]


def _of(thing: str, spot: str, text: str) -> list[str]:
    placed = f" on {spot}" if spot else ""
    if not thing:
        return [f"what is on {spot}"]
    if re.search(r"\bhow many\b|\bnumber of\b|\bcount\b", text):
        return [f"how many {_bare(thing)} are there{placed}"]
    if _BELONGS.search(text):
        return [f"where does {thing} belong", f"where do {_bare(thing)} belong"]
    if re.search(r"\bcolou?r\b", text):
        return [f"what colour is {thing}"]
    if spot and not re.search(r"\b(?:where|whereabouts|which|what)\b", text):
        return [f"is {thing} on {spot}", f"is there {_a(thing)} on {spot}"]
    if re.search(r"\b(?:is|are) there\b|\bany\b", text):
        return [f"is there {_a(thing)}{placed}"]
    return [f"where is {thing}{placed}", f"where are {thing}"]


def _bare(thing: str) -> str:
    return re.sub(r"^(?:the|my|all|any|a|an)(?: the| my)? ", "", thing)


def _a(thing: str) -> str:
    return thing if thing.startswith(("the", "my", "a ", "an ", "any")) else f"a {thing}"
