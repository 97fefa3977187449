"""What is told around a request: what it is about (`the mug lives on the shelf, put it back there`), and how. Pure."""

import re

from common.language.exchange import PREPOSITIONS, IsPlace, first_match, named, verb_first
from common.language.normalise import DETERMINERS
from common.language.place_told import from_there
from common.language.politeness import without_politeness

_THING = r"(?:the|that|this|my|our|your|his|her) (?:[\w']+ ){0,4}?[\w']+"
_STATES = (
    "lives?|sits?|stands?|belongs?|stays?|hangs?|goes|(?:is|are|was|were|has been)(?: usually| normally| always)? "
    "(?:kept|stored|left|lying|sitting|standing)"
)
_KEPT = re.compile(
    rf"^(?:\w+, )?(?P<thing>{_THING})(?<! not) (?:usually |normally |always |really "
    rf")?(?:{_STATES})\b(?P<where>[^,.;!?]*?)"
    r"(?:[,.;!] (?:so |and |but )?| so )(?P<request>[^.;!?]+)[.!]?$"
)
"""Where something has its place, and what is asked for of it."""
_WISHED = re.compile(
    r"^(?:\w+, )?(?:my |our |the |your )?\w+ (?:wants|would (?:like|love)|needs|fancies|is (?:after|asking for)|"
    r"(?:has )?asked for|has been asking for) (?:(?:(?:a|another) (?:quick )?(?:look|go|try|peek) (?:at|with|of)|"
    r"to (?:see|look at|read|use|try|borrow|have|hold|show \w+|play with)) )?"
    rf"(?P<thing>{_THING}(?: (?:on|in|from|at|off) (?:the|my|our) \w+(?: \w+)?)?)(?P<where>)[,.;!] "
    r"(?:so |and )?(?P<request>[^.;!?]+)[.!]?$"
)
"""What somebody else would like to have or see, and what is asked for of it."""
_STILL_THERE = re.compile(
    rf"^(?P<tale>[^.;!?]+?),? (?:but|and|only) (?P<thing>{_THING}) (?:is|are) "
    r"(?:still |yet |just )?(?:lying |standing )?"
    r"(?P<where>(?:on|in|at|under|behind) (?:the|my|our) [^,.;!?]+?)[.;!] (?:so |and )?(?P<request>[^.;!?]+)[.!?]*$"
)
"""A story that ends with where a thing still is, and a command that points at the thing by a pronoun."""
_ROOM_TOLD = re.compile(r"\b(?:in|into|from|through) (?P<room>(?:the|my|our) \w+(?: room)?)\b")
_BROUGHT = re.compile(
    r"^(?:please )?(?:bring|fetch|get|carry) (?:it|them)(?: back)?"
    r"(?: (?:through|over|along|across|down|up|here|in|to me))*$"
)
_HANDLED = re.compile(r"^(?:just |please |then )*[a-z]+ (?:it|them)\b")
"""A request that begins with a verb, be it unknown, and what it points at."""
_BACK_THERE = re.compile(r"\b(?:back )?(?:(?:in|on|at|to) )?(?:over )?t?here\b")
_AT = re.compile(
    r"^(?:\w+, )?(?:i|we|she|he|they|my \w+|the \w+) (?:am|are|is|will be) (?!not\b)[^,.;!?]*?\b(?:at|on|in|by) "
    r"(?P<place>(?:the|my|our) \w+(?: \w+)?)[,.;!] (?:so |and )?(?P<request>[^.;!?]*?)(?:,? please)?[.!]?$"
)
"""Where somebody is, and what is asked for to be there."""
_FOR_ME = (
    r"(?:(?:can|could|would|will) you )?(?:please )?(?:bring|get|fetch|give|hand) (?:me|us) "
    r"(?P<thing>[^,.;!?]+?)(?:,? please)?"
)
_ASKER_AT = (
    re.compile(
        rf"^(?:\w+, )?(?:i|we) (?:am|are) (?P<where>(?:at|on|in|by) (?:the|my|our) \w+(?: \w+)?)[,.;!] "
        rf"(?:so )?{_FOR_ME}[.!?]*$"
    ),
    re.compile(
        rf"^{_FOR_ME}[,.;!?] (?:i|we) (?:am|are) (?P<where>(?:at|on|in|by) (?:the|my|our) \w+(?: \w+)?)(?: now)?[.!]*$"
    ),
)
"""Something to be brought, and where the one is who asks for it."""
_MANNER = re.compile(
    r"[,.;!]+ (?:and |but )?(?:(?:very |ever so )?(?:gently|carefully|slowly|quietly|quickly|softly)|careful(?: now)?|"
    r"(?:mind|watch) (?:the|your|my|our|out for the) \w+|watch out|easy does it|chop chop)(?:,? please)?[.!]*$"
)
"""How, said by itself behind a request."""
_AND_NOT = re.compile(r"(?<=\w) (?:and|but) not (?=(?:the|my|our) \w+(?:$|[,.;!]))")
"""What something is set against: `in the bin and not the recycling`."""
_TAKEN_THERE = re.compile(
    r"\b(?:take|carry|move|transfer) (?P<thing>(?:the|my|our|that|this) [^,.;!?]+?) (?P<there>(?:over |back )?there)\b"
)
_ALIKE = re.compile(
    r"\b(?P<head>[\w']+),? (?:that|which|who) (?:looks?|is shaped|is painted|is made to look)"
    r"(?: (?:a bit|a little|just|sort of|kind of|rather))? like (?P<other>(?:an?|the|some) \w+)"
)
_ANYTHING = frozenset({"thing", "one", "something", "object", "item"})
_NEEDED = re.compile(r"^(?P<why>[\w' ]{3,}): (?P<thing>(?:(?:the|my|our|an?|some) )?[\w']+(?: [\w']+)?),? please[.!]*$")
"""Why, and the thing that is wanted: `the doctor is coming: stethoscope, please`."""


