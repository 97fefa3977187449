"""Which of the table's wordings a text is. Pure."""

from collections.abc import Iterator

from common.language.normalise import Words, expand, normalise, without_fillers, without_politeness
from common.language.pattern import ANY, Pattern, Slots, first_words
from common.language.wordings import WORDINGS, Action, Kind, Wording

_RULES = tuple((wording, Pattern(wording.pattern)) for wording in WORDINGS)
VERBS: frozenset[str] = frozenset[str]().union(*(first_words(p.tree) for w, p in _RULES if w.kind == "command")) - {
    "",
    ANY,
}
"""Words with which a command may begin."""


def readings(words: Words, *kinds: Kind) -> Iterator[tuple[Wording, Slots]]:
    """Every way in which a wording of one of the `kinds` fits the words of a whole clause, in the table's order."""
    for wording, pattern in _RULES:
        if wording.kind in kinds:
            for slots in pattern.matches(words):
                yield wording, slots


def asks_for(text: str, *actions: Action) -> Action | None:
    """The first of the `actions` that a whole text asks for, with or without politeness; None if it asks for none."""
    whole = without_fillers(expand(normalise(text)))
    said = {tuple(whole.split()), tuple(without_politeness(whole).split())}
    for action in actions:
        for wording, pattern in _RULES:
            if wording.action == action and any(next(pattern.matches(words), None) is not None for words in said):
                return action
    return None


def heard_parts() -> dict[str, list[str]]:
    """What speech listens for: the parts `<verb>` (commands) and `<utterance>` (what is said by itself) as patterns."""
    parts: dict[str, list[str]] = {"verb": [], "utterance": []}
    for wording in WORDINGS:
        if heard := wording.pattern if wording.heard is None else wording.heard:
            parts["verb" if wording.kind == "command" else "utterance"].append(heard)
    return parts
