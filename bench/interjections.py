"""The model of what is said to a robot at work: learnt from tests/data, measured by leaving whole lists out.

python -m bench.interjections                     # learns and writes services/brain/language/at_work.npz
python -m bench.interjections --without 36 37    # learns from all the others
python -m bench.interjections --apart L4 --apart L2 L3   # what wordings and model make of lists that it has not seen
"""

import argparse
import re
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from bench import log_linear
from common.language.log_linear import LogLinear
from services.brain.language import at_work
from services.brain.language.interjection import by_wording
from tests.everyday import all_lists

_SENSE = {"answer": "aside", "refuse": "aside", "none": "idle", "return": "replace", "pause": "stop"}
"""The sense of an act of the notation at work, where it is none itself."""
_OF_KIND = {"cancel": "stop", "come_back": "replace", "encouragement": "idle"}
"""The sense of a kind of interjection, where it is none itself."""


class Said(NamedTuple):
    """`right`: the senses that a sentence may have."""

    list: str
    heard: at_work.Interrupting
    doing: str
    right: frozenset[str]


def sentences() -> list[Said]:
    """All that was said to a robot at work and has one of the senses."""
    found = []
    for number, rows in all_lists().items():
        for row in rows:
            tag, _, doing = row.context.partition(":")
            acts = re.findall(r"(?:^|\|\|) *(\w+)", row.right)
            right = frozenset(_SENSE.get(act, act) for act in acts)
            if tag == "busy" and right <= set(at_work.SENSES):
                kind = by_wording(row.said, doing)[0].kind
                found.append(Said(number, at_work.interrupting(row.said, doing, kind), doing, right))
    return found


def learn(rows: Sequence[Said]) -> LogLinear:
    """The model that makes the right senses most likely."""
    words = log_linear.known_words(row.heard.words for row in rows)
    examples = [
        log_linear.Example(
            at_work.options(row.heard, words),
            at_work.embedding(row.heard, row.doing),
            [sense in row.right for sense in at_work.SENSES],
        )
        for row in rows
    ]
    return log_linear.learn(examples, words)


def _apart(rows: Sequence[Said], lists: Sequence[str]) -> None:
    """Print how much of some lists the wordings, and the wordings and a model of the others together, take rightly."""
    model = learn([row for row in rows if row.list not in lists])
    unseen = [row for row in rows if row.list in lists]
    wordings = both = 0
    for row in unseen:
        plain = _OF_KIND.get(row.heard.kind, row.heard.kind)
        p = model.probabilities(at_work.options(row.heard, model.words), at_work.embedding(row.heard, row.doing))
        sense = at_work.SENSES[int(p.argmax())] if p.max() >= by_wording(row.heard.said, row.doing)[1] else plain
        wordings += plain in row.right
        both += sense in row.right
    print(f"{' '.join(lists):30} {len(unseen):5} sentences, by wordings {wordings:4}, with the model {both:4}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--without", nargs="*", default=[], metavar="LIST", help="lists that nothing is learnt from")
    parser.add_argument("--apart", nargs="+", action="append", metavar="LIST", help="lists to leave out and measure")
    args = parser.parse_args()
    rows = [row for row in sentences() if row.list not in args.without]
    if args.apart:
        for lists in args.apart:
            _apart(rows, lists)
        return
    path = Path(at_work.__file__).with_name(at_work.WEIGHTS)
    learn(rows).save(path)
    print(f"{path}: {path.stat().st_size // 1000} kB, learnt from {len(rows)} sentences")


if __name__ == "__main__":
    main()
