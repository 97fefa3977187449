"""Dialect, slang and clipped spellings in the plain spelling of the grammar: `gie me t'wee mug, hen`. Pure.

A speech recogniser and a keyboard write down what they hear. One row is one plain word and its other spellings; only
spellings that are hardly another English word are listed, so that no sentence in plain English changes.
"""

import re

from common.language.verb_classes import classes

_ROWS = (
    # Scotland and Ulster.
    "you ye yez youse", "your yer yir", "to tae", "of o'", "off aff", "with wi'", "from frae fae", "not no'", "now noo",
    "out oot outta", "about aboot", "down doon", "round roond", "house hoose", "hold haud", "holding haudin",
    "give gie",
    "take tak", "make mak", "where whaur", "what whit", "ball baw", "child wean bairn", "head heid", "one yin",
    "could_not couldnae", "can_not cannae", "do_not dinnae dinna", "is_not isnae", "was_not wasnae", "good guid",
    "will_not willnae winnae", "would_not wouldnae", "did_not didnae", "old auld", "give_us gie's gies", "over ower",
    # The north of England.
    "that yon", "something summat", "nothing nowt", "anything owt", "yourself thissen yersen yersel", "you tha",
    "perhaps appen 'appen mebbe", "have 'ave", "here 'ere", "him 'im", "house 'ouse", "hand 'and",
    # America.
    "yellow yella yeller", "little lil li'l", "children younguns", "supposed s'posed", "ahead 'head",
    "around 'round", "about 'bout", "what_have_you whatcha", "come_on c'mon", "you_know y'know", "i_will i'ma",
    "going_to finna", "and an' 'n'", "over_there yonder", "them 'em",
    # Typed in haste, and heard for another word.
    "with w/", "thanks ty thnx", "please pleez plis", "you ewe", "pick_up pickup", "go_to goto",
)  # fmt: skip
_SPELLINGS = {other: plain.replace("_", " ") for row in _ROWS for plain, *others in (row.split(),) for other in others}
_SPELLED = re.compile(
    rf"(?<![\w'])(?:{'|'.join(sorted(map(re.escape, _SPELLINGS), key=len, reverse=True))})(?!\w|'(?!(?:s|d|ll|"
    rf"re|ve)\b))"
)
_PARTICLES = "lah|leh|lor|liao|hor|sia|yaar|innit|eh|och|aye|hinny|ken|na"
"""Sounds behind or before what is said, that only ask for assent."""
_BEHIND = re.compile(rf",? (?:{_PARTICLES})(?=$|[,;.!?])|^(?:{_PARTICLES}|haw),? (?=\w)")
_OF_THE_SPEAKER = re.compile(
    r"\bma (?=\w{3})|^me (?=\w+ (?:is|are|has)\b)"
    r"|(?<=\blost )me (?=\w{3})|(?<=\bleaving )me (?=\w{3})|(?<=\bmislaid )me (?=\w{3})|(?<=\bwhere is )me (?=\w{3})"
)
_HEARD = tuple(
    (re.compile(heard), meant)
    for heard, meant in (
        (r"^((?:please |robot |now |(?:can|could) you )+)but (?=(?:the|my|a|an|that|it)\b)", r"\1put "),
        (r"^wears (?=(?:the|my)\b)", "where is "), (r"^fined (?=(?:the|my)\b)", "find "),
        (r"\bwrite now\b", "right now"), (r"\b(look|looking|search) four (?=\w)", r"\1 for "),
        (r"\b(come|go) bag\b", r"\1 back"), (r"(?<=\w )o (?=(?:the|them)\b)", "of "),
        (r"\b((?:the|my|its|their) (?:\w+ )?\w+) and all[.!]?$", r"\1 too"), (r"(?<=\w) ?'un(s?)\b", r" one\1"),
    )
)  # fmt: skip
"""Words that sound like those of a command and make no sense where they stand."""
_THE = re.compile(r"\bth?'(?=[a-z]{2})")
_WITHOUT_G = re.compile(r"\b(\w{2,})in(?:'(?!\w)|\b)")
"""A verb in -ing with its last sound left out; without an apostrophe, where the rest is a verb that is known."""


def plainly_spelled(text: str) -> str:
    """Normalised text with marks in plain spelling, without particles that only ask for assent."""
    text = _SPELLED.sub(lambda found: _SPELLINGS[found[0]], _BEHIND.sub("", _THE.sub("the ", text)))
    for heard, meant in _HEARD:
        text = heard.sub(meant, text)
    return _WITHOUT_G.sub(_with_g, _OF_THE_SPEAKER.sub("my ", text))


def _with_g(found: re.Match[str]) -> str:
    whole = f"{found[1]}ing"
    return whole if found[0].endswith("'") or (len(found[0]) >= 6 and classes(whole)) else found[0]
