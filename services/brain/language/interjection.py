"""What is said to a robot that is at work: stop, something for later, something else instead, or a question. Pure."""

import re
from collections.abc import Sequence
from typing import Literal

import msgspec

from common.language.clauses import without_fillers
from common.language.contractions import expand
from common.language.contrasts import NOT_WANTED, contrasted, instead
from common.language.exchange import PREPOSITIONS, verb_first
from common.language.lexicon import COMMANDING
from common.language.meaning import asks_for, is_question
from common.language.normalise import DETERMINERS, infinitive, normalise
from common.language.politeness import without_politeness
from common.language.wording import Action
from services.brain.language.senses import AT_WORK
from services.brain.language.turns import AFTER_DOING, INSTEAD, INSTEAD_END, LATER, LATER_END

Kind = Literal["stop", "cancel", "come_back", "queue", "replace", "aside", "encouragement", "idle"]
SURE, FIRM = 0.35, 0.8
"""Least probability of a sense that no wording says, and of another than a wording or a verb in front says (chosen on
lists left out)."""
_SAME = {"stop": "cancel", "replace": "come_back"}
"""Kinds that say more than a sense of the model."""


_RATHER = re.compile(r"^(?:actually |in fact )?(?:i|we) would (?:rather|prefer|sooner)\b")
_MADE = re.compile(
    r"^(?:(?:no|oh|actually|sorry),? )*(?:make (?:it|that)|"
    r"i (?:meant|mean|said)(?: to say)?) (?:the|a|an|my|on|in|two|both) "
)
_CHANGED = re.compile(r"^(?:(?:no|oh|actually|i have changed my mind|on second thoughts?),? )+")
_ONE_MOMENT = re.compile(
    r"^(?:(?:hold on|hang on|wait|stop)(?: (?:a|one|just a|for a))?|one|just a) "
    r"(?:second|sec|moment|minute|bit|tick)(?:,? (?:the|my|there|i|someone|somebody) .+)?$|^(?:wait|hold "
    r"on|hang on)(?:,? (?:wait|hold on|hang on))*$"
)
_WARNED = re.compile(
    r"^(?:(?:be |please )?careful|easy|steady|whoa|hey|oi|oh|no|(?:look|watch) out|(?:watch|mind) (?:the|your|my))\b"
    r"|^(?!(?:and|or|if|when|once|after|before|as|until|while|then|so)\b)(?:\w+ ){1,4}?(?:is|are|has|have)\b"
    r"|^(?:the|my|our|a) \w+'s \w+ing\b"
)
"""A warning, or what is told of somebody or something: `mind the cat`, `the baby is in front of you`."""
_NO_LONGER = re.compile(r"^(?:i|we) (?:do not|no longer) (?:need|want) [^,]+?(?: (?:any ?more|after all|now))?$")
_CALLED_OFF = re.compile(
    r"^(?:(?:i|we) )?(?:have )?(?:just |already )?found (?:it|them|one|him|her)\b(?!.* but\b)|"
    r"^(?:[^,]+, )?(?:(?:it|they) (?:was|were)|(?:i|we) had (?:it|them)) .*\b(?:all along|the whole time)$|"
    r"^(?:[^,]+, )?(?:it )?turns out (?:that )?(?:(?:it|they) (?:was|were)|(?:i|we) (?:had|have) (?:it|them)) |"
    r"^(?:cancel|abort|scrap|skip|forget|never mind)(?: about)? (?:the|that|my) (?!.*\b(?:rule|name)\b)\w+(?: \w+)?$"
)
"""What was asked for is not wanted; there is nothing in its place."""


_SLIP = re.compile(
    r"^(?P<wrong>\w+(?: \w+){0,2}),? (?:no|sorry|wait)\b,? (?:(?:no|sorry|wait|i mean),? )*(?:the "
    r"|my )?(?P<right>\w+(?: \w+)?)$"
)
"""A part of the command under way, and what is meant in its place: `desk, no, sorry, bedside table`."""
_FORBIDDEN = re.compile(
    r"^(?:(?:no|please|oh|wait|actually),? )*(?:(?:(?:do not|never|(?:there is )?no need to|you need not|"
    r"you do not (?:need|have) to) (?P<verb>\w+)|(?:quit|stop|no need for) (?P<doing>(?!bring\b)\w+ing))\b(?P<what>.*)"
    r"|leave (?P<left>it|that|them|(?:the|my) \w+(?: \w+)?)"
    r"(?: (?:alone|be|there|here|(?:where|as) (?:it|they) (?:is|are)))?)$"
)
"""What is to be left undone or untouched."""
_NEWS = re.compile(r"^(?:i|we|he|she|they|it|there|somebody|someone) (?!(?:goes|has to)\b)\w+")
_WISH = re.compile(r"\b(?:want|need|like|love|prefer|rather|mean|meant|said|wanted|asked|would|could|should|must)\b")
"""What somebody tells, and what makes a wish of it."""


