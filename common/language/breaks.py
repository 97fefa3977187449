"""Where a request begins in a sentence that says something else first: `my feet hurt so could you get the mug`. Pure.

Recognised speech has no punctuation and people tell why before they ask. What is told is no command; it can name what
"it" means in the request. A sentence that reports, forbids, supposes or asks is left in one piece, so that nothing of
it is taken for a request.
"""

import re

from common.language.conditional import REQUESTS
from common.language.lexicon import HANDLING
from common.language.normalise import DETERMINERS
from common.language.politeness import without_politeness

_STRONG = re.compile(
    r"(?:,\s*|\s+)(?:(?:and|so|but|then|right|ok|okay|just|well|now|hence|therefore),?\s+)*"
    r"(?=(?:can|could|would|will) you\s+(?!see\b|know\b|believe\b|imagine\b)|"
    r"please\s+(?!and\b|whichever\b|the\b|an?\b|my\b|that\b)\w|"
    r"(?:can|could|may|might) (?:i|we) (?:please )?(?:have|get)\s|(?:i|we) (?:want|need|would like) "
    r"you to\s|do me a favou?r)"
)
"""Before words that can only begin a request."""
_WEAK = re.compile(
    r",\s*(?:(?:and|so|but|then|right|ok|okay|just|well|now|hence|therefore),?\s+)*"
    r"|\s+(?:so|but) (?:(?:just|now|then|whatever|anyway|anyhow|please),? )*"
)
"""Before what is a request if it begins with a verb."""
_TELLS = re.compile(
    r"\b(?:is|are|was|were|(?:i|we|you|he|she|they|somebody|someone|has|have) "
    r"left|saw|see|know|remember|needs?|wants?|have|"
    r"has|dropped|forgot|belongs?|looks?|smells?|fell|stands|lies|sits|likes?|loves?)\b.* (?!not\b|never\b)\w+$"
)
"""What is told of a thing before it is spoken of as "it"."""
_WITH_PRONOUN = re.compile(
    rf"\s+(?=(?:please )?(?:(?:{'|'.join(sorted(HANDLING | {'bin'}))}) (?:(?:rid )?of )?"
    r"(?:it|them|me (?:it|that|them|one))\b|(?:i|we) (?:want|need|would like|would love) (?:it|them)"
    r"(?: (?:on|in|at|back|here|over)\b|$)))"
)
"""Before a request that speaks of what was told."""
_ASKS_WHERE = re.compile(r"^(?:where|whereabouts) (?:is|are) (?!it\b|they\b)\w+ \w+")
"""Which thing it is that is asked for next."""
_SUBJECTS = frozenset(
    {
        "i", "we", "he", "she", "they", "it", "there", "someone", "somebody", "everyone", "everybody", "this", "that",
        "these", "those", "you", "yesterday", "earlier", "mum", "mom", "mommy", "mummy", "dad", "daddy", "grandma",
        "grandpa", "guests", "dinner", "lunch", "kids", "children", "people", "visitors",
        "tea", "supper", "breakfast", "food", "grandad", "gran", "granny",
    }
)  # fmt: skip
"""Words with which somebody begins to tell something, beside articles."""
_DONE = frozenset({
    "left", "lost", "gone", "got", "put", "taken", "come", "run", "forgotten", "broken", "spilt", "eaten", "hidden",
    "fallen", "made", "had", "been",
})  # fmt: skip
"""Participles without -ed, by which `has` tells what was done."""
_ANSWER = re.compile(r"^(?:no|nope|yes|yeah|well),\s+")
_NO_STATEMENT = re.compile(
    r"^(?:if|unless|when|whenever|in case|should|suppose|supposing|imagine|pretend|assume|what|who|why|where|how|"
    r"which|whose|"
    r"do|does|did|is|are|was|were|has|have you|can|could|would|will|not|never|no|nobody|under no)\b"
)
"""How sentences begin whose second half is not to be carried out by itself."""
_UNFINISHED = re.compile(
    r"\b(?:said|says|say|told|tells|tell|asked|asks|ask|to|that|if|whether|not|never|like|was|were|is|are|and|or|"
    r"(?<!belongs to )(?:me|us)|them|"
    r"him|her|you|why|when|how|would|could|should|must|will|shall|(?<!the )(?<!red )(?<!green "
    r")(?<!white )(?<!blue )(?<!my )can|may|might|do|does|did|always|"
    r"usually|often|sometimes|still|already|just|also|the|a|an|my|your|of|in|on|for|with|please)$"
)
"""How words end that go on in what follows: `he said`, `she asked me to`."""
_REPORTS = re.compile(r"\b(?:said|says|say|told|tells|tell|asked|asks|ask)(?: (?:me|us|him|her|that|to|you))*$")
_FORBIDS = re.compile(
    r"\b(?:you|nobody|no one|never|always) (?:must|should|may|can|do|will|would|could|did)? ?(?:not|never)\b"
)
_NOBODY = re.compile(
    r"^(?:nobody|no one) (?:(?:is )?(?:need|want|us|lik|eat|drink|play)(?:s|es|ing)(?: with)?) (?:the|my|this|that) "
    r"[^,]+$"
)
_OF_IT_ALL = re.compile(
    r"^(?:it|they) (?:can|could|should|must|may|needs? to|ha(?:s|ve) to|wants? to|ought to|belongs?|goes?)\b"
)
"""A request that begins with what was told of."""
_QUESTION = re.compile(
    r"^(?:and |so )*(?:where|which|what|who|how many|(?:is|are) there|have you (?:seen|found|noticed)|"
    r"do you (?:know|see))\b"
)
_WISHED = re.compile(
    r"^(?:i|we) (?:want|need|would (?:really )?(?:like|love)|could do with|will have) (?:the|an?|my|some|that|one)\b"
)
LONGEST = 3
"""Breaks of one sentence (chosen)."""


