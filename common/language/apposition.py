"""Which one of its kind is meant, said behind a thing: `the can, the red one`, `my ball is gone, the red one`. Pure."""

import re

from common.kinds import KINDS
from common.language.exchange import PREPOSITIONS, IsPlace, filled, noun_phrases, replaced, verb_first
from common.language.lexicon import A_COLOUR, COMMANDING, HANDLING
from common.language.normalise import DETERMINERS
from common.language.noun_phrase import WHICH
from common.language.politeness import without_politeness
from common.naming.names import ALIKE

_REFINEMENT = re.compile(
    r"^(?P<said>[^,]+?)(?:,\s*|\s+)(?:(?:you know|well|that is|please),?\s*)?(?P<one>(?:the|a|an) (?:\w+ ){1,2}one)"
    r"(?P<rest>,?(?: (?:and|on|in|to|into|onto|next|from|off) .*)?)$"
)
"""A thing, and which one of its kind."""
_SMALL = "me us and now where is are not no or what which then ok okay yes also i we you he she they so but want need"
NO_NOUN = frozenset(_SMALL.split()) | COMMANDING | DETERMINERS | PREPOSITIONS
"""Words that no name of a thing has, and those before another thing, which is not the same as the one before."""
_GOES_ON = frozenset({"for", "except", "than", "and", "or", "then", "but", "not", "with", "to", "as"})
_ANY = re.compile(r"\b(an? (\w+)), (?:any|either|whichever)(?: (?:\2|one|of them|will do|you (?:like|want)))?\b")
_WHICH_ONE = re.compile(r"^(?P<one>(?:the|a|an|my) (?:\w+ ){1,2}one)(?:,? (?:and |but )?not (?:the )?\w+(?: one)?)?$")
_ANY_ONE = re.compile(
    r"^(?:any|either|whichever|it does not matter which|i do not (?:mind|care))(?: one| (?:one )?will do)?$"
)


_GOES = r"(?= (?:to|on|onto|in|into|goes|go|for|back)\b)"
_SHARED = re.compile(
    r"\b(?:the|both|two|all|my|our|those|these)(?: (?:two|three|both))? (?P<noun>[a-z]+)s(?:,? please)?[,.;] "
    rf"(?P<rest>(?:the )?{A_COLOUR}(?: one)?{_GOES}.+)$"
)
_SHARING = re.compile(rf"\b(?:the )?({A_COLOUR})(?: one)?{_GOES}")
"""Several of a kind, and where each of them is to go by its colour alone."""
_SECOND = re.compile(
    rf"\b(?P<first>the {A_COLOUR} (?P<noun>[a-z]+)),? (?P<and>and|or) (?:the )?(?P<other>{A_COLOUR})(?: one)?"
    r"(?=$|[,.;!?]| (?:to|on|onto|in|into|too|please|as)\b)"
)
"""Two of a kind by their colours, the second without its noun."""
_LABELLED = re.compile(
    r"^(?:(?:to|into|onto|in|on|for) )?(?:(?:the|my|our) )?(?P<place>\w+(?: \w+){0,2})\s*:\s+"
    rf"(?P<things>(?:(?:the|my|our|an?|all|both|two|every|{A_COLOUR}) [^.;:!?]+|"
    r"\w+(?= and |[.;!?]|$)[^.;:!?]*))(?P<rest>.*)$",
    re.IGNORECASE,
)
"""Things behind the name of the place where they are to go: `toy box: the red ball`."""
_SENTENCE = re.compile(r"[^.;!?]+[.;!?]*\s*|[.;!?]+\s*")
_ROUTE = re.compile(r"^(?P<head>[^:,]{3,40}):\s+(?P<stops>[^.;!?:]+,[^.;!?:]+)[.!]*\s*$")
"""Places one after the other behind what tells that a way follows."""
_BACK = re.compile(
    r"^(?:(?:back|home|here|me)(?: again)?|(?:back |home )?(?:here|home|to me|to us)(?: to me| again)?)$"
)
_IN_ORDER = re.compile(r"^in (?:that|this) order$")
_RUBBISH = frozenset({"rubbish", "trash", "garbage"})


def with_shared_noun(text: str) -> str:
    """`both mugs, the red to the desk` as `the red mug to the desk`, `the red mug and the blue` as two mugs."""
    text = _SECOND.sub(r"\g<first> \g<and> the \g<other> \g<noun>", text)
    if (found := _SHARED.search(text)) is None:
        return text
    return _SHARING.sub(rf"the \1 {found['noun']}", found["rest"])


