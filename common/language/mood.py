"""Who is to act, and when: what forbids, supposes, reports, asks or tells of others is no request. Pure."""

import re

from common.language.lexicon import HANDLING
from common.language.normalise import Words, infinitive
from common.language.verb_classes import VERBS, classes


def _any(phrases: str) -> str:
    """Regular expression for one of the phrases `a | b c`, as whole words."""
    return rf"\b(?:{'|'.join(phrase.strip() for phrase in phrases.split(' | '))})\b"


_NEGATIONS = (
    "not | never | nobody | none | nothing | no one | without | stop | leave | hands off | (?:stay|keep) "
    "(?:away|out|off|clear) | forbid | forbidden | allowed | hate | no reason | wrong | except | excluding"
    " | (?:and|but) keep | no (?:need|point|use) | mistake | quit | hold off | under no | refrain | avoid"
    " | pointless | unnecessary | (?:was|were) supposed"
)
_SUPPOSITIONS = (
    "suppose | supposing | imagine | pretend | used to | what if | had (?:i|you|we)"
    " | if (?:i|you|he|she|we|they) (?:were|was|had|could|asked|told|said|wanted)"
)
_OTHER_TIMES = (
    "tomorrow | tonight | yesterday | already | ago | ever | this morning | later"
    " | (?:last|next) (?:week|night|year|month|time) | (?:would|could|should|might|must) (?:it )?(?:not )?have"
)
_REPORTS = (
    "said | says | saying | told | claim | claims | heard | think | thinks | thought | joke | story | song | poem"
    " | (?:wants?|asks?|asked|begged|tells?) (?:me|him|her|them|us) to"
)
_HOW_AND_WHY = r"\b(?:how|why)\b(?! (?:many|about|not|do not|do you not)\b).* (?:did|do|would|should|could|to)\b"
_FORBIDS = re.compile("|".join((*map(_any, (_NEGATIONS, _SUPPOSITIONS, _OTHER_TIMES, _REPORTS)), _HOW_AND_WHY)))
_HARMLESS = re.compile(
    _any(
        "(?:do|does|would) not (?:mind|matter|care|hesitate) | not (?:[a-z]+ )?enough | not too"
        " | no (?:matter|hurry|rush|problem|worries|time) | do not suppose | ever so | would not happen"
        " | not (?:far|much|urgent) | (?:can|could) not (?:[a-z]+ ){0,6}?(?:find|see|spot|reach|get|locate)"
        " | why do not you | if you could | i have told you | i told you"
    )
)
"""What looks like one of these and forbids nothing."""
SUBJECTS = "i|we|he|she|they|it|who|nobody|everybody|everyone|somebody|someone|people"
_ADVERBS = "just|already|always|often|about|never|really|once|usually|also|now|still"
_AUXILIARIES = (
    "will|shall|am|is|are|was|were|have|has|had|going|can|could|might|may|must|should|keeps?|did|do|does|be|"
    "(?:need|want|have|has|would like|like|love|plan|got|going|try|ought|used|about) to"
)
_FINITE = "is|are|was|were|am|has|had|have|keeps?|kept|went|a|an|the"
_OWN = re.compile(
    rf"\b(?:{SUBJECTS}|let (?:me|him|her|them))(?: (?:{_AUXILIARIES}|{_ADVERBS}))*$"
    rf"|\b(?:{_FINITE})(?: (?:{_ADVERBS}))*$"
)
"""What stands before a verb whose subject is not the robot."""
_QUESTION = re.compile(
    r"^(?:\w+ ){0,3}?(?:where(?! you)|whereabouts|what(?! (?:about|do you say|i|we)\b)|which|who|how many|count|"
    r"whether|^(?:tell|see|say|know|check)(?: me| us)? if\b(?!.* (?:could|can|should)\b)|(?:is|are) there|any "
    r"(?:sign|idea|clue|trace))\b|\bwhere(?:abouts)?$|"
    r"^(?:is|are(?! you\b)|was|were|did|does|has)\b|^(?:do|have) (?:you|we|i) (?!mind\b)|"
    r"^(?:can|could|might) (?:i|we) (?:find|see)\b"
)
"""How questions about the world begin or end."""
_REQUESTED = re.compile(
    r"^(?:is|would|could|will|can|may|might|do|are) .*\b(?:if|that|for) you\b(?! (?:are|were|have|had|did|do)\b)"
)
"""What makes a request of a question: `is it okay if you ...`."""
_WAS = frozenset({"was", "were", "had", "did"})


def forbids(text: str) -> bool:
    """Does a text forbid, suppose, report or speak of another time, so that nothing in it is asked for?"""
    return _FORBIDS.search(without_harmless(text)) is not None


def without_harmless(text: str) -> str:
    """A text without what looks as if it forbade something and does not: `no rush`, `do not hesitate`."""
    return _HARMLESS.sub(" ", text)


def is_of_others(words: Words, at: int) -> bool:
    """Does the verb say what somebody else does, or what was done?"""
    if words[at] == "let" and words[at + 1 : at + 2] in (("me",), ("him",), ("her",), ("them",)):
        return True
    past = infinitive(words[at], VERBS) != words[at] and not words[at].endswith("ing")
    return bool(_OWN.search(" ".join(words[:at]))) or (past and words[at - 1 : at] in (("you",), ("robot",)))


def is_told(words: Words) -> bool:
    """Do all verbs of the clause say what somebody else does or did?"""
    verbs = [at for at, word in enumerate(words) if classes(word)]
    own = [at for at in verbs if not is_of_others(words, at) or classes(words[at]) & {"wish", "seek"}]
    return (bool(verbs) and not own) or (not own and bool(_WAS & set(words)))


def is_asked(words: Words) -> bool:
    """Are the words a question about the world rather than a request in the form of one?"""
    text = " ".join(words)
    return words[0] not in HANDLING and _QUESTION.search(text) is not None and not _REQUESTED.search(text)