_BEHIND = re.compile(
    r",?\s+(?=(?:i|we|he|she|it|they|there|(?:my|our) \w+|mum|mom|dad|guests|dinner|lunch|somebody|someone)"
    r"(?: \w+ly| just| really| so| all)?"
    r" (?:am|is|are|feel|feels|have|has|can not|could not|do not|does not|will|think)\b)"
)
"""Before a reason that is said behind a request."""
_PURPOSE = re.compile(
    r"(?:\s*[,.;?!]+)?\s+(?:because |since |as |so (?:that )?)?(?:(?:i|we) (?:really |just |still )*"
    r"(?:want|need|have(?: got)?|would like|am (?:about|going)|are (?:about|going)|wish|intend|plan) to "
    r"(?!(?:have|get|see (?:whether|if|what|where|how|you|it)|know|"
    r"hear|be|go|put|take|bring|use|borrow)\b)"
    r"|so (?:that )?(?:i|we) (?:can |will |may |do not |could )?"
    r"(?:see|find|remember|have|know|forget|miss|lose|notice|use) "
    r"(?:it|them|that)\b"
    r"|it is (?:high |about )?time (?:(?:for (?:me|us|\w+) )?to|(?:i|we)) |(?:he|she|they|mum|dad|(?:my|our|the) \w+) "
    r"(?:(?:really |just |still )*(?:wants?|needs?|ha(?:s|ve)(?: got)?|would like|(?:is|are) (?:about|going)) to "
    r"|asked for it|(?:is|are) (?:waiting|asking) for (?!you\b)))(?!.*\b(?:you|robot|instead)\b)[^.;?!,]*[.!\s]*$"
)
"""What is wanted for something, said behind a request: no more is asked for by it."""
_NEEDED_TO = re.compile(
    r"^(?P<said>(?:i|we) (?:really )?(?:need|want|would like) (?:a|an|some|the|my) (?:\w+ ){1,4}?)to "
    r"(?!be\b|go\b|stand\b|drink\b|"
    r"eat\b|come\b|have\b|stay\b|write\b)\w+ (?:this|that|these|the|my|our|a|an|some|with|it|up)\b[^.,;!?]*"
)
"""A wish, and what it is wanted for: `a pair of scissors to open this parcel`."""
_MAY_I_HAVE = re.compile(r"^(?:please )?(?:can|could|may|might) (?:i|we) (?:please )?(?:have|get|use|borrow)\b")
_TELLS_WHERE = re.compile(r"^(?:it|they) (?:is|are) (?:\w+ ){0,2}?(?:in|on|at|next|near|beside|under|behind)\b")