def put_where_labelled(text: str, is_place: IsPlace) -> str:
    """`toy box: the red ball`, in each sentence, as `put the red ball in the toy box`, `red mug: desk` likewise.

    Of places alone, `three stops: desk, bookshelf, me`, it makes the way to one after the other.
    """
    return "".join(_as_route(s, is_place) or _labelled(s, is_place) for s in _SENTENCE.findall(text.strip())) or text


def _as_route(text: str, is_place: IsPlace) -> str:
    """`the rounds: kitchen, bedroom, back to me` as going to each of them; "" of what is no way."""
    found = _ROUTE.match(text.lower())
    if found is None or not HANDLING.isdisjoint(found["head"].split()) or is_place(tuple(found["head"].split())):
        return ""
    stops = [re.sub(r"^(?:and |then )*", "", stop.strip()) for stop in re.split(r",| and ", found["stops"])]
    ways = [
        "come back" if _BACK.match(stop) else f"go to the {bare}" if is_place(tuple(bare.split())) else ""
        for stop in stops
        if stop and not _IN_ORDER.match(stop)
        for bare in [re.sub(r"^(?:to )?(?:the |my )?", "", stop)]
    ]
    return f"{', then '.join(ways)}. " if len(ways) > 1 and all(ways) else ""


def _labelled(text: str, is_place: IsPlace) -> str:
    found = _LABELLED.match(text)
    place = found["place"].lower() if found else ""
    names = found is not None and DETERMINERS.isdisjoint(place.split())
    if found is None or not names or verb_first(without_politeness(found["things"].lower())):
        return text
    things = re.sub(r",? please$", "", found["things"])
    if place in _RUBBISH:
        return f"throw away {things}{found['rest']}"
    if place.split()[-1] in KINDS and is_place(tuple(things.lower().split())) and not is_place(tuple(place.split())):
        return f"put the {place} on the {things}{found['rest']}"
    return f"put {things} on the {place}{found['rest']}" if is_place(tuple(place.split())) else text


def apposed(text: str) -> str:
    """A text with which one of its kind is meant said at once: `my ball is gone, the red one, find it`.

    A thing that has its colour already is followed by another one; any one is no other one.
    """
    first, *parts = text.split(", ")
    kept, merged = [first], False
    for part in parts:
        if merged and part.split()[0] in PREPOSITIONS:  # "put the mug, the blue one, on the desk"
            kept[-1], merged = f"{kept[-1]} {part}", False
            continue
        merged = False
        words = kept[-1].split()
        begin, end = next(iter(noun_phrases(words)), (0, 0))
        if not verb_first(without_politeness(kept[-1])):  # what is told goes on behind its noun: "my ball rolled off"
            end = min(end, begin + 2)
        end = next((at for at in range(begin + 1, end) if words[at] in DETERMINERS or words[at] in WHICH), end)
        said = words[begin:end]
        if _ANY_ONE.match(part) and said:
            continue
        one = _WHICH_ONE.match(part)
        of_it = (
            one and "not" not in words and end - begin > 1 and "one" not in said and not ALIKE.keys() & set(said[1:-1])
        )
        if one is None or not of_it:
            kept.append(part)
            continue
        name = " ".join(w for w in said[1:] if w not in WHICH)
        kept[-1], merged = " ".join((*words[:begin], one["one"].removesuffix("one").strip(), name, *words[end:])), True
    return ", ".join(kept)


def refined(text: str) -> str:
    """`the can, the red one` as `the red can`."""
    text = _ANY.sub(r"\1", text)
    found = _REFINEMENT.match(text)
    if found is None or found["said"].split()[-1] in _GOES_ON:
        return text
    spans = noun_phrases(found["said"].split())
    if not spans and re.match(r"\w+(?: \w+)?(?: please)?$", found["said"]) and not NO_NOUN & set(found["said"].split()):
        return f"{filled(found['one'], found['said'])}{found['rest'].lstrip(',')}"
    if not spans or spans[-1][1] - spans[-1][0] != 2:
        return text
    rest = found["rest"] if found["rest"].startswith((", and", " and")) else found["rest"].lstrip(",")
    return f"{replaced(found['said'], found['one']) or found['said']}{rest}"
