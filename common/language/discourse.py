"""A text as the commands that it asks for, in the order in which they are to be done.

Orders of time ("before you ...", "after you have ...") are worked out here, repairs and contrasts in repairs.py; what a
clause asks for is none of it. Pure.
"""

import re

from common.language.apposition import put_where_labelled, with_shared_noun
from common.language.breaks import with_breaks, without_purpose
from common.language.clauses import cut_clauses, without_fillers
from common.language.conditional import conditional
from common.language.contractions import expand
from common.language.exchange import IsPlace, verb_first
from common.language.lexicon import A_VERB, A_WISH, COMMANDING, HANDLING, TO_GO
from common.language.normalise import DETERMINERS, infinitive, normalise
from common.language.noun_phrase import NUMBERS
from common.language.place_told import with_what_is_missed, with_whereabouts
from common.language.politeness import without_politeness
from common.language.preamble import with_preamble
from common.language.repairs import begun_anew, settled
from common.language.speeches import LONG_SPEECH, as_speech
from common.language.timing import THERE, in_time

_FIRST = re.compile(
    r"^(?P<word>after|once|when|as soon as|before) (?:you(?: are| have)?(?: all)?(?: done| finished)? |(?=\w+ing\b))"
    r"(?P<rest>.+)$"
)
_OFF = (
    r"never ?mind|forget (?:about )?(?:it|that)|(?:cancel|scrap|skip) (?:it|that)|do not bother"
    r"|(?:i|we) (?:have )?changed (?:my|our) minds?"
    r"|(?:i|we) (?:(?:have|already|just|can) )*(?:got|found|have|see|spotted) (?:it|them|one|that)"
    r"(?: (?:here|already|myself|now|after all))*|(?:i|we) (?:do not|no longer) (?:need|want) (?:it|them|that)"
    r"(?: (?:any ?more|after all|now))*"
)
_BUT_NO = r"(?:(?:wait|no|oh|ah|actually|sorry|well|but|hm+|on second thoughts?),? )"
_RETRACTED = re.compile(
    r"^(?P<said>(?!say\b|tell\b|ask\b|let\b).+?(?<! and)(?<! then)(?<! or)(?<! to)[,.;!]?) "
    rf"(?:{_BUT_NO}*(?:{_OFF})|{_BUT_NO}+(?:just )?leave it)[.!]?$"
)
"""A command that is taken back in the same breath."""
_ALWAYS = re.compile(r"\b(?:always|from (?:now|today) on|in (?:the )?future|every time)\b")
_AND_YOU_CAN = re.compile(rf",? (?:then )?you (?:can|could|may|should) (?={A_VERB}\b)")
_BUT_FIRST = re.compile(
    r"^(?P<second>.+?),? but (?:first|before (?:that|you do(?: (?:that|it|so))?|doing (?:that|it|so))|beforehand),? "
    r"(?P<first>.+)$"
)
_FIRST_AFTER = re.compile(r"^(?P<first>first(?:ly)? .+?),? (?:and )?after(?: that| this)?,? (?=you\b)")
"""`first you go to the kitchen, after you come back`: one after the other in the order in which they are said."""
_LATER = re.compile(
    r"^(?P<first>.+?),? (?P<word>before|after|once|when|as soon as) (?:you(?: have)? |(?=\w+ing\b))(?P<second>.+)$"
)
_NOT_UNTIL = re.compile(r"^do not (?P<second>\w+ .+?),? (?:until|till|before) you(?: have)? (?P<first>.+)$")
"""What is forbidden only as long as something else is not done: the other thing, and then it."""
_ONCE_THERE = re.compile(rf",? (?:and )?{THERE}(?:(?=[.!]*$)|,? (?={A_VERB}\b))")
"""That something is to be done behind the way that is asked for before it, where it is done anyway."""
_GO_AND = (
    rf"\b{TO_GO}(?: over| along| across| down| up)* (?:to|into|in) (?P<place>(?:the|my|our) \w+(?: \w+)?)"
    r" (?:and|to) (?:see|tell me|check|look|find out|report|let me know)(?: back)? "
)
_OF_A_PLACE = r"\b.+ (?:on|in|at) (?!it\b|there\b)\w+"
_GO_AND_ASK = re.compile(rf"{_GO_AND}(?=(?:what|which|how many){_OF_A_PLACE})")
_GO_AND_CHECK = re.compile(
    rf"(?:{_GO_AND}|\bgo(?: over)? (?:and|to) (?:see|check|look|find out) )(?=(?:if|whether){_OF_A_PLACE})"
)
"""`go to the desk and see` before a question that names the place itself: the way there need not be said."""
_GO_AND_LOOK = re.compile(
    rf"{_GO_AND}what (?:is (?:(?:in|on) )?(?:there|it)|there is|you (?:can )?(?:see|find)(?: there)?)"
    r"(?=[,.;!?]|$| and\b)"
)
"""The same before a question about the place by a pronoun."""
_AND_TELL = re.compile(
    r"^(?P<look>(?:go (?:and )?|(?:can|could|would|will) you |please )*(?:look|check|see|find out|have a "
    r"look|take a look)\b"
    r"[^.;!?]*?\b(?:if|whether|what|which|how many|where|who)\b[^.;!?]+?),? and (?:then )?(?:tell|let|report)"
    r"(?: (?:it|back|that))?(?: to)?(?: me| us)?(?: know)?[.!?]*$"
)
"""A look, and that it is to be told about, which it is anyway."""
_ANNOUNCED = re.compile(
    rf"\b(?:the following|(?:the following|these|{'|'.join(NUMBERS)})(?: (?:more|other))? (?:things|items|objects))"
    r"\s*:\s*",
    re.IGNORECASE,
)
"""What only says that an enumeration comes: `bring me two things: the mug and the can`."""
_WHAT_IS_HELD = re.compile(
    rf"\b(?:(?P<verb>{A_VERB} (?:(?:me|us|down|back|away|over) )?)(?:what(?:ever)?|the thing|anything|everything) "
    r"(?:that )?you(?: are|'re) (?:holding|carrying)|"
    rf"(?P<handed>(?:{'|'.join(sorted(HANDLING))}) (?:(?:me|us|down|back|away|over) )?)what(?:ever)? (?:that )?"
    r"(?:you(?: have|'ve) got|you have|is in your hand)(?: there| in your hand)?)(?=$|[ ,;.!?])",
    re.IGNORECASE,
)
"""`whatever you're holding` behind a verb: it."""
_EMPTIED = re.compile(
    r"\b(?:empty|clear|clear off|clear out) (?P<from>(?:the|my|our) \w+(?: \w+)?)[,;.]? (?:and )?"
    r"(?:then )?(?:put |move |take |carry |bring )?(?:everything|it all|all of (?:it|them)|the lot|"
    r"both(?: things| items| of them)?|(?:its|the) contents)(?: goes?)? "
    r"(?P<to>(?:on|onto|in|into|to) .+)$"
)
"""`empty the table, everything onto the shelf`: what is taken from where, and where it goes."""
_FLOOR_OF = re.compile(
    r"\b(?P<on>on|from|off) the (?:floor|ground|carpet) (?:in|of) (?:the|my|our) "
    r"(?P<room>\w+(?: room)?)(?! of\b)(?=[ ,;.!?]|$)"
)
_TOP_OF = re.compile(
    r"\b(?P<on>from|off|on|onto) the (?:very )?(?:top|surface|edge|middle|far end) of (?=(?:the|my|our|that) \w)"
)
"""Where something lies, said with more words: on the bedroom floor, on the cabinet."""
_OVER_THERE = re.compile(r"\b(?:over|right|up|down) there (?=(?:on|in|at|next to|near|beside|by|under|behind) )")
_WISH_BEHIND = re.compile(rf",(?= {A_WISH} (?:some|something|an?) )")
_KEPT = r"(?:goes?|belongs?|lives?|stays?|puts?|keep|kept|have (?:its|their) (?:place|home)|supposed to be)"
_NOTED = re.compile(
    r"^(?:(?:please|and|so|now|no),? )*(?:(?:do )?(?:remember|note)|(?:keep|bear) in mind|just so you know|"
    r"as a (?:general )?(?:rule|principle)|in (?:general|future)|(?:in|at) (?:this|our) (?:house|flat|home|family))"
    rf"(?:,? please)?,?(?: that)? (?=(?:\w+ )*?{_KEPT}\b)"
)
_NOTED_BEHIND = re.compile(
    rf"^(?P<said>(?!{A_VERB}\b)(?:[\w']+ )*?{_KEPT}\b[^,.;]*?)[,.;] (?:and |so )?(?:please )?"
    r"(?:(?:do not forget|remember|note) (?:that|this|it)|remember|(?:keep|bear) (?:that|this|it) in mind)"
    r"[ ,.!]*(?:please)?$"
)
"""A statement of where things belong that is to be kept."""
_TWICE = re.compile(r"^(from now on )(?:from now on )+")
_HEADING = re.compile(
    r"^(?:(?:please|can you|could you|would you|now|so) )*(?:tidy|clear|clean|sort|empty)(?: up| off| out)? "
    r"(?:the|my|our) \w+(?: \w+)?: (?!(?:both|all|each|every\w*|the lot|it all) )"
    r"(?=[^.]*\b(?:goes?|belongs?|to|onto|into) (?:on |in |to )?(?:the|my|our)\b)",
    re.IGNORECASE,
)
"""What is to be done as a whole, before its parts are told one by one."""
_NEXT = frozenset(
    {"me", "us", "it", "them", "to", "into", "back", "here", "all", "up", "out", "everything", "away", "down"}
)


