"""docs/CONTRACT.md names nothing that does not exist: every file, symbol and test, and no row is left open."""

import ast
import re
from functools import cache

import pytest

from tests.support import ROOT

PAGE = (ROOT / "docs" / "CONTRACT.md").read_text(encoding="utf-8")
ROWS = [
    [c.strip() for c in line.strip("| ").split(" | ")] for line in PAGE.splitlines() if re.match(r"\| [FV]\d", line)
]
ANCHOR = re.compile(r"`([\w./-]+)#([^`]+)`")
TEST = re.compile(r"`(tests/[\w./]+\.py)::(\w+)`")


@cache
def symbols(file: str) -> frozenset[str]:
    """Functions, classes, methods as `Class.method`, and constants of a module."""
    found: set[str] = set()
    for node in ast.parse((ROOT / file).read_text(encoding="utf-8")).body:
        if isinstance(node, ast.Assign):
            found |= {target.id for target in node.targets if isinstance(target, ast.Name)}
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            found.add(node.target.id)
        elif isinstance(node, ast.FunctionDef | ast.ClassDef):
            found.add(node.name)
            inner = node.body if isinstance(node, ast.ClassDef) else ()
            found |= {f"{node.name}.{one.name}" for one in inner if isinstance(one, ast.FunctionDef)}
    return frozenset(found)


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row[0])
def test_what_a_row_names_exists(row: list[str]) -> None:
    _, asked, where, shown, *_ = row
    assert asked and ANCHOR.findall(where) and TEST.findall(shown), row
    for file, name in ANCHOR.findall(where):
        assert (ROOT / file).is_file(), file
        if file.endswith(".py"):
            assert name in symbols(file), f"{file} has no {name}"
        else:
            assert name in (ROOT / file).read_text(encoding="utf-8"), f"{name!r} is not in {file}"
    for file, name in TEST.findall(" ".join(row)):
        assert name in symbols(file), f"{file} has no {name}"


def test_both_designs_are_there_row_by_row() -> None:
    numbers = [row[0] for row in ROWS]
    for letter, least in (("F", 30), ("V", 50)):
        mine = [n for n in numbers if n.startswith(letter)]
        assert mine == [f"{letter}{k}" for k in range(1, len(mine) + 1)] and len(mine) >= least
    assert not re.search(r"\b(?:TODO|TBD|not yet|missing|open row)\b", PAGE)
    # A row of another form would not be looked at.
    tables = [line for line in PAGE.splitlines() if line.startswith("|") and not line.startswith(("| #", "|---"))]
    assert len(tables) == len(ROWS)
