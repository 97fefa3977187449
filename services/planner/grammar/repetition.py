"""Commands that repeat the last one: `do that again`, `try again`, `and the blue one too`. Pure."""

import re
from collections.abc import Sequence

from common.language.contractions import expand
from common.language.exchange import PREPOSITIONS, IsPlace, filled, noun_phrases, replaced, verb_first, with_thing
from common.language.lexicon import COMMANDING, HANDLING
from common.language.meaning import readings
from common.language.normalise import DETERMINERS, normalise, without_determiners
from common.language.politeness import without_politeness
from common.messages import History

_NO = re.compile(
    r"^(?:(?:no|nope|wrong(?: one| \w+)?|(?:that|it) is (?:the )?wrong(?: one| \w+)?|not (?:this|that)(?: one| \w+)?|"
    r"thanks|thank you|but|sorry|well|oh|ah|hm+|um+) )*"
    r"(?:not (?:on|in|to|into) (?:the|my) \w+ )?(?:i|we) (?:said|meant|mean|wanted|asked for)(?: it| that| "
    r"them)? (?P<rest>.+)$"
    r"|^(?:wait |no |sorry |actually )*make (?:it|that) (?P<made>.+)$"
    r"|^(?:no |nope |wrong |but )*not (?:this|that|here|there)(?: one| \w+)? (?:but )?(?P<other>(?:the|on|in|to|"
    r"into) .+)$"
    r"|^(?:(?:never mind|no|well|ok|okay|then) )*(?P<better>(?:on|in|the) .+?) (?:would (?:be|have "
    r"been) (?:better|nicer|best|preferable)|will do)$"
)
_WRONG = re.compile(r"^(?:that is |it is )?(?:the )?wrong(?: \w+){0,2}$")
"""A clause of its own before what was meant."""
_NO_BARE = re.compile(
    r"^(?:(?:hm+|oh|ah|no|nope|wrong|sorry|actually|rather) )+(?:the |my )?(?P<place>\w+(?: \w+){0,2}?)(?: please)?$"
)
_ELSEWHERE = re.compile(
    r"^(?:try|check|(?:(?:have|take) (?:a|another) )?(?:quick )?(?:look|peek|search)|"
    r"(?:have )?(?:you )?(?:looked|tried|searched)|what about|how about|maybe|perhaps|"
    r"(?:maybe |perhaps |i think )?(?:it|they) (?:is|are|might be|may be|could be|must be|should be))"
    r"(?: (?:in|on|at|inside))? (?:the|my|our) (?P<place>\w+(?: \w+){0,2})$"
)
"""Where else something may be that was not found."""
_LOOK_THERE = re.compile(
    r"^(?:so |then )?(?:go (?:and )?)?(?:look|search|check|try|have a look)(?: over)? there(?: first| too)?$"
)
_BEING_THERE = re.compile(
    r"^(?:(?:right|ok|okay|good|well) )*(?:now|while|since|as|because)(?: that)? you are (?:already |still )?there "
    r"(?:and |so |please )*(?P<rest>.+)$"
)
"""Before what is asked for of a robot where it is."""
_NO_THERE = re.compile(
    rf"^(?:(?:hm+|oh|ah|no|nope|wrong|sorry|actually|rather) )+(?P<place>(?:{'|'.join(sorted(PREPOSITIONS))}) .+)$"
)
_PLACED = re.compile(r"\w (?:next to|beside|near|on|in|into|onto|to|at) \w")
_TOO = re.compile(
    r"^(?!.*\b(?:goes|go|belongs?|is|are|there)\b)(?:and |now |then |do )*(?P<thing>.+?)"
    r" (?:too|as well|also|likewise)(?: please)?$"
    r"|^(?:and|(?:now|next)(?= the| my)|what about|likewise(?= the| my)|do (?:the same|likewise|that|it) (?:for"
    r"|with|to)) (?P<other>.+)$"
)


_QUANTITIES = frozenset({"all", "both", "other", "another", "every", "any"})
"""Words before a noun, beside determiners, with which a thing begins."""


