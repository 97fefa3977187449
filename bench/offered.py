"""The model of which of the offered things an answer means: learnt from tests/data, measured by leaving lists out.

python -m bench.offered                     # learns and writes services/brain/language/offered.npz
python -m bench.offered --without 36 37     # learns from all the others
python -m bench.offered --apart L8 L13      # what wordings and a model of the others make of these lists
"""

import re
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from bench import log_linear
from common.language.log_linear import LogLinear
from evaluation.everyday.flat import FLAT, HOME
from evaluation.everyday.sentences import all_lists
from services.brain.language import choosing, offered


class Answer(NamedTuple):
    """`right`: of each option, and last of choosing none and of any will do."""

    list: str
    said: str
    options: list[str]
    right: list[bool]


def answers() -> list[Answer]:
    """All answers to the question which one was meant."""
    found = []
    for number, rows in all_lists().items():
        for row in rows:
            tag, _, about = row.context.partition(":")
            if tag == "which":
                options = about.split("|")
                picked = {label for labels in re.findall(r"pick\(([^()]+)\)", row.right) for label in labels.split("/")}
                others = re.search(r"(?:^|\|\|) *(?!pick)\w+\(", row.right) is not None
                right = [option in picked for option in options]
                ends = [others or not any(right), all(right)]
                found.append(
                    Answer(number, row.said, options, [*([False] * len(right) if all(right) else right), *ends])
                )
    return found


def learn(rows: Sequence[Answer]) -> LogLinear:
    """The model that makes the right options most likely."""
    said = [offered.words_of(row.said) for row in rows]
    words = log_linear.known_words(said)
    return log_linear.learn(
        [
            log_linear.Example(
                offered.options(heard, row.options, FLAT, HOME, words), offered.embedding(heard), row.right
            )
            for heard, row in zip(said, rows, strict=True)
        ],
        words,
    )


def main() -> None:
    parser = log_linear.arguments(__doc__)
    parser.add_argument("--apart", nargs="+", metavar="LIST", help="lists to leave out and measure")
    args = parser.parse_args()
    rows = [row for row in answers() if row.list not in args.without]
    if not args.apart:
        log_linear.save(learn(rows), Path(offered.__file__).with_name(offered.WEIGHTS), len(rows))
        return
    offered.use(learn([row for row in rows if row.list not in args.apart]))
    found: Counter[str] = Counter()
    for row in (row for row in rows if row.list in args.apart):
        label = choosing.chosen(row.said, row.options, FLAT, HOME)
        right = label in row.options and (row.right[-1] or row.right[row.options.index(label)])
        found["right" if right else "none" if label is None else "wrong"] += 1
    print(*(f"{kind} {count}" for kind, count in sorted(found.items())), sep=", ")


if __name__ == "__main__":
    main()
