"""The network that ranks what a sentence may mean: learnt from tests/data, measured on lists left out.

python -m bench.semantic                 # learns from all lists and writes services/planner/semantic/weights.npz
python -m bench.semantic --without 36 37 # learns from all the others, and prints what becomes of these

It takes about an hour on two cores, and torch, which nothing else needs and no lock file has:
.venv/bin/pip install torch --index-url https://download.pytorch.org/whl/cpu
"""

import importlib.util
import os
import re
import sys
from collections import Counter
from collections.abc import Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from bench import log_linear
from bench.labelled import Labelled
from common.plan_rules import known_world
from evaluation.everyday.flat import CONFIG, HOME, NOW, PLAINLY
from evaluation.everyday.notation import verdict
from evaluation.everyday.sentences import Sentence, all_lists
from evaluation.everyday.understanding import Understood, after, at_rest, planned, understand
from services.planner.grammar.vocabulary import Vocabulary
from services.planner.semantic import ranker
from services.planner.semantic.forms import FORMS, NONE, OTHER, Candidate, Deed, candidates, tokens
from services.planner.world import believed

_DEEDS: dict[str, set[Deed]] = {
    "fetch": {"bring"}, "put": {"put"}, "tidy": {"put"}, "rule": {"put"}, "take": {"take"}, "drop": {"put", "fingers"},
    "grip": {"fingers"}, "goto": {"go"}, "return": {"go"}, "find": {"go"}, "look": {"go"}, "wait": {"wait"},
    "say": {"say"}, "teach": {"name"}, "place": {"name"}, "forget": {"name"}, "norule": {"name"},
}  # fmt: skip
"""What is done for the acts of the notation, so that only such candidates are planned."""


def examples(of: Mapping[str, Sequence[Sentence]], jobs: int = 1) -> list[Labelled]:
    """All sentences of some lists that are said to a robot with nothing under way, worked out by `jobs` processes."""
    rows = [(number, row) for number, rows in of.items() for row in rows]
    shares = [rows[n::jobs] for n in range(jobs)]
    if jobs == 1:
        return _labelled(rows)
    with ProcessPoolExecutor(jobs) as pool:
        return [e for share in pool.map(_labelled, shares) for e in share]


def _labelled(rows: Sequence[tuple[str, Sentence]]) -> list[Labelled]:
    planner = _Planner()
    return [e for number, row in rows if (e := planner.example(number, row)) is not None]


class _Planner:
    """What the commands come to, each planned once."""

    def __init__(self) -> None:
        self._plans: dict[tuple[str, str], Understood | None] = {}
        self._vocabularies: dict[str, Vocabulary] = {}

    def example(self, number: str, row: Sentence) -> Labelled | None:
        row = at_rest(row)
        words = tokens(row.said)
        if not words or row.context.partition(":")[0] not in ("-", "held", "last", "failed", "instead"):
            return None
        vocabulary = self._vocabulary(row.context)
        found = ranker.named(words, vocabulary)
        meant = candidates(words, found, vocabulary.before)
        idle = "none()" in row.right or "refuse()" in row.right
        right = [(idle and c.form == NONE) or self._is_right(row, c, idle) for c in meant]
        right[1] = not any(right)
        assert meant[1].form == OTHER
        return Labelled(number, words, found, meant, right, vocabulary.situation)

    def _is_right(self, row: Sentence, candidate: Candidate, idle: bool) -> bool:
        if not candidate.text or not _may_be(row, candidate, idle):
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


def _may_be(row: Sentence, candidate: Candidate, idle: bool) -> bool:
    """Does a candidate do or ask anything of what is right, so that it is worth planning?"""
    acts = set(re.findall(r"(\w+)\(", row.right))
    if candidate.kind == "ask" and "answer" in acts:
        return True
    if idle and (candidate.kind == "ask" or acts <= {"none", "refuse"}):
        return False
    deed = FORMS[candidate.form].deed
    return not deed or any(deed in _DEEDS.get(act, set()) for act in acts)


def _report(apart: Sequence[str]) -> None:
    """Verdicts of lists on what the planner makes of them."""
    kinds = ("right", "asked rightly", "asked back", "not understood", "wrong")
    print(f"{'list':4}", *(f"{kind:>14}" for kind in kinds))
    for number in apart:
        counts = Counter(verdict(row, understand(row)) for row in all_lists()[number])
        print(f"{number:4}", *(f"{counts[kind]:14}" for kind in kinds))


def main() -> int:
    args = log_linear.arguments(__doc__).parse_args()
    if importlib.util.find_spec("torch") is None:
        print("torch is missing: python -m bench.semantic --help tells where it is to be had", file=sys.stderr)
        return 2
    from bench.semantic_network import learn

    rows = examples({n: of for n, of in all_lists().items() if n not in args.without}, os.cpu_count() or 1)
    log_linear.save(learn(rows), Path(ranker.__file__).with_name(ranker.WEIGHTS), len(rows))
    _report(args.without)
    return 0


if __name__ == "__main__":
    sys.exit(main())