def repeated(command: str, clauses: Sequence[str], told: History, is_place: IsPlace) -> str:
    """The command that is meant, by the last one where it refers to that; else the command as it is."""
    last = told.last.command if told.last is not None else ""
    outcome = told.last.outcome if told.last is not None else ""
    named = clauses[:-1] if clauses[1:] and _LOOK_THERE.match(clauses[-1]) else clauses
    if outcome == "failed" and named and (place := _elsewhere(named[-1], is_place)):
        return _from(normalise(last).split(), place)
    if last and (there := _BEING_THERE.match(expand(normalise(command)))):
        return _from_there(without_politeness(there["rest"]), last, is_place) or command
    asked = clauses[1:] if clauses and _WRONG.match(clauses[0]) else clauses
    if not last or len(asked) != 1:
        return command
    for wording, slots in readings(tuple(re.sub(r" (?:as well|too|also)$", "", asked[0]).split()), "command"):
        if wording.action == "again":
            return (replaced(last, " ".join(slots["thing"]), is_place) or last) if "thing" in slots else last
    if (bare := _NO_BARE.match(expand(normalise(command)))) and is_place(tuple(bare["place"].split())):
        return replaced(normalise(last), f"on the {bare['place']}", is_place) or command
    if elsewhere := _NO_THERE.match(expand(normalise(command))):
        return replaced(normalise(last), elsewhere["place"], is_place) or command
    if (found := _NO.match(expand(normalise(command)))) and (
        (rest := found["rest"] or found["other"] or found["made"] or found["better"]).split()[0]
        in DETERMINERS | PREPOSITIONS
    ):
        return replaced(normalise(last), rest, is_place) or command
    if outcome == "cancelled" and (other := _instead(asked[0], last, is_place)):
        return other
    if found := _TOO.match(without_politeness_at_end(command)):
        thing = found["thing"] or found["other"]
        if found["thing"] and thing.split()[0] in COMMANDING:
            return thing
        if found["other"] and last.split()[0] in HANDLING and _PLACED.search(thing):
            return f"{last.split()[0]} {thing}"
        if thing.split()[0] in DETERMINERS | _QUANTITIES:
            thing, _, place = re.sub(r" off ", " from ", thing).partition(" from ")
            again = replaced(normalise(last), thing, is_place)
            return (_from(again.split(), place) if again and place else again) or command
    return command


def _from_there(asked: str, last: str, is_place: IsPlace) -> str:
    """What is asked for of a robot that has just been sent somewhere, from there; "" where nothing is to be fetched."""
    words = normalise(last).split()
    place = next((words[at:] for at in range(1, len(words)) if is_place(tuple(words[at:]))), [])
    fetched = asked.split()[:1] in (["bring"], ["get"], ["fetch"], ["grab"]) and PREPOSITIONS.isdisjoint(asked.split())
    return _from(asked.split(), " ".join(place)) if place and fetched else ""


def _elsewhere(said: str, is_place: IsPlace) -> str:
    """The place that a clause names as one where something may be; "" if it names none."""
    found = _ELSEWHERE.match(said)
    return found["place"] if found and is_place(tuple(found["place"].split())) else ""


def _from(last: list[str], place: str) -> str:
    """The last command with where its thing is to be looked for."""
    end = next(iter(noun_phrases(last)), (0, len(last)))[1]
    return " ".join((*last[:end], "from the", *without_determiners(tuple(place.split())), *last[end:]))


def _instead(said: str, last: str, is_place: IsPlace) -> str:
    """What is to be done in the place of the `last` command: with another thing, elsewhere, or with the same thing."""
    first, *rest = said.split()
    if first in PREPOSITIONS or (first in DETERMINERS and {"one", "ones"} & set(rest)):
        return replaced(normalise(last), said, is_place) or ""
    spans = noun_phrases(normalise(last).split())
    if not spans or not verb_first(said):
        return ""
    thing = " ".join(normalise(last).split()[slice(*spans[0])])
    if {"one", "ones"} & set(rest):
        return filled(said, thing)
    if not {"it", "them"} & set(rest):
        return ""
    return with_thing(said, normalise(last).split())


def without_politeness_at_end(text: str) -> str:
    """The text from its first word on, which may be "and", without what is polite behind it."""
    words = expand(normalise(text))
    first, _, rest = words.partition(" ")
    return f"{first} {without_politeness(rest)}" if first in ("and", "now", "then") else without_politeness(words)
