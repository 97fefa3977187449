"""Everyday sentences: at least nine in ten are understood, and none leads to a wrong action."""

import pytest

from tests.everyday import sentences, understand, verdict

LISTS = ("everyday_sentences.tsv",)
ENOUGH = 0.9


@pytest.mark.parametrize("name", LISTS)
def test_everyday_sentences(name: str) -> None:
    rows = sentences(name)
    verdicts = {row: verdict(row, understand(row)) for row in rows}
    assert not [row for row, v in verdicts.items() if v == "wrong"]
    missed = [row for row, v in verdicts.items() if v != "right"]
    assert len(missed) <= (1 - ENOUGH) * len(rows), "\n".join(map(str, missed))
