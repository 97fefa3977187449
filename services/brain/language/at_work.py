"""How words that reach a robot at work are most likely meant: a log-linear model learnt from tests/data.

`python -m bench.interjections` learns it. The weights are read at the first sentence.
"""

from collections.abc import Iterator
from functools import cache
from importlib.resources import files
from itertools import pairwise
from typing import Literal, NamedTuple, get_args

from common.language.clauses import without_fillers
from common.language.contractions import expand
from common.language.embedding import beside_features
from common.language.exchange import PREPOSITIONS
from common.language.lexicon import COMMANDING
from common.language.log_linear import UNKNOWN, Floats, LogLinear, Option, hashed
from common.language.meaning import is_question
from common.language.mood import forbids
from common.language.normalise import DETERMINERS, normalise

Sense = Literal["stop", "queue", "replace", "aside", "idle"]
"""To stop, for later, instead, a question; or nothing that is meant for the robot or asks for anything."""
SENSES: tuple[Sense, ...] = get_args(Sense)
WEIGHTS = "at_work.npz"
"""Beside this module: what `LogLinear.save` wrote."""
_STEM = 4
"""First letters that the forms of a word share (as of the planner's model)."""
_THIRDS, _LONG, _SHARED = 3, 5, 3
"""Steps in which lengths are told apart: by three words up to 15; most shared words that are counted (chosen)."""


class Interrupting(NamedTuple):
    """`words` of what was said, `doing` those of the command under way, `kind` what the wordings take it for."""

    said: str
    words: tuple[str, ...]
    doing: frozenset[str]
    kind: str


def interrupting(said: str, doing: str, kind: str) -> Interrupting:
    """What was said while a command was under way, and what the wordings take it for."""
    words = without_fillers(expand(normalise(said, ","))).replace(",", " ,").split()
    small = DETERMINERS | PREPOSITIONS | {"me", "us", "and"}
    return Interrupting(said, tuple(words), frozenset(expand(normalise(doing)).split()) - small, kind)


def options(heard: Interrupting, known: frozenset[str]) -> list[Option]:
    """The senses as the model sees them; words that are not `known` count as one."""
    names = list(_names(heard, known))
    return [Option(sense, hashed(f"{sense} {name}" for name in names)) for sense in SENSES]


def embedding(heard: Interrupting, doing: str) -> Floats:
    """Of what was said alone, and after the command under way: (2 * embedding.SIZE,)."""
    said = normalise(heard.said)
    return beside_features(said, f"i am about to: {doing}. {said}")


def likeliest(said: str, doing: str, kind: str) -> tuple[Sense, float]:
    """The likeliest sense, and with how much probability."""
    heard = interrupting(said, doing, kind)
    model = _shipped()
    p = model.probabilities(options(heard, model.words), embedding(heard, doing))
    best = int(p.argmax())
    return SENSES[best], float(p[best])


def _names(heard: Interrupting, known: frozenset[str]) -> Iterator[str]:
    """Words, stems, pairs and triples, those of the command under way as one; and what the rules of language see."""
    words = heard.words
    marks = ["<begin>", *("#same" if w in heard.doing else w if w in known else UNKNOWN for w in words), "<end>"]
    for mark in sorted(set(marks)):
        yield f"1 {mark}"
    for stem in sorted({mark[:_STEM] for mark in marks}):
        yield f"stem {stem}"
    for first, second in pairwise(marks):
        yield f"2 {first} {second}"
    for triple in zip(marks, marks[1:], marks[2:], strict=False):
        yield f"3 {' '.join(triple)}"
    yield f"length {min(len(words) // _THIRDS, _LONG)}"
    yield f"same {min(marks.count('#same'), _SHARED)}"
    bare = " ".join(word for word in words if word != ",")
    yield f"kind {heard.kind}"
    yield f"question {is_question(heard.said)}"
    yield f"forbids {forbids(bare)}"
    yield f"verb {next((word for word in words if word in COMMANDING), '')}"
    yield f"begins {words[:1] != () and words[0] in COMMANDING}"


@cache
def _shipped() -> LogLinear:
    return LogLinear.load(files(__package__) / WEIGHTS)
