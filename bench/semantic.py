"""The model that ranks what a sentence may mean: learnt from tests/data, measured by leaving whole lists out.

python -m bench.semantic                 # learns from all lists and writes services/planner/semantic/weights.npz
python -m bench.semantic --folds 6       # leaves lists out in turn and prints what is right of each
"""

import argparse
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import msgspec
import numpy as np
import numpy.typing as npt
from scipy.optimize import minimize
from scipy.sparse import csr_matrix

from common.plan_rules import known_world
from services.planner.grammar.chunks import Chunk, chunks
from services.planner.grammar.vocabulary import Vocabulary
from services.planner.semantic import ranker
from services.planner.semantic.features import BITS, abstracted, features
from services.planner.semantic.forms import NONE, OTHER, Candidate, candidates, tokens
from services.planner.world import believed
from tests.everyday import CONFIG, HOME, NOW, Sentence, Understood, after, lists, planned, understand, verdict

Array = npt.NDArray[Any]
RIDGE = 1.0
"""Weight of the squared weights in the loss (0.3 to 3 differ by less than a sentence in a hundred)."""
ITERATIONS = 80
"""Steps of L-BFGS (chosen: 40 more change nothing on lists left out)."""
LEAST = 2
"""Times a word is to be said to be known (chosen: what is said once stands for all unknown words)."""
PLAINLY = msgspec.structs.replace(CONFIG, guess=False)
"""Settings of a planner that does not guess, so that no guess is learnt from."""
STEPS = 127
"""Steps of an 8-bit weight."""


class Example(NamedTuple):
    """A labelled sentence of a list with its candidates; `right`: those that are planned as it means (n,)."""

    list: str
    sentence: Sentence
    words: tuple[str, ...]
    found: list[Chunk]
    meant: list[Candidate]
    right: list[bool]


def examples(of: Mapping[str, Sequence[Sentence]]) -> list[Example]:
    """All sentences of some lists that are said to a robot with nothing under way."""
    planner = _Planner()
    rows = [(number, row) for number, rows in of.items() for row in rows]
    return [e for number, row in rows if (e := planner.example(number, row)) is not None]


class _Planner:
    """What the commands come to, each planned once."""

    def __init__(self) -> None:
        self._plans: dict[tuple[str, str], Understood | None] = {}
        self._vocabularies: dict[str, Vocabulary] = {}

    def example(self, number: str, row: Sentence) -> Example | None:
        words = tokens(row.said)
        if not words or row.context.partition(":")[0] not in ("-", "held", "last", "failed"):
            return None
        found = chunks(words, self._vocabulary(row.context), pronouns=True, unlisted=True)
        meant = candidates(found)
        idle = "none()" in row.right or "refuse()" in row.right
        right = [(idle and c.form == NONE) or self._is_right(row, c, idle) for c in meant]
        right[1] = not any(right)
        assert meant[1].form == OTHER
        return Example(number, row, words, found, meant, right)

    def _is_right(self, row: Sentence, candidate: Candidate, idle: bool) -> bool:
        if not candidate.text or (idle and candidate.kind == "ask" and "answer" not in row.right):
            return False
        plan = self._plan(row.context, candidate.text)
        return plan is not None and bool(plan.steps) and verdict(row, plan) == "right"

    def _plan(self, context: str, text: str) -> Understood | None:
        if (context, text) not in self._plans:
            tag, _, about = context.partition(":")
            try:
                self._plans[context, text] = planned(text, *after(tag, about), PLAINLY)
            except AssertionError:  # the brain would object to it
                self._plans[context, text] = None
        return self._plans[context, text]

    def _vocabulary(self, context: str) -> Vocabulary:
        if context not in self._vocabularies:
            tag, _, about = context.partition(":")
            objects, held, history = after(tag, about)
            told = known_world(HOME, [o.label for o in objects], held)
            world = believed(HOME, told, objects, (0.0, 0.0, 0.0), NOW, history)
            self._vocabularies[context] = Vocabulary(world, CONFIG)
        return self._vocabularies[context]


def known_words(learnt_from: Sequence[Example]) -> frozenset[str]:
    """Words that are said often enough to be told apart."""
    said = Counter(word for e in learnt_from for word in set(e.words))
    return frozenset(word for word, times in said.items() if times >= LEAST)


