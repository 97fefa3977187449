"""Who is to act, and when: what forbids, supposes, reports or tells of others is no request to the robot. Pure."""

import re

from common.language.normalise import Words, infinitive
from common.language.verb_classes import VERBS, classes

_TELLERS = "i|we|he|she|they|it|who|nobody|everybody|everyone|somebody|someone|people"
_FORBIDS = re.compile(
    r"\b(?:not|never|nobody|none|nothing|no one|without|stop|leave|hands off|forbid|forbidden|allowed|hate|no reason|"
    r"wrong)\b|\b(?:suppose|supposing|imagine|pretend|if (?:i|you|he|she|we|they) (?:were|was|had|could)|used to|"
    r"tomorrow|tonight|yesterday|already|ago|ever|(?:last|next) (?:week|night|year|month|time)|this morning|later|"
    r"(?:would|could|should|might|must) (?:not )?have)\b|\b(?:said|says|saying|told|claims?|heard|thinks?|thought|joke|"
    r"story|song|poem)\b|\b(?:wants?|asks?|asked|begged|tells?) (?:me|him|her|them|us) to\b|"
    r"\b(?:how|why)\b(?! (?:many|about|not|do not|do you not)\b).* (?:did|do|would|should|could|to)\b"
)
_HARMLESS = re.compile(
    r"\b(?:(?:do|does|would) not (?:mind|matter|care|hesitate)|no (?:matter|hurry|rush|problem|worries|time)|not too|"
    r"(?:can|could) not (?:\w+ ){0,6}?(?:find|see|spot|reach|get|locate)|why do not you|if you could|"
    r"i have told you|i told you|not (?:far|much|urgent))\b"
)
"""Negations that forbid nothing."""
_ADVERBS = "just|already|always|often|about|never|really|once|usually|also|now|still"
_OWN = re.compile(
    rf"\b(?:{_TELLERS})(?: (?:will|shall|am|is|are|was|were|have|has|had|going|can|could|might|may|must|should|keeps?|"
    rf"did|do|does|be|(?:need|want|have|has|would like|like|love|plan|got|going|try|ought|used) to|{_ADVERBS}))*$"
    rf"|\b(?:is|are|was|were|am|has|had|have|keeps?|kept|went|a|an|the)(?: (?:{_ADVERBS}))*$"
)
"""What stands before a verb whose subject is not the robot."""
_WAS = frozenset({"was", "were", "had", "did"})


def forbids(text: str) -> bool:
    """Does a text forbid, suppose, report or speak of another time, so that nothing in it is asked for?"""
    return _FORBIDS.search(_HARMLESS.sub(" ", text)) is not None


def is_of_others(words: Words, at: int) -> bool:
    """Does the verb say what somebody else does, or what was done?"""
    past = infinitive(words[at], VERBS) != words[at] and not words[at].endswith("ing")
    return bool(_OWN.search(" ".join(words[:at]))) or (past and words[at - 1 : at] in (("you",), ("robot",)))


def is_told(words: Words) -> bool:
    """Do all verbs of the clause say what somebody else does or did?"""
    verbs = [at for at, word in enumerate(words) if classes(word)]
    own = [at for at in verbs if not is_of_others(words, at) or classes(words[at]) & {"wish", "seek"}]
    return (bool(verbs) and not own) or (not own and bool(_WAS & set(words)))
