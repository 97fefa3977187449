"""Where a thing is that is asked for, told in words of its own: `bring me the duck, it is on the desk`. Pure."""

import re

from common.language.exchange import PREPOSITIONS, first_match, named, verb_first
from common.language.politeness import without_lead, without_politeness

_GUESS = (
    r"(?:(?:i|we) (?:think|believe|guess|reckon|suppose|suspect|bet|would (?:say|guess))(?: that)?|"
    r"i am (?:pretty |quite |fairly )?sure(?: that)?|maybe|perhaps|probably|possibly|presumably|most likely)"
)
"""Words with which somebody says that what follows is a guess."""
_IT_IS = (
    rf"(?:(?:{_GUESS} )?(?:it|they|he|she) "
    r"(?:is|are|(?:should|must|might|could|ought to|(?:is|are) supposed to) be|lies|stands|lives|sits|hangs)"
    r"(?: lying| standing| still| somewhere| probably| perhaps| maybe| possibly| usually| currently)*|"
    r"(?:i|we) (?:(?:think|believe|guess) (?:i|we) )?(?:(?:must|might|may) have |have )?(?:just |last )?"
    r"(?:left|put|saw|dropped|forgot|placed) (?:it|them))"
)
_NOW = r"(?: (?:right |just )?now| at the moment)?$"
_WISH = (
    r"(?:(?:i|we) (?:would |do |really )*(?:need|want|like|love)(?: to (?:have|use|borrow))?|"
    r"(?:can|could|may|might) (?:i|we) (?:please )?(?:have|use|borrow))"
)
_ONE = r"(?P<thing>(?:the|my|a|an|that) [^,]+?)"
_HERE = r"(?P<here> (?:over |back )?here| to me| to us)?(?: please)?,? (?:and )?"
_TO_BE_BROUGHT = re.compile(
    rf"^(?P<asked>(?:{_WISH}|\w+(?: me| us)?) ){_ONE}{_HERE}{_IT_IS} "
    rf"(?P<where>(?:on|in|at|next to|near|beside|under|behind) [^,]+?){_NOW}"
)
"""Something to be brought, and where it is."""
_BRINGS = re.compile(rf"^(?:{_WISH}|(?:get|fetch|grab|collect|bring)(?: me| us)?|\w+ (?:me|us)) $")
"""What asks for a thing to be brought, whatever follows it."""
_TO_BE_PUT = re.compile(
    r"^(?P<said>(?:put|move|take|bring|carry|set|place|lay) (?:the|my|a|an|that) [^,]+?)"
    rf"(?P<to> (?:on|in|into|onto|to|next to|beside) [^,]+?)(?: please)?,? (?:and )?{_IT_IS} (?:on|at) "
    rf"(?P<where>[^,]+?){_NOW}"
)
"""Something to be put somewhere, and where it is. What is in a room may be that place, and is asked about."""
_TO_BE_GOT = re.compile(
    rf"^{_WISH} {_ONE}(?: please)?, (?:get|fetch|grab|bring) (?:me )?it(?: to me| for me)? "
    r"(?P<where>from [^,]+?)(?: please| for me| to me)*$"
)
"""A wish, and from where it is to be fulfilled."""
_WHERE_TO = r"(?P<where>(?:on|in|at|by|near) (?:the|my|our|his|her|their) [^,]+?)"
_PERSON = r"(?P<whom>(?:my|our|the) \w+|(?!(?:me|us|it|them|to|the|my|our|a|an|that)\b)\w+)"
_IS_THERE = r"(?: (?:sitting|standing|lying|waiting|working|busy|resting|over|still|upstairs|downstairs))*"
_BRING = "(?:bring|take|give|get|fetch|hand|pass|carry)"
_THING = r"(?:the|a|an|my|that|some|his|her) [^,]+?"
_FOR_SOMEBODY = tuple(
    re.compile(form)
    for form in (
        rf"^{_BRING} {_PERSON} (?P<thing>{_THING}), (?:and )?(?:he|she|they) (?:is|are){_IS_THERE} {_WHERE_TO}$",
        rf"^{_BRING} (?P<thing>{_THING}) (?:over )?(?:to|for) {_PERSON}, (?:and )?(?:he|she|they) (?:is|are)"
        rf"{_IS_THERE} {_WHERE_TO}$",
        rf"^{_PERSON} (?:is|are){_IS_THERE} {_WHERE_TO}, (?:so |and )?(?:please )?{_BRING} (?:(?:him|her|them) "
        rf"(?P<thing>(?!her ){_THING})|(?P<one>{_THING}) (?:over )?(?:to|for) (?:him|her|them))$",
    )
)
"""Something for somebody, and where that person is."""
_MISSED = re.compile(
    r"^(?:(?P<thing>(?:the|my|our) \w+(?: \w+){0,2}?) (?:is|are|has|have) (?:(?:gone|been) )?(?:gone|missing|vanished|"
    r"disappeared|lost|nowhere(?: to be (?:found|seen))?)|(?:i|we) (?:have |seem to have )?(?:lost|misplaced|mislaid|"
    r"can not (?:find|see)) (?P<lost>(?:the|my|our) [^,]+?))(?: again| somewhere)?, "
    rf"(?:{_GUESS}|{_IT_IS}) (?P<where>(?P<how>on|in|at|behind|near|by|next to|beside|under|beneath|below) "
    r"(?:the|my|our|a|an) [^,]+?),? (?:so |and |but )?(?P<rest>[^,]*\b(?:it|them)\b[^,]*)$"
)
"""A thing that somebody misses, the place where it may be, and a command that points at it by a pronoun."""
_HIDDEN = frozenset({"under", "beneath", "below"})
"""Prepositions of a place that hides a thing from the cameras, so that the place is no help in the search."""
_SENTENCE = re.compile(r"[^.?!;]+(?:[.?!;]+\s*|$)")


