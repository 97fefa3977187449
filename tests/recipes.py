"""Carries out a recipe of docs/EXTENDING.md in a copy of the code.

A recipe is a section with blocks of ```diff: a file to change, and for each place in it the lines before and after. A
block with two names copies the first file to the second and changes that; one with only `+++` is a new file.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from tests.support import ROOT

SKIPPED = shutil.ignore_patterns("__pycache__", ".*", "out", "run", "images", "audio")


def section(title: str) -> str:
    """The text of a section of the page.

    Raises:
        ValueError: there is none.
    """
    page = (ROOT / "docs" / "EXTENDING.md").read_text(encoding="utf-8")
    _, found, rest = page.partition(f"\n## {title}\n")
    if not found:
        raise ValueError(f"docs/EXTENDING.md has no section {title!r}")
    return rest.partition("\n## ")[0]


class Recipe:
    """A copy of the project with the recipe done; `files` are those that it touched."""

    def __init__(self, title: str, tmp_path: Path) -> None:
        self.folder = tmp_path / "copy"
        shutil.copytree(ROOT, self.folder, ignore=SKIPPED)
        self.files: list[str] = []
        for block in re.findall(r"```diff\n(.*?)```", section(title), re.DOTALL):
            self._apply(block)

    def _apply(self, block: str) -> None:
        lines = block.splitlines()
        names = [line[4:] for line in lines if line.startswith(("--- ", "+++ "))]
        made = not any(line.startswith("--- ") for line in lines)
        text = "" if made else (self.folder / names[0]).read_text(encoding="utf-8")
        for hunk in "\n".join(line for line in lines if line[:4] not in ("--- ", "+++ ")).split("\n@@\n"):
            rows = hunk.splitlines()
            old = "".join(f"{row[1:]}\n" for row in rows if not row.startswith("+"))
            new = "".join(f"{row[1:]}\n" for row in rows if not row.startswith("-"))
            assert text.count(old) == 1, f"{names[0]} has not once:\n{old}"
            text = text.replace(old, new)
        (self.folder / names[-1]).write_text(text, encoding="utf-8")
        self.files.append(names[-1])

    def run(self, *arguments: str) -> str:
        """What a Python process in the copy prints; fails the test when it fails."""
        environ = {"PYTHONPATH": str(self.folder), "PATH": os.environ["PATH"], "HOME": os.environ.get("HOME", "")}
        found = subprocess.run(
            [sys.executable, *arguments], cwd=self.folder, env=environ, capture_output=True, text=True
        )
        assert found.returncode == 0, found.stdout + found.stderr
        return found.stdout
