"""A command read by its parts alone, in whatever order and words: verb, thing, where from, where to. Pure.

`could the red can find its way to the dresser` names a thing and a place behind "to", so it comes to `put the red can
on the dresser`. Nothing of it is carried out unasked.
"""

import re
from itertools import pairwise
from typing import Literal, NamedTuple

from common.language.exchange import filled
from common.language.frame import SMALL_TALK
from common.language.lexicon import HANDLING
from common.language.mood import is_of_others
from common.language.normalise import Words
from common.language.timing import DURATION
from common.language.verb_classes import VerbClass, classes
from services.planner.grammar.chunks import POINTING, Chunk, chunks
from services.planner.grammar.vocabulary import Vocabulary

Role = Literal["", "to", "at", "from", "near"]
_ROLES: dict[str, Role] = {
    **dict.fromkeys(("to", "into", "onto", "towards", "toward"), "to"),
    **dict.fromkeys(("in", "on", "at", "inside", "upon", "within"), "at"),
    **dict.fromkeys(("from", "off", "of"), "from"),
    **dict.fromkeys(("by", "near", "beside", "alongside", "next", "close", "with", "against"), "near"),
}  # fmt: skip
"""What a preposition makes of the thing or place behind it."""
_LOOK_BACK = 3
"""Words before a thing or a place among which its preposition is looked for (chosen: `right next to`)."""
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
_MOVING: frozenset[VerbClass] = frozenset({"put", "bring", "discard", "wish", "tidy"})
_PLACES: tuple[Role, ...] = ("from", "at", "to")
_HERE = frozenset({"me", "us", "here", "i", "we", "my", "mine", "our"})
_AWAY = re.compile(r"\b(?:away|belongs?|lives?|(?:its|their|right|proper) (?:place|spot|home|places)|put up)\b")
_UNTIDY = re.compile(
    r"\b(?:mess\w*|tidy|tidied|tidier|clean\w*|clear\w*|order|orderly|untidy|dirty|clutter\w*|neat\w*|chaos|tip|"
    r"pigsty|presentable|spotless|nice|junk|space|room on|ready)\b"
)
"""Words for how a surface is or is to be."""
_SAID = re.compile(r"\bthat (\w+ .+)$")
_YOU = re.compile(r"\byour?\b|\byourself\b")
_BELONGS = re.compile(r"\b(?:should|ought|does|do|is to|supposed)\b.* (?:go|belong|put|kept|live|stored|placed)\b")
_CORRECTS = frozenset({"sorry", "no", "rather", "actually", "wait", "mean", "meant", "correction"})
"""Words between what was said and what was meant."""
_MODALS = (
    "would should could can may might must shall will has needs ought wants belongs goes deserves coming going getting "
    "ending"
)
_AS_SUBJECT = frozenset(_MODALS.split())
"""Words behind a thing that is to do something itself: `the bottle would look nicer on the dresser`."""
_GONE = re.compile(r"\b(?:gone|disappear|vanish|leave|out of (?:here|sight|the way))\b")
_BACK = re.compile(r"\b(?:here|back|home|to me)\b")
_FOR = re.compile(rf"\b(?:for|let|another) ({DURATION})\b")
_TOLD = re.compile(r"^(?:the|my|our|that|this|a|an)\b(?!.*\bplease\b).* (?:is|are|was|were)\b")
"""What is told of a thing, where no verb asks for anything."""
_OUT = re.compile(r"\b(?:away|out|rid|rubbish|trash|garbage)\b")


class _Parts(NamedTuple):
    """`verbs`: all that its verbs can ask for; `bare`: no other word than polite and small ones is said.

    `subject`: the first thing is what is to do something.
    """

    text: str
    verbs: frozenset[VerbClass]
    things: list[str]
    beside: str
    spots: dict[Role, str]
    here: bool
    bare: bool
    subject: bool


def by_roles(words: Words, vocabulary: Vocabulary) -> list[str]:
    """Plain commands or questions that the words may come to, the likeliest first; [] if they name none."""
    parts = _parts(words, vocabulary)
    return _questions(parts) if is_asked(words) else _requests(parts)


def is_asked(words: Words) -> bool:
    """Are the words a question about the world rather than a request in the form of one?"""
    text = " ".join(words)
    return words[0] not in HANDLING and _QUESTION.search(text) is not None and not _REQUESTED.search(text)


def _parts(words: Words, vocabulary: Vocabulary) -> _Parts:
    found = _meant(words, chunks(words, vocabulary, pronouns=True))
    inside = {at for chunk in found for at in range(chunk.begin, chunk.end)}
    others = [w for at, w in enumerate(words) if at not in inside]
    masked = tuple("_" if at in inside else word for at, word in enumerate(words))
    verbs = frozenset[VerbClass]().union(*(_asked(masked, at) for at in range(len(words)) if at not in inside))
    spots: dict[Role, str] = {}
    things: list[str] = []
    beside = ""
    for number, chunk in enumerate(found):
        role = _role(words, chunk, found[number - 1].end if number else 0)
        if chunk.kind == "spot":
            spots.setdefault("to" if role == "at" and "at" in spots else role, chunk.text)
        elif role == "near" and (things or number == 0) and not beside:
            beside = chunk.text
        elif things and " one" in chunk.text:
            things[-1] = filled(chunk.text, things[-1])
        elif chunk.text not in things and not (things and chunk.text in POINTING):
            things = [*(t for t in things if t not in POINTING), chunk.text]
    here, bare = bool(_HERE & set(others)), SMALL_TALK.issuperset(others)
    first = next((c.end for c in found if c.kind == "thing"), len(words))
    subject = bool(_AS_SUBJECT & set(words[first : first + 1]))
    return _Parts(" ".join(words), verbs, things, beside, spots, here, bare, subject)


