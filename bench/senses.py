"""The models of what is said to a robot at work, or answers its question: learnt from tests/data.

python -m bench.senses                     # learns and writes services/brain/language/at_work.npz and answers.npz
python -m bench.senses --without 36 37     # learns from all the others
python -m bench.senses --apart L4 --apart L2 L3   # what wordings and model make of lists that it has not seen
"""

import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

from bench import log_linear
from common.language.log_linear import LogLinear
from evaluation.everyday.sentences import all_lists
from services.brain.language import senses
from services.brain.language.dialogue import SURE as SURE_OF_ANSWERS
from services.brain.language.dialogue import by_wording as answer
from services.brain.language.interjection import by_wording as interjection
from services.brain.language.senses import ANSWERS, AT_WORK, Senses

_AT_WORK = {"answer": "aside", "refuse": "aside", "none": "idle", "return": "replace", "pause": "stop"}
"""The sense of an act of the notation at work, where it is none itself."""
_ANSWERS = {"yes": "yes", "no": "no", "stop": "no", "none": "idle", "answer": "idle"}
"""The sense of an act of the notation in an answer; all others correct."""
_OF_KIND = {"cancel": "stop", "come_back": "replace", "encouragement": "idle"}
"""The sense of a kind of interjection, where it is none itself."""


Worded = tuple[str, str, dict[str, float]]
"""The kind of a sentence by its wording, its sense, and how likely each other sense has to be to outweigh it."""


class Said(NamedTuple):
    """`right`: senses that a sentence may have; `wording`: its sense by the wordings, `least`: what outweighs it."""

    list: str
    heard: senses.Heard
    wording: str
    least: dict[str, float]
    right: frozenset[str]


def _at_work(said: str, doing: str) -> Worded:
    found, least = interjection(said, doing)
    return found.kind, _OF_KIND.get(found.kind, found.kind), dict.fromkeys(AT_WORK.senses, least)


def _answer(said: str, asked: str) -> Worded:
    kind = answer(said)[0]
    return kind, "no" if kind == "cancel" else kind, dict(SURE_OF_ANSWERS) if kind == "correction" else {}


MODELS: list[tuple[str, Senses, dict[str, str], Callable[[str, str], Worded]]] = [
    ("busy", AT_WORK, _AT_WORK, _at_work),
    ("heard", ANSWERS, _ANSWERS, _answer),
]
"""Context of tests/data, model, the senses of the notation's acts, and the kind, sense and least by wordings."""


def sentences(tag: str, model: Senses, of_act: dict[str, str], wording: Callable[..., Worded]) -> list[Said]:
    """All that was said in a context and has one of the senses."""
    found = []
    for number, rows in all_lists().items():
        for row in rows:
            context, _, about = row.context.partition(":")
            if context != tag:
                continue
            acts = re.findall(r"(?:^|\|\|) *(\w+)", row.right)
            right = frozenset(of_act.get(act, "correction" if model is ANSWERS else act) for act in acts)
            if right <= set(model.senses):
                kind, sense, least = wording(row.said, about)
                found.append(Said(number, senses.heard(row.said, about, kind), sense, least, right))
    return found


def learn(model: Senses, rows: Sequence[Said]) -> LogLinear:
    """The model that makes the right senses most likely."""
    words = log_linear.known_words(row.heard.words for row in rows)
    examples = [
        log_linear.Example(
            model.options(row.heard, words), model.embedding(row.heard), [sense in row.right for sense in model.senses]
        )
        for row in rows
    ]
    return log_linear.learn(examples, words)


def _apart(model: Senses, rows: Sequence[Said], lists: Sequence[str]) -> None:
    """Print how much of some lists the wordings, and the wordings and a model of the others together, take rightly."""
    learnt = learn(model, [row for row in rows if row.list not in lists])
    unseen = [row for row in rows if row.list in lists]
    wordings = both = false_yes = 0
    for row in unseen:
        sense, p = model.chosen(row.heard, learnt)
        taken = sense if p >= row.least.get(sense, 2.0) else row.wording
        wordings += row.wording in row.right
        both += taken in row.right
        false_yes += taken == "yes" and "yes" not in row.right
    print(f"{model.weights:12} {' '.join(lists):26} {len(unseen):5} sentences, by wordings {wordings:4}, "
          f"with the model {both:4}, yes for something else {false_yes}")  # fmt: skip


def main() -> None:
    parser = log_linear.arguments(__doc__)
    parser.add_argument("--apart", nargs="+", action="append", metavar="LIST", help="lists to leave out and measure")
    args = parser.parse_args()
    for tag, model, of_act, wording in MODELS:
        rows = [row for row in sentences(tag, model, of_act, wording) if row.list not in args.without]
        for lists in args.apart or ():
            _apart(model, rows, lists)
        if not args.apart:
            log_linear.save(learn(model, rows), Path(senses.__file__).with_name(model.weights), len(rows))


if __name__ == "__main__":
    main()
