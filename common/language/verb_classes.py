"""What a verb asks for, by classes of verbs: many more than the wordings know, for readings that are asked about first.

The classes are those of Levin, "English Verb Classes and Alternations", 1993, as far as the robot can do what they ask.
"""

from typing import Literal

from common.language.lexicon import BRING, COMMANDING, DISCARD, FETCH, GO, MOVE, PUT, SEEK, THROW, TIDY
from common.language.normalise import infinitive

VerbClass = Literal["bring", "wish", "put", "discard", "tidy", "go", "seek", "hold", "look", "say", "wait"]
_WORDS: dict[VerbClass, str] = {
    "bring": f"{BRING} {FETCH} provide supply serve offer obtain procure send reach convey ferry lug haul cart "
    "transport shuttle scoop nab snag bag fish nick whip dig run furnish drag rustle produce return pull",
    "wish": "want need require wish fancy crave desire prefer borrow",
    "put": f"{PUT} {MOVE} deposit park rest settle position locate install arrange pile line store shelve restore "
    "replace lean lie let make hang keep insert load lodge bung whack prop bring take run ferry lug cart transport "
    "house home go belong stand sit live end land",
    "discard": f"{THROW} {DISCARD} scrap dump eliminate lose banish rid relieve",
    "tidy": f"{TIDY} order sort smarten spruce neaten arrange empty fix straighten freshen unclutter restore free",
    "go": f"go {GO} {MOVE} toddle trot trundle scoot zoom race march saunter amble shuffle potter skip cruise journey "
    "venture visit approach swing shoot appear report join advance relocate creep glide edge park position bring get "
    "scurry scuttle scamper trek tootle whizz zip be stand meet withdraw retire repair retreat",
    "seek": f"{SEEK} search look hunt trace detect discover identify spy uncover scout rummage pinpoint lost misplaced "
    "mislaid missing",
    "hold": "pick lift hold grasp grip grab clutch seize take raise clasp",
    "look": "look peek peep glance survey scan inspect check examine explore nose watch snoop investigate",
    "wait": "wait stay remain pause linger rest",
    "say": "say announce tell shout proclaim declare utter call yell broadcast inform speak spread",
}
"""Verbs and their particles, which are taken out below."""
_PARTICLES = frozenset({"of", "for", "up", "down", "out", "me", "off", "|"})
_CLASSES: dict[VerbClass, frozenset[str]] = {
    name: frozenset(words.split()) - _PARTICLES for name, words in _WORDS.items()
}
VERBS: frozenset[str] = frozenset[str]().union(*_CLASSES.values())


def one_of(name: VerbClass) -> str:
    """Regular expression for a verb of the class that no wording begins with, and that asks for nothing else."""
    return "|".join(sorted(_CLASSES[name] - COMMANDING - {"be", "make", "let", "keep"}))


def classes(word: str) -> frozenset[VerbClass]:
    """What a verb, in any of its forms, can ask for; empty for words that are no such verb."""
    stem = infinitive(word, VERBS)
    forms = {stem, stem.removesuffix("s"), stem.removesuffix("es")}
    return frozenset(name for name, verbs in _CLASSES.items() if forms & verbs)
