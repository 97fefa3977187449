"""When something is to be done: `in a minute go there` as waiting and going, in the order of time. Pure."""

import re

from common.language.exchange import verb_first
from common.language.lexicon import A_WISH, TO_GO
from common.language.politeness import without_politeness
from common.language.quantities import NUMBERS, UNITS

_NUMBER = rf"(?:a|an|and|of|about|around|another|just|maybe|\d+|{'|'.join(NUMBERS)})"
DURATION = rf"(?:{_NUMBER} )+(?:{'|'.join(UNITS)})s?(?: and a half)?"
"""Words of a length of time, as `quantities.duration` reads them."""
THERE = r"(?:when|once|as soon as) you(?: are| have)? (?:got there|get there|(?:(?:in|over|up|down) )?there|arrived?)"
"""Says that something is for when the robot has arrived: `once you are there`."""
_APPROXIMATELY = re.compile(r"\b(?:about|around|another|just|maybe) ")
_LATER = "(?:from now|time|later|on)"
_PASSED = (
    rf"(?:when|once|after|as soon as) (?P<passed>{DURATION}) (?:are|is|have|has)(?: been)? "
    r"(?:up|over|past|passed|gone(?: by)?|elapsed)"
)
_NOT_SOONER = r"(?:,? (?:and )?(?:not|no) (?:a (?:second|moment) )?(?:sooner|earlier|before)(?: please)?[.!]*)?"
_FIRST = re.compile(
    rf"^(?:(?:in|after|wait(?: for)?|give (?:it|me)) (?P<time>{DURATION})(?: {_LATER})?|"
    rf"(?P<later>{DURATION}) {_LATER}|{_PASSED}),? (?:and |then )*(?P<rest>.+?){_NOT_SOONER}$"
)
_JUST = re.compile(rf"^(?:just )?(?P<time>{DURATION}),? (?:and )?then (?P<rest>.+)$")
_LAST = re.compile(
    rf"^(?P<rest>.+?),? (?:(?:in|after) (?P<time>{DURATION})(?: {_LATER})?|(?P<later>{DURATION}) {_LATER}|{_PASSED})"
    rf"{_NOT_SOONER}$"
)
_REMIND = re.compile(
    rf"^(?:(?:in|after) (?P<first>{DURATION})(?: {_LATER})?,? )?remind (?:me|us)(?: (?:in|after) (?P<time>{DURATION})"
    rf"(?: {_LATER})?)?,? (?:to|that|about) (?P<what>.+?)(?: (?:in|after) (?P<last>{DURATION})(?: {_LATER})?)?$"
)
"""What somebody is to be told after a while."""
_YOU = re.compile(r"^you (?:can |could |should |will |may )?")
_WISHED = re.compile(rf"{A_WISH} (?:the|my|an?|some) .+ (?:here|back)$")
_TELL = re.compile(r"^tell me that ")
_WAKE = re.compile(rf"^wake (?:me|us)(?: up)? (?:in|after) (?P<time>{DURATION})(?: {_LATER})?$")
_SPOKEN = re.compile(
    r"\b(?:say|tell|announce|let \w+ know)\b.*\b(?:i|we|he|she|it|they|dinner|lunch|food|mum|dad)\b "
    r"(?:am|is|are|will|shall|leave)\b"
)
"""A speech with a sentence in it, to which a time at the end belongs."""
_TOLD = re.compile(
    rf"^(?P<told>(?:i|we|he|she|it|they|there|my \w+|the \w+)\b(?! (?:wants?|needs?|would|must|should)\b)[^,.]+?)"
    rf"(?:,(?: and| so)*|(?: and)? so) (?=(?:in|after) {DURATION}\b)"
)
"""What is told before a command for later."""
_OURS = re.compile(r"\b(?:my|our)\b")
_PASS = re.compile(rf"^(?:let|allow|do not move)(?: for)? (?P<time>{DURATION})(?: (?:to )?(?:pass|go by|elapse))?$")
_STAY = re.compile(
    rf"^(?:{TO_GO} (?P<to>.+?)(?:,| and| then)* "
    rf"(?=stay|remain|wait|stand))?(?:stay|remain|wait|stand|stop|hang "
    rf"(?:around|about|out)|rest|park|be)"
    rf"(?: (?:there|here))?(?P<place>(?: over)? (?:in|at|by|near|next to|beside) .+?)? for "
    rf"(?P<time>{DURATION})(?P<rest>(?: and| then|,).+)?$"
)  # fmt: skip
"""Going somewhere to stay there for a while."""


def in_time(text: str) -> str:
    """A text with a time in it as its commands in order, with a full stop between them."""
    bare = without_politeness(text)
    if (found := _STAY.match(bare)) and (found["place"] or found["to"]):
        going = f"go {found['to']}" if found["to"] else f"go to{_place(found['place'])}"
        rest = re.sub(r"^(?:,| and| then)+ ?", "", found["rest"] or "")
        return " . ".join(filter(None, (going, f"wait {_plain(found['time'])}", rest)))
    if (told := _TOLD.match(bare)) and (rest := in_time(bare[told.end() :])) != bare[told.end() :]:
        return f"{told['told']} . {rest}"
    if (found := _REMIND.match(bare)) and (time := found["first"] or found["time"] or found["last"]):
        return f"wait {_plain(time)} . say {_OURS.sub('your', found['what'])}"
    if found := _WAKE.match(bare):
        return f"wait {_plain(found['time'])} . say wake up"
    if found := _PASS.match(bare):
        return f"wait {_plain(found['time'])}"
    for pattern in (_FIRST, _JUST, _LAST):
        found = pattern.match(bare)
        rest = _YOU.sub("", without_politeness(found["rest"])) if found else ""
        if found and (verb_first(rest) or _WISHED.match(rest)):
            if pattern is _LAST and _SPOKEN.search(rest):
                continue
            time = next(filter(None, map(found.groupdict().get, ("time", "later", "passed"))))
            return f"wait {_plain(time)} . {_TELL.sub('say ', rest)}"
    return text


def _plain(time: str) -> str:
    return _APPROXIMATELY.sub("", time)


def _place(words: str) -> str:
    return re.sub(r"^(?: over)? (?:in|at|by|near|next to|beside)\b", "", words)