def without_reason_behind(text: str) -> str:
    """`get me the bottle i am so thirsty` without why; a text without such a reason as it is."""
    for found in _BEHIND.finditer(text):
        head, tail = text[: found.start()], text[found.end() :]
        if not _requests(head) or len(without_politeness(head).split()) < 2 or _UNFINISHED.search(head):
            continue
        if not _TELLS_WHERE.match(tail) and not HANDLING & set(tail.split()):
            return head
    return text


def without_purpose(text: str) -> str:
    """`get me the hammer, i want to hang up a picture` without what it is wanted for."""
    text = _NEEDED_TO.sub(r"\g<said>", text)
    found = _PURPOSE.search(text)
    head = text[: found.start()] if found else ""
    return head if _requests(head) or _MAY_I_HAVE.match(head) else text


def _requests(text: str) -> bool:
    first = without_politeness(text).split()[:1]
    return bool(first) and (first[0] in REQUESTS or _WISHED.match(text) is not None)


def with_breaks(text: str) -> str:
    """The text with a full stop between what is told and what is asked for."""
    for _ in range(LONGEST):
        if (at := _break(text)) is None:
            break
        text = f"{text[: at[0]].rstrip(' ,')} . {text[at[1] :]}"
    first, but, second = text.partition(" but ")
    apart = but and not DETERMINERS.isdisjoint(first.split()[:1]) and is_statement(first)
    return f"{first.rstrip(' ,')} . {second}" if apart and is_statement(second) else text


def _break(text: str) -> tuple[int, int] | None:
    begin = max(text.rstrip(" .;!?").rfind(mark) for mark in ".;!?") + 1
    for pattern in (_STRONG, _WEAK, _WITH_PRONOUN):
        for found in pattern.finditer(text, begin):
            head, tail = text[begin : found.start()].strip(" ,"), text[found.end() :]
            if pattern is _WITH_PRONOUN and not (_TELLS.search(head) or _ASKS_WHERE.match(head)):
                continue
            ended = "," in found[0] or " so " in f" {found[0]} " or " but " in f" {found[0]} "
            asks_where = pattern is _WITH_PRONOUN and _ASKS_WHERE.match(head) is not None
            if (asks_where or is_statement(head, ended)) and _asks(tail, pattern is not _WEAK):
                return found.start(), found.end()
    return None


def is_statement(text: str, ended: bool = True) -> bool:
    """Does a text tell something, complete in itself, and neither ask for nor forbid anything?

    `ended`: a mark says where it ends, so that it does not go on in what follows.
    """
    bare = without_politeness(_ANSWER.sub("", text.strip()))
    words = bare.replace(",", " ").split()
    if _NOBODY.match(bare):
        return True
    if (
        len(words) < 2
        or _NO_STATEMENT.match(bare)
        or (_UNFINISHED if not ended else _REPORTS).search(bare)
        or _FORBIDS.search(bare)
    ):
        return False
    if words[1] == "has" and len(words) > 3 and (words[2].endswith("ed") or words[2] in _DONE):
        return True  # "tom has left his ball on the bookshelf"
    return words[0] in _SUBJECTS or (words[0] in DETERMINERS and len(words) > 2)


def _asks(text: str, strong: bool) -> bool:
    bare = without_politeness(text.split(".")[0]).replace(",", " ").split()
    if not bare:
        return False
    bins = (bare[:1] == ["bin"] and bare[1:2] != ["it"]) or bare[:2] == ["bin", "it"]
    if text.startswith(("where is it", "where are they", "have you any idea where", "do you know where")):
        return True  # "my ball rolled away, where is it"
    return len(bare) > 1 and (
        strong or bare[0] in REQUESTS or bins or any(p.match(" ".join(bare)) for p in (_OF_IT_ALL, _WISHED, _QUESTION))
    )