_POINTING = frozenset({"it", "that", "this", "them", "those", "anything", "one"})
_ALL = re.compile(r"\b(?:tidy|clean|clear|empty|sort|all|every|everything)\b")
"""Commands of which one thing can be spared."""
_SMALL = DETERMINERS | PREPOSITIONS | {"me", "us", "and"}
_PARTICLES = frozenset({"up", "down", "away", "back"})
"""What goes with the verb of a command under way: tidied up, put away."""


class Interjection(msgspec.Struct, frozen=True):
    """`text`: the command or question without the words that say when.

    An encouragement asks for neither, and what is idle is not meant for the robot.
    """

    kind: Kind
    text: str


_THING_ALONE = re.compile(
    r"^(?:the|my|our) (?!.*\b(?:is|are|can|could|should|must|has|goes|go|too|first)\b)\w+(?: \w+){0,2}$"
)
"""A thing for which no verb is said, so that the same is to be done with it: `then the blue block`."""
_LEFT = re.compile(r"^(?:just |please )?leave (?:it|that|them|the|my|this)\b[^,]*$")
"""What is to stay where it is, behind a word that stops: `don't! leave the apple`."""


def interjection(said: str, doing: str = "") -> Interjection:
    """What a sentence means to a mission under way: by its wording, or as it is most likely meant.

    `doing`: the command under way, which a sentence that forbids something of it calls off.
    """
    found, least = by_wording(said, doing)
    decided = found.kind in ("stop", "encouragement") or _FORBIDDEN.match(_words(said))
    if decided or asks_for(said, "stop", "cancel", "come_back"):
        return found
    sense, p = AT_WORK.likeliest(said, doing, found.kind)
    if p < least or found.kind in (sense, _SAME.get(sense)):
        return found
    return Interjection("cancel" if sense == "stop" else sense, said)  # type: ignore[arg-type]


def by_wording(said: str, doing: str = "") -> tuple[Interjection, float]:
    """The same by the wordings alone, and how likely another sense has to be, to count.

    A command without a word about when is for later.
    """
    words = _words(said)
    if (found := _worded(said, words, doing)) is not None:
        return found, FIRM
    if is_question(said):
        return Interjection("aside", said), SURE
    plainly = without_politeness(words)
    return Interjection("queue" if plainly else "encouragement", said), FIRM if verb_first(plainly) else SURE


def _words(said: str) -> str:
    return without_fillers(expand(re.sub(r"[.;!?]+", ",", normalise(said, ",.;!?")).strip(" ,")))


def _worded(said: str, words: str, doing: str) -> Interjection | None:
    """What the words about when, or against what is under way, make of it; None without such."""
    found = _control(said, words) or _replacement(said, words, doing)
    if found is None and (later := _behind(words, doing)):
        return Interjection("queue", later)
    return found or _timed(said, words)


def _control(said: str, words: str) -> Interjection | None:
    """A sentence that stops or calls off what is under way."""
    now: tuple[Action, ...] = ("stop", "cancel") if LATER.match(words) else ("stop", "cancel", "come_back")
    if control := asks_for(said, *now):
        return Interjection(control, said)  # type: ignore[arg-type]
    if _stopped_in_part(words):
        return Interjection("stop", said)
    first, _, reason = words.partition(", ")
    if (_is_news(reason) or _LEFT.match(reason)) and (control := asks_for(first, "stop", "cancel")):
        return Interjection(control, said)  # type: ignore[arg-type]
    if _waits_behind_a_warning(words):
        return Interjection("stop", said)
    if "here" in reason.split() and not verb_first(reason) and asks_for(first, "come_back"):
        return Interjection("come_back", first)
    if _called_off_in_part(words):
        *_, last = words.split(", ")
        if _THING_ALONE.match(bare := without_politeness(last)):
            return Interjection("replace", bare)
        return Interjection("cancel", said)
    return Interjection("stop", said) if _waits(words) else None


def _stopped_in_part(words: str) -> bool:
    """Is the last part a stop, or one among warnings: `oi, brakes on, the baby is on the floor`?"""
    parts = words.split(", ")
    others = [part for part in parts if not asks_for(part, "stop")]
    return parts[-1] not in others or (len(others) < len(parts) and _warn(others))