def _asked(words: Words, at: int) -> frozenset[VerbClass]:
    """What the robot can be asked for by a word; of what others do, only what they wish."""
    found = classes(words[at])
    return found & {"wish", "seek"} if found and is_of_others(words, at) else found


def _meant(words: Words, found: list[Chunk]) -> list[Chunk]:
    """Without things and places that were taken back: `the red mug sorry the red can`."""
    wrong = [a for a, b in pairwise(found) if a.kind == b.kind and _CORRECTS & set(words[a.end : b.begin])]
    wrong += [b for a, b in pairwise(found) if {"than", "instead"} & set(words[a.end : b.begin])]
    return [chunk for chunk in found if chunk not in wrong]


def _role(words: Words, chunk: Chunk, since: int) -> Role:
    for at in range(chunk.begin - 1, max(since, chunk.begin - _LOOK_BACK) - 1, -1):
        if words[at] == "where":
            return "near"
        if words[at] in _ROLES:
            near = at and words[at] == "to" and words[at - 1] in ("next", "close")
            return "near" if near else _ROLES[words[at]]
    return ""


def _questions(parts: _Parts) -> list[str]:
    thing, text = next(iter(parts.things), parts.beside), parts.text
    spot = next(iter(parts.spots.values()), "")
    placed = f" on {spot}" if spot else ""
    if not thing and not spot:
        return []
    if thing and re.search(r"\bhow many\b|\bnumber of\b|\bcount\b", text):
        return [f"how many {_bare(thing)} are there{placed}"]
    if thing and _BELONGS.search(text):
        return [f"where does {thing} belong", f"where do {_bare(thing)} belong"]
    if thing and re.search(r"\bcolou?r\b", text):
        return [f"what colour is {thing}"]
    if thing and spot and not re.search(r"\b(?:where|whereabouts|which|what)\b", text):
        return [f"is {thing} on {spot}", f"is there {_a(thing)} on {spot}"]
    if thing and re.search(r"\b(?:is|are) there\b|\bany\b", text):
        return [f"is there {_a(thing)}{placed}"]
    if thing:
        return [f"where is {thing}{placed}", f"where are {thing}"]
    return [f"what is on {spot}"]


def _requests(parts: _Parts) -> list[str]:
    """The commands for what the words name, by the verbs among them."""
    said = _SAID.search(parts.text) if "say" in parts.verbs else None
    found = [f"say {said[1]}"] if said else []
    if parts.things:
        found += _handling(parts, " and ".join(parts.things))
    elif parts.spots:
        found += _there(parts, next(iter(parts.spots.values())))
    elif "go" in parts.verbs and _BACK.search(parts.text):
        found.append("come back")
    elif "look" in parts.verbs:
        found.append("look around")
    elif (time := _FOR.search(parts.text)) or "wait" in parts.verbs:
        found.append(f"wait {time[1]}" if time else "wait")
    return list(dict.fromkeys(found))


def _handling(parts: _Parts, thing: str) -> list[str]:
    """What can be asked of a thing."""
    verbs, text = parts.verbs, parts.text
    from_, at, to = (parts.spots.get(role, "") for role in _PLACES)
    placed = thing not in POINTING
    source = from_ or (at if to or "discard" in verbs else "")
    whence = f" on {source}" if source and placed else ""
    goal = to or ("" if parts.here and "put" not in verbs else at) or parts.spots.get("", "")
    located = f"{thing} from {from_ or at}" if (from_ or at) and placed else thing
    moves = bool(verbs & _MOVING)
    likely: tuple[tuple[bool, str], ...] = (
        ("discard" in verbs and not goal and bool(_OUT.search(text)), f"throw away {thing}{whence}"),
        (parts.subject and not to and bool(_GONE.search(text)), f"throw away {thing}{whence}"),
        (bool(goal) and (not verbs or moves or parts.subject), f"put {thing}{whence} on {goal}"),
        (
            bool(parts.beside) and ("put" in verbs or " where " in text or parts.subject),
            f"put {thing} next to {parts.beside}",
        ),
        (moves and bool(_AWAY.search(text)), f"put {thing} away"),
        ("seek" in verbs and "bring" not in verbs, f"find {thing}"),
        ("discard" in verbs and not parts.here, f"throw away {thing}"),
        (bool(verbs & {"bring", "wish"}) and (parts.here or "hold" not in verbs), f"bring me {located}"),
        ("hold" in verbs, f"pick up {located}"),
        ("tidy" in verbs, f"put {thing} away"),
        ((parts.here or parts.bare) and not _TOLD.match(text), f"bring me {located}"),
    )
    return [command for fits, command in likely if fits]


def _there(parts: _Parts, spot: str) -> list[str]:
    """What can be asked of a place where no thing is named."""
    verbs = parts.verbs
    wait = " and wait" if "wait" in verbs else ""
    likely = (
        ("tidy" in verbs or bool(_UNTIDY.search(parts.text)), f"tidy up {spot}"),
        ("go" in verbs or ("wish" in verbs and bool(_YOU.search(parts.text))), f"go to {spot}{wait}"),
        ("yourself" in parts.text, f"go to {spot}"),
        (bool(verbs & {"look", "seek"}), f"look at {spot}"),
        (bool(wait) or (not verbs and (parts.bare or "to" in parts.spots)), f"go to {spot}{wait}"),
    )
    return [command for fits, command in likely if fits]


def _bare(thing: str) -> str:
    return re.sub(r"^(?:the|my|all|any|a|an)(?: the| my)? ", "", thing)


def _a(thing: str) -> str:
    return thing if thing.startswith(("the", "my", "a ", "an ", "any")) else f"a {thing}"
