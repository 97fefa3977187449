"""Which of the table's wordings a text is. Pure."""

import re
from collections.abc import Iterator
from functools import lru_cache

from common.language.clauses import without_fillers
from common.language.contractions import expand
from common.language.itself import WORDS as OF_ITSELF
from common.language.itself import about_itself
from common.language.normalise import DETERMINERS, REMEMBERED, Words, normalise
from common.language.noun_phrase import SIDES, SMALL, WHICH
from common.language.pattern import ANY, Pattern, Slots, first_words, words_of
from common.language.politeness import without_politeness
from common.language.refusals import REFUSALS
from common.language.wording import QUESTIONS, Action, Kind, Wording
from common.language.wordings import WORDINGS

_INTERROGATIVE = re.compile(
    r"^(?:(?:tell me |remind me |do you know )?(?:what(?! about)|where|who|whose|why|which|when did|how(?! about))"
    r"|is|are|was|were|did|does|has|have you|do (?:you|we) (?:see|know|have|remember))\b"
)
"""How questions begin that are no orders in the form of one."""
_RULES = tuple((wording, Pattern(wording.pattern)) for wording in WORDINGS)
VERBS: frozenset[str] = frozenset[str]().union(*(first_words(p.tree) for w, p in _RULES if w.kind == "command")) - {
    "",
    ANY,
}
"""Words with which a command may begin."""


WORDS: frozenset[str] = frozenset[str]().union(
    *(words_of(p.tree) for w, p in _RULES if w not in REFUSALS), OF_ITSELF, DETERMINERS, WHICH, SIDES, *SMALL
)
"""Words of the wordings that ask for something and between nouns: all but names and colours."""
REFUSED: frozenset[str] = frozenset[str]().union(*(words_of(p.tree) for w, p in _RULES if w in REFUSALS))
"""Words of the wordings that ask for what the robot cannot do."""


def readings(words: Words, *kinds: Kind) -> Iterator[tuple[Wording, Slots]]:
    """Every way in which a wording of one of the `kinds` fits the words of a whole clause, in the table's order."""
    if "command" in kinds and (action := about_itself(words)) is not None:
        yield Wording(action, ""), {}
    for wording, pattern in _RULES:
        if wording.kind in kinds:
            for slots in pattern.matches(words):
                yield wording, slots


@lru_cache(REMEMBERED)
def asks_for(text: str, *actions: Action) -> Action | None:
    """The first of the `actions` that a whole text asks for, with or without politeness; None if it asks for none."""
    whole = without_fillers(expand(normalise(text)))
    said = {tuple(whole.split()), tuple(without_politeness(whole).split())}
    for action in actions:
        if action in map(about_itself, said):
            return action
        for wording, pattern in _RULES:
            if wording.action == action and any(next(pattern.matches(words), None) is not None for words in said):
                return action
    return None


def is_question(text: str) -> bool:
    """Is a whole text answered in words alone, whatever it is about?"""
    bare = expand(without_fillers(normalise(text)))
    return asks_for(text, *QUESTIONS) is not None or _INTERROGATIVE.match(without_politeness(bare)) is not None


def heard_parts() -> dict[str, list[str]]:
    """What speech listens for: the parts `<verb>` (commands) and `<utterance>` (what is said by itself) as patterns."""
    parts: dict[str, list[str]] = {"verb": [], "utterance": []}
    for wording in WORDINGS:
        if wording.heard:
            parts["verb" if wording.kind == "command" else "utterance"].append(wording.heard)
    return parts