def _waits_behind_a_warning(words: str) -> bool:
    """`mind the cat, hang on`: is it to wait, for what the parts before tell of?"""
    *told, last = words.split(", ")
    return bool(told) and _warn(told) and _waits(last)


def _warn(parts: Sequence[str]) -> bool:
    """Is each part a warning, or news?"""
    return all(_WARNED.match(part) or _is_news(part) for part in parts)


def _waits(words: str) -> bool:
    return any(_ONE_MOMENT.match(text) for text in (words, without_politeness(words)))


def _called_off_in_part(words: str) -> bool:
    """Does a part call off what is under way, while no other asks for anything: `got them, you can leave it`?"""
    parts = [without_politeness(part) for part in words.split(", ")]
    off = [bool(asks_for(part, "cancel") or _CALLED_OFF.match(part)) for part in parts]
    others = [part for part, is_off in zip(parts, off, strict=True) if not is_off]
    return any(off) and not any(verb_first(part) and not part.startswith("got ") for part in others)


def _replacement(said: str, words: str, doing: str) -> Interjection | None:
    """A sentence that puts something, or nothing, in the place of what is under way."""
    if (slip := _SLIP.match(words)) and set(slip["wrong"].split()) <= set(doing.split()) | DETERMINERS:
        return Interjection("replace", f"i meant the {slip['right']}")
    if unwanted := NOT_WANTED.match(words):
        return Interjection("replace", words[unwanted.end() :])
    if _NO_LONGER.match(words) or _CALLED_OFF.match(_CHANGED.sub("", words)):
        return Interjection("cancel", said)
    if meant := instead(re.sub(r"^(?:no|and),? ", "", words)):
        return Interjection("replace", meant)
    if forbidden := _forbidden(words, doing):
        return forbidden
    if (
        words.startswith("not ")
        or (words.startswith("do not ") and contrasted(words) != words)
        or _RATHER.match(words)
        or _MADE.match(words)
    ):
        return Interjection("replace", INSTEAD_END.sub("", said))
    return None


def _timed(said: str, words: str) -> Interjection | None:
    """A command with words that say when: instead of what is under way, or after it."""
    for kind, begin, end in (("replace", INSTEAD, INSTEAD_END), ("queue", LATER, LATER_END)):
        rest = words
        while (shorter := begin.sub("", rest)) != rest:
            rest = shorter
        bare = end.sub("", rest)
        if kind == "replace" and bare != words and _is_news(bare):
            return Interjection("cancel", said)  # "never mind, I found it"
        if bare and bare != words:
            more = kind == "queue" and _THING_ALONE.match(without_politeness(bare)) and not words.startswith("no")
            return Interjection(kind, f"and {bare}" if more else bare)  # type: ignore[arg-type]
    return None


def _behind(words: str, doing: str) -> str:
    """`come back` of `once you have tidied the desk come back` while the desk is tidied; "" of other words."""
    found = AFTER_DOING.match(words)
    if found is None:
        return ""
    said, rest = set(doing.split()) - _SMALL, found["rest"].split()
    at = int(infinitive(rest[0], COMMANDING) in COMMANDING and (rest[0].endswith("ing") or bool(found["you"])))
    about = {infinitive(rest[0], COMMANDING)} & said
    of_it = said | _SMALL | _POINTING | _PARTICLES
    while at < len(rest) and (bare := rest[at].strip(",")) in of_it:
        about |= {bare} & said
        at += 1
        if rest[at - 1].endswith(","):
            break
    while 0 < at < len(rest) and rest[at - 1] in DETERMINERS:
        at -= 1
    return " ".join(rest[at:]) if about else ""


def _forbidden(words: str, doing: str) -> Interjection | None:
    """What follows for the command under way from words that forbid, and nothing else, a part of it or all of it."""
    found = _FORBIDDEN.match(words)
    if found is None or contrasted(words) != words:
        return None
    what = (found["left"] or found["what"]).replace(",", "").split()
    verb = infinitive(found["verb"] or found["doing"] or "leave", COMMANDING)
    if verb not in COMMANDING | {"touch"} or verb in ("drop", "tell", "wait"):
        return None
    shared = (set(doing.split()) - _SMALL).intersection(what)
    if what and not shared and _ALL.search(doing) and what[0] in DETERMINERS and PREPOSITIONS.isdisjoint(what):
        return Interjection("replace", f"{doing} except {' '.join(what)}")
    if what and not shared and _POINTING.isdisjoint(what):
        return None
    return Interjection("cancel", words)


def _is_news(text: str) -> bool:
    """Does somebody tell something, `i found it`, and wish nothing?"""
    return _NEWS.match(text) is not None and not _WISH.search(text)
