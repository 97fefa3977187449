"""How the models of common/language/log_linear.py are learnt: from which options of each example are right."""

from argparse import ArgumentParser, RawDescriptionHelpFormatter
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.optimize import minimize
from scipy.sparse import csr_matrix

from common.language.log_linear import BITS, LogLinear, Option
from services.planner.semantic.network import Network

Array = npt.NDArray[Any]
RIDGE = 2.0
"""Weight of the squared weights in the loss (chosen on lists left out: less is surer of what is wrong)."""
ITERATIONS = 80
"""Steps of L-BFGS (chosen: 40 more change nothing on lists left out)."""
LEAST = 2
"""Times a word is to be said to be known (chosen: what is said once stands for all unknown words)."""


class Example(NamedTuple):
    """What a text may mean: `embedding` of the text (D,), `right`: which of the options are (n,)."""

    options: Sequence[Option]
    embedding: Array
    right: Sequence[bool]


def known_words(sentences: Iterable[Sequence[str]]) -> frozenset[str]:
    """Words that are said often enough to be told apart."""
    said = Counter(word for words in sentences for word in set(words))
    return frozenset(word for word, times in said.items() if times >= LEAST)


def arguments(doc: str | None) -> ArgumentParser:
    """Of what learns a model from the lists of sentences."""
    parser = ArgumentParser(description=doc, formatter_class=RawDescriptionHelpFormatter)
    parser.add_argument("--without", nargs="*", default=[], metavar="LIST", help="lists that nothing is learnt from")
    return parser


def save(model: LogLinear | Network, path: Path, learnt_from: int) -> None:
    """Write a model beside the code that reads it."""
    model.save(path)
    print(f"{path}: {path.stat().st_size // 1000} kB, learnt from {learnt_from} sentences")


def learn(examples: Sequence[Example], words: frozenset[str]) -> LogLinear:
    """Weights that make the right options most likely.

    The loss is the negative logarithm of the probability of all right options together, with a ridge.
    """
    forms = sorted({option.form for e in examples for option in e.options})
    table = _Table(examples, forms)

    def loss(weights: Array) -> tuple[float, Array]:
        sparse, dense = weights[: 1 << BITS], weights[1 << BITS :].reshape(len(forms), -1).astype(np.float32)
        shares = table.shares(table.counts @ sparse.astype(np.float32) + table.of_forms(dense))
        good = np.add.reduceat(shares * table.right, table.starts) + 1e-12  # never the logarithm of 0
        slope = (shares - shares * table.right / good[table.of]).astype(np.float32)
        slopes = np.concatenate([table.turned @ slope, table.slope_of_forms(slope).ravel()])
        return float(-np.log(good).sum() + RIDGE / 2 * weights @ weights), slopes + RIDGE * weights

    begin = np.zeros((1 << BITS) + len(forms) * table.embeddings.shape[1])
    found = minimize(loss, begin, jac=True, method="L-BFGS-B", options={"maxiter": ITERATIONS, "maxcor": 5})
    weights = found.x.astype(np.float32)
    return LogLinear(weights[: 1 << BITS], weights[1 << BITS :].reshape(len(forms), -1), forms, words)


class _Table:
    """All options of all examples one below the other.

    `counts` (n, 2**BITS) features; `starts` the first row, and `of` each row the number, of an example.
    """

    def __init__(self, examples: Sequence[Example], forms: Sequence[str]) -> None:
        options = [option for e in examples for option in e.options]
        sizes = [len(e.options) for e in examples]
        columns = np.concatenate([np.array(o.features, np.int32) for o in options])
        ends = np.cumsum([0, *(len(o.features) for o in options)])
        self.counts = csr_matrix((np.ones(len(columns), np.float32), columns, ends), shape=(len(options), 1 << BITS))
        self.turned = self.counts.T.tocsr()
        self.starts = np.cumsum([0, *sizes[:-1]])
        self.of = np.repeat(np.arange(len(examples)), sizes)
        self.right = np.array([r for e in examples for r in e.right])
        self.embeddings = np.array([e.embedding for e in examples], np.float32)
        row = {form: number for number, form in enumerate(forms)}
        self._form = np.array([row[o.form] for o in options])
        self._forms = len(forms)

    def shares(self, scores: Array) -> Array:
        """Probability of each option in its example."""
        raised = np.exp(scores - np.maximum.reduceat(scores, self.starts)[self.of])
        return np.asarray(raised / np.add.reduceat(raised, self.starts)[self.of])

    def of_forms(self, dense: Array) -> Array:
        """What the embeddings count for each option."""
        return np.asarray((self.embeddings @ dense.T)[self.of, self._form])

    def slope_of_forms(self, slope: Array) -> Array:
        """Derivative by `dense` of a sum whose derivative by each option's score is `slope`."""
        each = np.zeros((len(self.embeddings), self._forms), np.float32)
        np.add.at(each, (self.of, self._form), slope)
        return np.asarray(each.T @ self.embeddings)