def with_whereabouts(text: str) -> str:
    """`can i have the stapler? it is on the desk` as `bring me the stapler on the desk`, also among other sentences."""
    sentences, said = _SENTENCE.findall(text), list[str]()
    while sentences:
        both = f"{sentences[0].rstrip('.?!; ')}, {without_politeness(sentences[1])}" if len(sentences) > 1 else ""
        one = _with_place(both) if both and ", " not in both.partition(", ")[2] else ""
        said.append(one or _with_place(sentences[0]) or sentences[0])
        sentences = sentences[2 if one else 1 :]
    return "".join(said)


def with_what_is_missed(text: str) -> str:
    """`my keys are gone, perhaps on the desk, find them` as `find my keys on the desk`."""
    found = _MISSED.match(", ".join(s.rstrip(".?!;, ") for s in _SENTENCE.findall(without_lead(text))))
    if found is None:
        return text
    thing = found["thing"] or found["lost"]
    sought = re.search(r"\b(?:find|look|search|check|see|where)\b", found["rest"])
    where = found["where"] if sought else from_there(found["where"])
    return named(found["rest"], thing if found["how"] in _HIDDEN else f"{thing} {where}")


def from_there(where: str) -> str:
    """`on the desk` as where something is to be taken from: `from the desk`."""
    return re.sub(r"^(?:on|in|at) ", "from ", where)


def _with_place(sentence: str) -> str:
    """What is to be brought or put, with where it is said to be; "" where that is not said."""
    told = sentence.rstrip(".?!; ")
    bare, end = without_politeness(told), sentence[len(told) :]
    if for_somebody := first_match(_FOR_SOMEBODY, bare):
        thing = for_somebody["thing"] or for_somebody["one"]
        return f"take {thing} to {for_somebody['where'].partition(' ')[2]}{end}"
    if (found := _TO_BE_PUT.match(bare)) and " from " not in found["said"]:
        return f"{found['said']} from {found['where']}{found['to']}{end}"
    if found := _TO_BE_GOT.match(bare):
        return f"bring me {found['thing']} {found['where']}{end}"
    found = _TO_BE_BROUGHT.match(bare)
    if found is None or PREPOSITIONS & set(found["thing"].split()):
        return ""
    wished = _BRINGS.match(found["asked"]) or found["here"]
    if not wished and not verb_first(bare):
        return ""
    return f"{'bring me ' if wished else found['asked']}{found['thing']} {found['where']}{end}"