class _Table(NamedTuple):
    """Candidates of all examples one below the other: features (n, 2**BITS), first row of each example, the right."""

    counts: csr_matrix
    starts: Array
    right: Array

    @property
    def of(self) -> Array:
        """The example of each row."""
        return np.repeat(np.arange(len(self.starts)), np.diff([*self.starts, len(self.right)]))

    def shares(self, scores: Array) -> Array:
        raised = np.exp(scores - np.maximum.reduceat(scores, self.starts)[self.of])
        return np.asarray(raised / np.add.reduceat(raised, self.starts)[self.of])


def _table(rows: Sequence[Example], words: frozenset[str]) -> _Table:
    columns: list[int] = []
    ends, starts = [0], []
    for row in rows:
        starts.append(len(ends) - 1)
        said = abstracted(row.words, row.found, words)
        for candidate in row.meant:
            columns += features(said, candidate)
            ends.append(len(columns))
    counts = csr_matrix((np.ones(len(columns), np.float32), columns, ends), shape=(len(ends) - 1, 1 << BITS))
    return _Table(counts, np.array(starts), np.array([r for row in rows for r in row.right]))


def learn(rows: Sequence[Example]) -> tuple[npt.NDArray[np.float32], frozenset[str]]:
    """Weights that make the right candidates most likely, and the words that are known.

    The loss is the negative logarithm of the probability of all right candidates together, with a ridge.
    """
    words = known_words(rows)
    table = _table(rows, words)
    turned = table.counts.T.tocsr()

    def loss(weights: Array) -> tuple[float, Array]:
        shares = table.shares(table.counts @ weights.astype(np.float32))
        good = np.add.reduceat(shares * table.right, table.starts) + 1e-12  # never the logarithm of 0
        slope = shares - shares * table.right / good[table.of]
        value = -np.log(good).sum() + RIDGE / 2 * weights @ weights
        return float(value), turned @ slope.astype(np.float32) + RIDGE * weights

    found = minimize(
        loss, np.zeros(1 << BITS), jac=True, method="L-BFGS-B", options={"maxiter": ITERATIONS, "maxcor": 5}
    )
    return found.x.astype(np.float32), words


def left_out(rows: Sequence[Example], folds: int) -> dict[str, Counter[str]]:
    """Verdicts of each list on what the planner makes of it with a model that has seen nothing of it."""
    sizes = Counter(e.list for e in rows)
    groups: list[list[str]] = [[] for _ in range(folds)]
    for number, _ in sizes.most_common():
        min(groups, key=lambda g: sum(sizes[n] for n in g)).append(number)
    found: dict[str, Counter[str]] = {}
    every = lists()
    for group in groups:
        ranker.use(ranker.Ranker(*learn([e for e in rows if e.list not in group])))
        for number in group:
            found[number] = Counter(verdict(row, understand(row)) for row in every[number])
    return found


def save(weights: npt.NDArray[np.float32], words: frozenset[str], path: Path) -> None:
    """Write the model as `Ranker.shipped` reads it."""
    scale = np.float32(np.abs(weights).max() / STEPS)
    said = np.frombuffer(" ".join(sorted(words)).encode(), np.uint8)
    np.savez_compressed(path, weights=np.round(weights / scale).astype(np.int8), scale=scale, words=said)


def _report(found: dict[str, Counter[str]]) -> None:
    kinds = ("right", "asked rightly", "asked back", "not understood", "wrong")
    print(f"{'list':4}", *(f"{kind:>14}" for kind in kinds))
    for number, counts in [*sorted(found.items()), ("all", sum(found.values(), Counter()))]:
        print(f"{number:4}", *(f"{counts[kind]:14}" for kind in kinds))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--folds", type=int, default=0, help="groups of lists left out in turn; 0: learn from all")
    args = parser.parse_args()
    rows = examples(lists())
    if args.folds:
        _report(left_out(rows, args.folds))
        return
    path = Path(ranker.__file__).parent / ranker.WEIGHTS
    save(*learn(rows), path)
    print(f"{path}: {path.stat().st_size // 1000} kB, learnt from {len(rows)} sentences")


if __name__ == "__main__":
    main()
