"""What was taken back or made more precise: `the red mug, no wait, the blue one`, `the can, the green one`. Pure."""

import re

from common.language.apposition import apposed, refined
from common.language.contrasts import CONTRAST, contrasted, instead, with_qualities
from common.language.exchange import PREPOSITIONS, IsPlace, replaced, verb_first
from common.language.lexicon import A_VERB, A_WISH, COMMANDING, HANDLING
from common.language.meaning import VERBS
from common.language.normalise import DETERMINERS
from common.language.politeness import without_politeness

_REPAIR = re.compile(
    r"(?:,\s*wait,\s*(?=not\b)|[,.;]\s*(?:no|sorry|actually|rather)(?:,\s*|\s+)|,\s*(?:oh|well|hold on|hang on),\s*"
    r"|(?<=\w)(?<!\bsay)\s+no,?\s+(?:just |only )?(?=(?:the|my|on|in|to|at)\s)"
    r"|,?\s+(?:(?:no|ah|oh),? (?:wait|hold on|hang on|sorry|no)"
    r"|wait,? no|sorry,? no|(?:no,? |sorry,? )?i mean(?:t)?|(?:no,? )?make (?:that|it)|scratch that|correction|"
    r"or rather|or (?:rather|maybe |even |perhaps )?(?:better|no)(?: yet| still)?|better (?:yet|still)|no,? not that|"
    r"on second thoughts?)(?:,\s*|\s+))(?:i mean(?:t)?|i said|make (?:that|it)|rather|actually|sorry|wait|"
    r"no|scratch that)?\b[,.]?\s*"
)
"""Between what was said and what was meant."""
_TELLS = re.compile(r"(?:it|they|he|she) (?:is|are|was|were) (?:on|in|at)\b")
"""What tells where something is, and stands for no part of what was said."""
_TAKEN_BACK = re.compile(
    r"(?:[.;!?]\s*)+(?:no,? )?(?:(?:scratch|strike|scrap) that|(?:my )?final answer)(?:\s*[.;:!,])+\s*(?=\w)"
)
"""A repair that is a sentence of its own: `the can. scratch that.`"""
_AFTERTHOUGHT = re.compile(
    r"^(?P<said>.+?),?\s+(?P<meant>(?:the|a|my|to|on|in|into) [^,]+?),? (?:i mean(?:t)?|that is|i should say|to "
    r"be precise|actually)$"
)
"""A correction that is marked behind itself: `the can, the green one i mean`."""
_DISLOCATED = re.compile(
    r"^(?:go (?:and )?)?(?P<verb>\w+(?: me)?) (?P<pronoun>it|them|that|this)\b"
    r"(?:(?P<rest>[^,]*?),\s*|(?P<near>(?: to me| here| over| back| away)*) )"
    r"(?P<thing>(?:the|my|a|an|all|both) [^,]+?)(?: i mean(?:t)?)?$"
)
_PRESENTED = re.compile(
    r"^(?P<thing>(?:the|my|that|this|those|these|all|both|our|whichever) (?!.*\b(?:does|do|is|are) not\b)[^,]+?),\s*"
    r"(?P<rest>(?:(?:please|just|can you|"
    r"could you|would you)\s+)*\w+"
    r"(?: me)? (?:it|them|that|those|one)\b.*|"
    r"(?:what|which|where|whereabouts|how|is|are|i|we)\b[^,]* (?:it|they|them)\b.*)$"
)
_ASKS_OR_WISHES = re.compile(
    r"^(?:(?:what|which|where|whereabouts|how)\b|(?:is|are) (?:it|they)\b|"
    r"(?:i|we) (?:\w+ )?(?:want|need|would like|would love)\b)"
)
_PRESENTED_AT_ONCE = re.compile(
    r"^(?P<thing>(?:the|my|that|this|those|these|our) "
    r"(?!.*\b(?:is|are|was|were|has|have|said|says|told|and|if|not)\b)"
    rf"(?:\w+ ){{1,10}}?)(?P<rest>(?:(?:please|just|can you|could you|would you) )*(?:{'|'.join(sorted(HANDLING))})"
    r"(?: me| rid of)? (?:it|them|that|those)\b.*|(?:i|we) (?:want|need|would like|would love) (?:it|them)\b.*)$"
)
"""A thing that is named before or after the command in which a pronoun stands for it."""
_LATE_EXCEPT = re.compile(
    r"^(?P<all>.+) (?P<particle>away|out|back|up|down) (?P<but>(?:except|but not|but|apart from|other than) .+)$"
)
"""An exception that is said behind a verb's particle."""
_AS_IT_IS = "(?: (?:there|here|put|alone|be|out|in peace|(?:where|as) (?:it|they) (?:is|are)))?"
_SPARED = re.compile(
    r"^(?P<said>.+?)(?:,\s*|,? (?:and|but|only|just|though|while) )(?:(?:please )?(?:hands off|(?:do not|never) (?:"
    r"touch|move|take)|leave|spare|keep|ignore|skip|stay away from) (?P<one>(?:the|my|our|any|everything) [^,]+?)|"
    r"(?P<other>(?:the|my|our) [^,]+?) (?:(?:can|may|should|must|has to|is to|will) )?(?:stays?|remains?))"
    rf"{_AS_IT_IS}(?: though| please)?$"
)
"""What is not to be touched, said behind a command that would."""
_SPARED_FIRST = re.compile(
    r"^(?P<spared>leave (?:the|my|our|everything) [^,]+? (?:alone|be|in peace|(?:where|as) (?:it|they) (?:is|are))),? "
    rf"(?:and |but |just |only )+(?P<said>{A_VERB} .+)$"
)
_EXCEPT = re.compile(r",\s*(?:and |but |only |just )?(?=(?:not|except|but not|apart from|other than)\b)")
_ANSWERS = frozenset({"no", "yes", "not", "if", "when", "unless", "after", "before", "once", "first"})
LONGEST_LEAD = 4
"""Words before a comma that may be left out (chosen)."""
_NOT_THERE = re.compile(
    r"^(?P<said>.+? (?:on|in|to|into|onto|at) .+?),? (?:and |but )?not (?:on|in|to|into|onto|at|back) "
    r"(?:the|my|a) \w+(?: \w+)?$"
)
"""Where something is to be, and where not."""
_NOT_THAT_ONE = re.compile(
    r"^(?P<said>(?!not\b).+?),? (?:and |but )?not (?P<one>(?:the|a|my|that) (?:\w+ )?one)"
    r"(?P<more>(?:,? (?:and|or|nor)(?: not)? (?:the|a|my|that) (?:\w+ )?one)*)$"
)
_SEVERAL = re.compile(r"\b(?:all|every|everything|any|do|does|did|(?:the|my|those|these) (?:\w+ )?\w+s)\b")
_SPARABLE = re.compile(rf"\b(?:tidy|clean|clear|empty|sort)\b|{_SEVERAL.pattern}")
_THE_OTHER_ONE = re.compile(
    r"^(?P<said>.+?),? (?:but )?not (?:the|a|my) (?:\w+ )?\w+?,? (?:but )?(?P<one>(?:the|a|my) \w+ (?:one|\w+))$"
)
_WILL_DO = re.compile(
    r"^(?P<said>(?!.*\b(?:if|or|not)\b)[^,]* (?:an?|some|something) [^,]+), (?P<one>(?:the|my|that) (?:\w+ ){1,6}?)"
    r"(?:will|would) (?:do|be (?:fine|ok|okay|good|enough))$"
)
"""Something of a kind, and which one is as good as any."""
_WISHES = re.compile(rf"^{A_WISH} (?:something|an?|some)\b")
_KIND_FIRST = re.compile(
    r"^(?:m+ )?(?:(?:i|we) (?!(?:do )?not\b)[^,]*|(?:bring|get|fetch|give) (?:me |us )?)\b"
    r"(?:an?|some|something)(?: \w+)? "
    r"(?:drink|eat|snack|bite|refreshment|treat)s?, (?P<one>(?:the|my) (?:\w+ ?){1,3}?)(?: please)?$"
)
"""What it is wanted for, and which thing that is: `i would love a cold drink, the red can please`."""
_APPOSED = re.compile(
    r"^(?P<thing>(?:the|my|that) \w+(?: \w+)?), (?:the|my|that) one (?P<which>(?:on|in|at|from|next "
    r"to|near|beside|with) [^,]+),? "
    r"(?P<rest>.+)$"
)
"""A thing, which one it is, and what is to be done with it."""
_NEXT_TO_THERE = re.compile(
    rf"^(?P<said>{A_VERB} [^,]+?) (?:on|onto|in|into|to) (?:the|my|our) [^,]+?, (?P<near>(?:right |just "
    rf")?(?:next to|beside|"
    r"near|close to|by|to the (?:left|right) of) [^,]+)$"
)
"""Where something is to be put, and next to what there."""
_THE_ONE = re.compile(r"(?<=\w),? the one (?=(?:with|on|in|from|at|next to|near|beside) )")
_THAT_IS = re.compile(r"(?P<one>(?:the|a|my) \w+ one),? (?:that is|i mean|to be precise|obviously)\b")