def commands(text: str, is_place: IsPlace = lambda _: False) -> list[str]:
    """The clauses of a text in the order in which they are to be done, each without its politeness."""
    text = put_where_labelled(_HEADING.sub("", text), is_place)
    text = _WHAT_IS_HELD.sub(lambda found: f"{found['verb'] or found['handed']}it", text)
    told = with_preamble(with_what_is_missed(expand(normalise(_ANNOUNCED.sub("", text), ",;.!?:"))), is_place)
    whole = begun_anew(without_fillers(as_speech(re.sub(r":(?=\s)", ",", told))))
    whole = _ONCE_THERE.sub(lambda found: " and " if found.end() < len(whole.rstrip(".! ")) else "", whole)
    whole = _TWICE.sub(r"\1", _NOTED_BEHIND.sub(r"from now on \g<said>", _NOTED.sub("from now on ", whole)))
    whole = _AND_TELL.sub(r"\g<look>", whole)
    whole = _GO_AND_LOOK.sub(
        r"go and look in \g<place>", _GO_AND_CHECK.sub("check ", _GO_AND_ASK.sub("tell me ", whole))
    )
    whole = _EMPTIED.sub(r"put everything on \g<from> \g<to>", whole)
    if LONG_SPEECH.match(without_politeness(whole)):
        return cut_clauses(whole)
    whole = with_shared_noun(whole)
    whole = _OVER_THERE.sub("", whole)
    whole = _TOP_OF.sub(r"\g<on> ", _FLOOR_OF.sub(r"\g<on> the \g<room> floor", whole))
    if (taken_back := _RETRACTED.match(whole)) and verb_first(without_politeness(taken_back["said"])):
        return ["never mind"]
    whole = without_purpose(whole.rstrip(" ."))
    if verb_first(without_politeness(whole)):
        whole = _WISH_BEHIND.sub(".", whole)
    whole = with_whereabouts(whole)
    parts = (piece for part in _in_order(whole) for piece in with_breaks(in_time(conditional(part))).split(" . "))
    return [clause for part in parts for clause in cut_clauses(settled(part, is_place))]


