"""Short forms written out: `what's` as `what is`, `wanna` as `want to`; several words for one: `plus` as `and`. Pure.

Recognised speech and hurried typing leave the apostrophes out, so both spellings mean the same here.
"""

import re
from functools import lru_cache

from common.language.dialect import plainly_spelled
from common.language.normalise import REMEMBERED
from common.language.shorter import SHORTER

_SPELLINGS = {
    word: " ".join(plain.split("_"))
    for row in (
        "thanks thx tnx thanx cheers", "give_me gimme gimmie", "right_now rn", "never_mind nvm nm", "let_me lemme",
        "something sth smth sumthin somethin", "i_will imma i'mma ima", "want_to wanna wantta gotta", "out_of outta",
        "going_to gonna gon", "do_you d'you", "because cuz coz cos", "oclock o'clock", "that dat", "any_more anymore",
        "_ tho tbh ngl fr innit lol imo kinda sorta",
    )
    for plain, *words in (row.split(),)
    for word in words
}  # fmt: skip
"""Spoken spellings of single words."""
_SPELLED = re.compile(rf"\b(?:{'|'.join(_SPELLINGS)})\b")
_TELL_NAME = (
    r"(?:^|(?<= and )|(?<= then )|(?<=, ))tell (?!(?:me|us|you|it|the|my|our|your|his|her|him|them|every\w+|any\w+|"
    r"people|whoever|who|what|where|how|if|whether|that|this)\b)[a-z]+"
)
"""Behind it stands what is to be said to somebody by name."""
_STATE = (
    "(?:cold|hot|warm|cool|dirty|filthy|empty|full|flat|off|rotten|mine|yours|ours|broken|wet|dry|bad|done|finished|"
    "ready|old|stale|sour|mouldy|moldy|burnt|cracked|dusty|sticky|greasy|smelly|heavy|loose|stuck|lost|gone|missing|"
    "open|closed|nowhere|hungry|thirsty|tired|asleep|awake|ill|sick|sad|bored|hurt|crying|sleeping|leaking|dripping|ringing|"
    "rubbish|trash|garbage|fragile|precious|dangerous|sharp|late|early|out|away|spare|useless|torn|ripped|worn|"
    "chipped|clean|great|lovely|nice|fine|over|up|coming|starting|too \\w+)"
)
"""How something or somebody is, behind a short `is`: `the soup's cold`; other words there are things that it has."""
_AFTER_IS = (
    "(?:a|an|the|in|on|at|not|so|too|very|coming|going|getting|here|there|for|to|from|with|by|under|behind|beside|near|"
    "next|no|still|also|always|usually|probably|never|supposed|meant|wanted|needed|required|due|welcome)"
)
"""What stands behind a short `is`, and behind nobody's name: `the bowl's wanted`, `the apple's for Priya`."""
_CONTRACTIONS = tuple(
    (re.compile(short), long)
    for short, long in (
        # Spoken spellings.
        (r"([a-z])\1{2,}", r"\1"),
        (
            r"\b(?!what's left of\b)(\w{3,})'s (?=(?:left|lost|moved|taken|put|hidden|dropped|forgotten|"
            r"vanished|disappeared|finished|eaten|broken|spilt|"
            r"come|run|"
            r"fallen|made|had)\b)",
            r"\1 has ",
        ),
        (r"\b(?:pls|plz|plox|ple+a+se+)\b", "please"),
        (r"\b(?:nah|naw|noo+)\b(?= \w|, )", "no"),
        (r"\br u\b", "are you"),
        (r"\bu\b(?!-)", "you"),
        (r"\b2 (?=me\b|us\b|the\b|da\b|my\b)", "to "),
        (r"\b4 (?=me\b|us\b)", "for "),
        (r"\b(?:might|could|would) you(?: perhaps| maybe| possibly)? have (?=seen|noticed|found)", "have you "),
        (r"\b(?:forgive me|my (?:bad|mistake)|(?:my )?apologies|pardon me|w?h?oops(?:ie)?)\b,?(?= \w|, )", "sorry"),
        (
            r"\b(i|we) should (?=(?:(?:so|very|most|really|much|rather) )*(?:be|like|love|appreciate|prefer)\b)",
            r"\1 would ",
        ),
        (r"\bif you were to (?=\w)", "if you would "),
        (r"\b(?:da|de|ze|teh)(?= \w)", "the"),
        (r"\b(could|would|can|did|do|will)(?:ja|cha|ya)\b", r"\1 you"),
        (r"\bya(?= know\b| see\b)|(?<=can )ya\b|(?<=could )ya\b|(?<=would )ya\b|(?<=will )ya\b", "you"),
        (r"(?<!\w)'em\b|\bem\b", "them"),
        (r"(?<!\w)'cause\b", "because"),
        (r"\b(what|where|how|when|why)'d\b", r"\1 did"),
        (r"\b(what|where|who|how|when|why)'?d (?=i|you|we|they|he|she)", r"\1 did "),
        (r"\b(?:two|too) (?=(?:the|my|our) )", "to "),
        (r"\bin here\b", "here"),
        (r"\b((?:second|minute|hour|moment)s?)'s? time\b", r"\1 time"),
        (
            r"\bwhere you (?:are|stand)(?: standing)?(?: now| at present)? (?:shall be|will be|is)(?: called)?\b",
            "call this place",
        ),
        (r"\b(call|name) (?:the|this) (?:place|spot) where you (?:are|stand)(?: now| at present)?\b", r"\1 this place"),
        (r"\b(which one)'s\b", r"\1 is"),
        (r"^tell (?:me|us), (?=(?:is|are|what|where|which|how|who|do|does|have|has|any)\b)", ""),
        (r"\brepeat (?:that|it|this) (?:again|once more|one more time)\b", "do that again"),
        # With the apostrophe, or without it where no other word is spelled so.
        (r"\b(what|where|who|there|that|how|here|which|when|why)'?s\b(?! up\b)", r"\1 is"),
        (r"\b(whatever|everything|anything|something|nobody)'?s\b", r"\1 is"),
        (r"\b(it|she|he|\w{3,})'s (?=(?:got|gone|been|ended)\b)", r"\1 has "),
        (r"\b(it|she|he)'s\b", r"\1 is"),
        (rf"\b(\w{{2,}})'s (?={_AFTER_IS}\b)", r"\1 is "),
        (
            rf"(^|[,.;!?] |\b(?:and|so|but|because|that) )"
            r"((?:(?:the|my|our|that|this|your|his|her) (?:\w+ ){0,2})?\w{3,})'s "
            rf"(?=(?:(?:all|a bit|quite|completely|already|just|no|too|totally|getting) )*{_STATE}"
            r"(?:[,.;!?]|$| (?:and|so|now|again|today|but|already|in|on|at|here|there|to be)\b))",
            r"\1\2 is ",
        ),
        (r"^its (?=the|a|an|my|not|too|time|in|on)\b", "it is "),
        (r"\b(?:can't|cant|cannot)\b", "can not"),
        (r"\b(?:won't|wont)\b", "will not"),
        (r"\b(did|is|are|was|were|does|have|has|had|could|should|would|must|need)n'?t\b", r"\1 not"),
        (r"\b(?:don't|dont)\b", "do not"),
        (r"\b(?:i'm|im)\b", "i am"),
        (r"\b(?:you're|youre)\b", "you are"),
        (r"\b(they|we)'re\b", r"\1 are"),
        (r"\b(i|you|they|we)'?ve\b", r"\1 have"),
        (r"\b(\w+)'ll\b", r"\1 will"),
        (r"^ill(?= \w)", "i will"),
        (r"\b(i|you|they|we|he|she)'d (better)\b", r"\1 should"),
        (r"\b(?!o')(\w+)'d\b", r"\1 would"),
        (r"\bid (?=like|love|appreciate|prefer|be|want|need|rather)", "i would "),
        (r"\blet'?s\b", "let us"),
        (r"\bits (?=(?:lying|standing|sitting|on|in|at|under|behind|next to)\b)", "it is "),
        (r"^(please )?go (?:over )?(?:and )?(?=(?:tell|say|inform|announce|wish|let \w+(?: \w+)? know)\b)", r"\1"),
        (rf"{_TELL_NAME} (?=(?:in|at) (?:the|my|our)\b)", "tell them "),
        (
            rf"{_TELL_NAME},? (?!(?:to|where|what|how|if|whether|about|when|why|who|which|in|at|and|not)\b)(?:that )?",
            "say ",
        ),
    )
)
_TO_BE_SAID = re.compile(r"^(?:(?:please|can you|could you|would you|go|and) )*(?:say|tell|announce|inform|let)\b")
"""How a sentence begins that has words in it which stay as they are."""


@lru_cache(REMEMBERED)
def expand(text: str) -> str:
    """Normalised text with `what's` written as `what is` and `plus` as `and`."""
    if not _TO_BE_SAID.match(text):
        text = plainly_spelled(text)
    text = _SPELLED.sub(lambda found: _SPELLINGS[found[0]], text)
    for short, long in _CONTRACTIONS if _TO_BE_SAID.match(text) else (*_CONTRACTIONS, *SHORTER):
        text = short.sub(long, text)
    return " ".join(text.split()) if "  " in text else text