def begun_anew(text: str) -> str:
    """The text without what was taken back in a sentence of its own: `the can. scratch that. bring me the mug`."""
    said, *others = _TAKEN_BACK.split(text)
    meant = ""
    for part in others:  # what is no command corrects the last one
        said, meant = (part, "") if verb_first(without_politeness(part)) else (said, part)
    return f"{said}, scratch that, {meant}" if meant else said


def settled(text: str, is_place: IsPlace) -> str:
    """The text without what was taken back."""
    text = _NEXT_TO_THERE.sub(r"\g<said> \g<near>", _THE_ONE.sub(" ", text))
    text = _THAT_IS.sub(r"\g<one>", _APPOSED.sub(r"\g<thing> \g<which> \g<rest>", text))
    text = refined(apposed(_without_lead(text, is_place)))
    text = _AFTERTHOUGHT.sub(r"\g<said>, i mean \g<meant>", text) if text.count(",") else text
    text = _with_noun(text)
    if (found := _NOT_THAT_ONE.match(text)) and not _SEVERAL.search(found["said"]):
        others = re.sub(r",? (?:and|nor) not | nor ", " or ", found["more"])
        one_of = "" if "," in found["said"] else f" but not {found['one']}{others}"
        text = f"{found['said']}{one_of}"
    text = _without_spared(_SPARED_FIRST.sub(r"\g<said> but \g<spared>", text))
    if (found := _THE_OTHER_ONE.match(text)) and (verb_first(without_politeness(found["said"]))):
        text = replaced(without_politeness(found["said"]), found["one"], is_place) or text
    if found := _WILL_DO.match(text):
        if verb_first(without_politeness(found["said"])):
            text = replaced(without_politeness(found["said"]), found["one"].strip(), is_place) or text
        elif _WISHES.match(found["said"]):
            text = f"bring me {found['one'].strip()}"
    if found := _KIND_FIRST.match(text):
        text = f"bring me {found['one']}"
    if found := _NOT_THERE.match(text):
        text = found["said"]
    text = refined(_repaired(text, is_place))
    text = _EXCEPT.sub(" but ", text).replace(" but but ", " but ")
    text = _LATE_EXCEPT.sub(r"\g<all> \g<but> \g<particle>", text)
    bare = without_politeness(text)
    meant = instead(bare) or contrasted(bare)
    return text if meant == bare else meant