def _in_order(text: str) -> list[str]:
    """The text cut at "before you" and "after you have", the earlier part first."""
    bare = without_politeness(text)
    if found := _FIRST.match(bare) or _FIRST.match(text):
        cut = _second_clause(_AND_YOU_CAN.sub(", ", found["rest"]))
        if cut is not None:
            one, other = cut
            if _ALWAYS.search(text):  # "when you tidy up put the balls in the toy box from now on"
                return [other]
            return [other, one] if found["word"] == "before" else [one, other]
    if (found := _NOT_UNTIL.match(bare)) and verb_first(found["second"]) and verb_first(found["first"]):
        return [_with_infinitive(found["first"]), found["second"]]
    if (found := _BUT_FIRST.match(bare)) and verb_first(found["first"]):
        return [found["first"], found["second"]]
    if found := _FIRST_AFTER.match(text):
        return [found["first"], text[found.end() :]]
    if (found := _LATER.match(bare)) and verb_first(found["second"]):
        first, second = found["first"], _with_infinitive(found["second"])
        return [first, second] if found["word"] == "before" else [second, first]
    return [text]


def _second_clause(text: str) -> tuple[str, str] | None:
    """`put it there, bring me that` as its two commands; None if there are not two."""
    for comma in re.finditer(r",\s*(?:then\s+)?(?:please\s+)?", text):
        head, tail = text[: comma.start()], without_politeness(text[comma.end() :])
        if verb_first(head) and verb_first(tail):
            return _with_infinitive(head), tail
    words = text.replace(",", " ").split()
    for at in range(2, len(words) - 1):
        if words[at] in COMMANDING and (words[at + 1] in DETERMINERS or words[at + 1] in _NEXT):
            head = " ".join(words[:at])
            return (_with_infinitive(head), " ".join(words[at:])) if verb_first(head) else None
    return None


def _with_infinitive(text: str) -> str:
    first, _, rest = text.strip(" ,").partition(" ")
    return f"{infinitive(first, COMMANDING)} {rest}"
