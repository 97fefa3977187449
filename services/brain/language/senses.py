"""How words are most likely meant that reach a robot at work, or answer its question: models learnt from tests/data.

`python -m bench.senses` learns them. The weights are read at the first sentence.
"""

from collections.abc import Iterator
from functools import cached_property
from importlib.resources import files
from itertools import pairwise
from typing import NamedTuple

from common.language.clauses import without_fillers
from common.language.contractions import expand
from common.language.embedding import beside_features
from common.language.exchange import PREPOSITIONS
from common.language.lexicon import COMMANDING
from common.language.log_linear import UNKNOWN, Floats, LogLinear, Option, hashed
from common.language.meaning import is_question
from common.language.mood import forbids
from common.language.normalise import DETERMINERS, normalise

_STEM = 4
"""First letters that the forms of a word share (as of the planner's model)."""
_THIRDS, _LONG, _SHARED = 3, 5, 3
"""Steps in which lengths are told apart: by three words up to 15; most shared words that are counted (chosen)."""


class Heard(NamedTuple):
    """`words` of what was said, `shared` those of the command it is about, `kind` what the wordings take it for."""

    said: str
    words: tuple[str, ...]
    about: str
    shared: frozenset[str]
    kind: str


def heard(said: str, about: str, kind: str) -> Heard:
    """What was said, the command that is under way or was asked about, and what the wordings take it for."""
    words = without_fillers(expand(normalise(said, ","))).replace(",", " ,").split()
    small = DETERMINERS | PREPOSITIONS | {"me", "us", "and"}
    return Heard(said, tuple(words), about, frozenset(expand(normalise(about)).split()) - small, kind)


class Senses:
    """One of several `senses` of words: `weights` beside this module; `situation`: what the robot has said before."""

    def __init__(self, weights: str, situation: str, senses: tuple[str, ...]) -> None:
        self.weights, self.senses, self._situation = weights, senses, situation

    def options(self, said: Heard, known: frozenset[str]) -> list[Option]:
        """The senses as the model sees them; words that are not `known` count as one."""
        names = list(_names(said, known))
        return [Option(sense, hashed(f"{sense} {name}" for name in names)) for sense in self.senses]

    def embedding(self, said: Heard) -> Floats:
        """Of what was said alone, and after what the robot has said before: (2 * embedding.SIZE,)."""
        words = normalise(said.said)
        return beside_features(words, f"{self._situation.format(said.about)} {words}")

    def likeliest(self, said: str, about: str, kind: str) -> tuple[str, float]:
        """The likeliest sense, and with how much probability."""
        return self.chosen(heard(said, about, kind), self._shipped)

    def chosen(self, said: Heard, model: LogLinear) -> tuple[str, float]:
        """The same by another model than the shipped one."""
        p = model.probabilities(self.options(said, model.words), self.embedding(said))
        best = int(p.argmax())
        return self.senses[best], float(p[best])

    @cached_property
    def _shipped(self) -> LogLinear:
        return LogLinear.load(files(__package__) / self.weights)


AT_WORK = Senses("at_work.npz", "i am about to: {}.", ("stop", "queue", "replace", "aside", "idle"))
"""To stop, for later, instead, a question; or nothing that is meant for the robot or asks for anything."""
ANSWERS = Senses("answers.npz", "do you mean: {}?", ("yes", "no", "correction", "idle"))
"""Yes, no, something else that is to be done; or nothing that answers."""


def _names(said: Heard, known: frozenset[str]) -> Iterator[str]:
    """Words, stems, pairs and triples, those of the command as one; and what the rules of language see."""
    words = said.words
    marks = ["<begin>", *("#same" if w in said.shared else w if w in known else UNKNOWN for w in words), "<end>"]
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
    yield f"kind {said.kind}"
    yield f"question {is_question(said.said)}"
    yield f"forbids {forbids(bare)}"
    yield f"verb {next((word for word in words if word in COMMANDING), '')}"
    yield f"begins {words[:1] != () and words[0] in COMMANDING}"
