"""docs/EXTENDING.md, "A new wording": its one line, put into a copy of the code, is planned, heard and obeyed."""

import re
import shutil
import subprocess
import sys

from tests.support import ROOT

FILE, TABLE = "common/language/wordings.py", "WORDINGS: tuple[Wording, ...] = (\n"
ASK = """
import json
from common import config
from common.messages import KnownWorld
from common.household import load_household
from services.brain.language.intent import parse
from services.planner.grammar import grammar
from services.planner.config import PlannerConfig
from services.planner.world import believed
from services.speech.config import SpeechConfig
from services.speech.recognise.recogniser import grammars

scene, said = load_household("apartment"), "hook me up with the red mug"
plan = grammar.plan(said, believed(scene, KnownWorld(), []), PlannerConfig())
speech = config.load("speech", SpeechConfig, config.DEFAULT_DIR, {})
intent = parse(said, scene)
print(json.dumps({
    "planned": [" ".join((s.action, s.object)).strip() for s in plan.steps],
    "heard": grammars(speech, scene)["command"].accepts(said),
    "obeyed": [intent.kind, intent.item],
}))
"""


def answers(folder: str) -> str:
    """What a process that runs the code in `folder` makes of the wording."""
    found = subprocess.run(
        [sys.executable, "-c", ASK], cwd=folder, env={"PYTHONPATH": folder, "PATH": ""}, capture_output=True, text=True
    )
    assert found.returncode == 0, found.stderr
    return found.stdout.strip()


def test_the_recipe_for_a_wording(tmp_path: object) -> None:
    page = (ROOT / "docs" / "EXTENDING.md").read_text(encoding="utf-8")
    section = page.partition("## A new wording")[2].partition("\n## ")[0]
    (row,) = re.findall(r"```text\n(.*?)```", section, re.DOTALL)
    assert row.count("\n") == 1
    folder = f"{tmp_path}/copy"
    for part in ("common", "services", "config"):
        shutil.copytree(ROOT / part, f"{folder}/{part}", ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "pyproject.toml", folder)  # a checkout, and nothing installed
    assert answers(folder) == '{"planned": [], "heard": false, "obeyed": ["none", ""]}'

    path = f"{folder}/{FILE}"
    with open(path, encoding="utf-8") as file:
        text = file.read()
    assert text.count(TABLE) == 1
    with open(path, "w", encoding="utf-8") as file:
        file.write(text.replace(TABLE, TABLE + row))
    plan = '["find red mug", "grasp red mug", "return", "release"]'
    assert answers(folder) == f'{{"planned": {plan}, "heard": true, "obeyed": ["fetch", "red mug"]}}'
