"""What commands print: JSON or lines, and a line of progress."""

import argparse
import io

import pytest

from cli.output import ProgressLine, show
from common import messages as m
from common.demonstration import PictureTurns


def test_a_value_is_printed_for_programs_or_told_to_people(capsys: pytest.CaptureFixture[str]) -> None:
    show(argparse.Namespace(json=True), {"a": [1, 2]}, ["never"])
    show(argparse.Namespace(json=False), {"a": [1, 2]}, ["one", "two"])
    assert capsys.readouterr().out == '{"a":[1,2]}\none\ntwo\n'


def test_progress_is_shown_when_it_is_due_and_at_the_end() -> None:
    out = io.StringIO()
    line = ProgressLine(out)
    for n in range(5):
        line.show(lambda n=n: f"{n} done")
    line.show(lambda: "all done", last=True)
    assert out.getvalue() == "0 done\nall done\n"


def test_cameras_take_turns_and_one_that_does_not_answer_is_asked_again() -> None:
    turns, ids = PictureTurns(("head", "wrist"), 1.0), iter("abcd")
    first = turns.request(0.0, lambda: next(ids))
    assert first is not None and first.camera == "head" and turns.request(0.5, lambda: next(ids)) is None
    again = turns.request(1.5, lambda: next(ids))
    assert again is not None and (again.camera, again.id) == ("head", "b")
    turns.came(m.Rgbd(t=1.6, id="b", camera="head", width=1, height=1, fx=1, fy=1, cx=0, cy=0, rgb=b"", depth=b"",
                      position=(0, 0, 0), orientation=(1, 0, 0, 0)))  # fmt: skip
    other = turns.request(1.6, lambda: next(ids))
    assert other is not None and other.camera == "wrist"
