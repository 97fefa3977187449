"""Who is to act, and when: what forbids, supposes, reports or tells of others is no request to the robot. Pure."""

import re

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
_WAS = frozenset({"was", "were", "had", "did"})


def forbids(text: str) -> bool:
    """Does a text forbid, suppose, report or speak of another time, so that nothing in it is asked for?"""
    return _FORBIDS.search(_HARMLESS.sub(" ", text)) is not None


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