def _without_spared(text: str) -> str:
    """What is not to be touched as an exception of a command for several things; left out where it is of another."""
    found = _SPARED.match(text)
    if found is None:
        return text
    said, spared = found["said"], found["one"] or found["other"]
    alike = set(spared.split()) & ({"one", "ones", *said.split()} - DETERMINERS)
    if _SPARABLE.search(said) or (alike and re.search(r"\b(?:an?|another|some) ", said)):
        return f"{said} except {spared}"
    return said if found["one"] and not alike and verb_first(without_politeness(said)) else text


def _with_noun(text: str) -> str:
    """`the mug on the desk, bring it to me` and `bring it to me, the mug` as `bring the mug to me`."""
    if (found := _PRESENTED_AT_ONCE.match(text)) and "," not in text:
        return _put_in(found["thing"], found["rest"])
    if found := _DISLOCATED.match(without_politeness(text)):
        if found["verb"].split()[0] in COMMANDING:
            return f"{found['verb']} {found['thing']}{found['rest'] or found['near'] or ''}"
    elif (found := _PRESENTED.match(text)) and _speaks_of_it(without_politeness(found["rest"])):
        return _put_in(found["thing"], found["rest"])
    return text


def _speaks_of_it(text: str) -> bool:
    """Is it a command, a question or a wish, in which a pronoun may stand for what was named before?"""
    return verb_first(text) or _ASKS_OR_WISHES.match(text) is not None


def _put_in(thing: str, command: str) -> str:
    """A thing in place of the first pronoun of a command."""
    return re.sub(r"\b(?:it|they|them|that|those|one)\b", lambda _: thing, command, count=1)


def _repaired(text: str, is_place: IsPlace) -> str:
    """The text with what was said last in place of what it corrects."""
    for _ in range(3):
        found = (None, *_REPAIR.finditer(text))[-1]
        if found is None or not text[: found.start()].strip() or not text[found.end() :].strip(" ,.!?"):
            return text
        if _TELLS.match(text, found.end()):
            return f"{text[: found.start()]}. {text[found.end() :]}"
        meant = refined(re.sub(r",? i mean(?:t)?$", "", text[found.end() :].strip(" ,.!?")))
        if contrast := CONTRAST.match(meant):
            meant = with_qualities(text[: found.start()], contrast["wrong"], contrast["right"])
        meant, comma, rest = meant.partition(", ")
        if rest.split(" ")[0] not in PREPOSITIONS:  # "the red can, i mean the green can, on the dresser"
            meant, rest = f"{meant}{comma}{rest}", ""
        if (repaired := replaced(f"{text[: found.start()]} {rest}", meant, is_place, "mean" in found[0])) is None:
            return text
        text = repaired
    return text


def _without_lead(text: str, is_place: IsPlace) -> str:
    """The text without words before its first comma that name nothing, such as `yo, could you ...`."""
    head, comma, rest = text.partition(",")
    words = without_politeness(head).split()
    strange = 0 < len(words) <= LONGEST_LEAD and not DETERMINERS & set(words) and words[0] not in _ANSWERS
    if (
        comma
        and strange
        and not verb_first(head)
        and words[0] not in VERBS
        and not PREPOSITIONS & set(words[:1])
        and not is_place(tuple(words))
        and " " in rest.strip()
        and verb_first(without_politeness(rest))
    ):
        return rest
    return text