def with_preamble(text: str, is_place: IsPlace) -> str:
    """The request with the names that were told before it; texts without such stay."""
    text = _TAKEN_THERE.sub(r"put \g<thing> \g<there>", _AND_NOT.sub(", not ", _MANNER.sub("", text)))
    text = _ALIKE.sub(lambda found: _named(found["head"], found["other"]), text)
    for pattern in (_KEPT, _WISHED):
        told = pattern.match(text)
        asked = without_politeness(told["request"]) if told else ""
        if told and (verb_first(asked) or _HANDLED.match(asked)):
            if _BROUGHT.match(asked):
                return f"bring me {told['thing']}"
            where = told["where"].strip()
            request = _BACK_THERE.sub(where, asked, count=1) if where else asked
            if (whole := named(request, told["thing"])) != request:
                return whole
    if (told := _STILL_THERE.match(text)) and _HANDLED.match(asked := without_politeness(told["request"])):
        rooms = _ROOM_TOLD.findall(told["tale"])
        where = re.sub(r"\bin there$", f"in {rooms[-1]}" if rooms else "", told["where"]).strip()
        return named(asked, f"{told['thing']} {from_there(where)}")
    if asker := first_match(_ASKER_AT, text):
        known = is_place(tuple(w for w in asker["where"].split()[1:] if w not in DETERMINERS))
        if known and PREPOSITIONS.isdisjoint(asker["thing"].split()):
            return f"take {asker['thing']} to {asker['where'].partition(' ')[2]}"
    if (at := _AT.match(text)) and verb_first(without_politeness(at["request"])):
        known = is_place(tuple(w for w in at["place"].split() if w not in DETERMINERS))
        if known and _BACK_THERE.search(at["request"]):
            return _BACK_THERE.sub(f"to {at['place']}", at["request"], count=1)
    if (needed := _NEEDED.match(text)) and not verb_first(needed["why"]) and not is_place(tuple(needed["why"].split())):
        return f"bring me {needed['thing']}"
    return text


def _named(head: str, other: str) -> str:
    """What is said to look like something has a name of its own, or that one's."""
    return other.split()[-1] if head in _ANYTHING else head
