"""docs/EXTENDING.md, "A new kind": its blocks, put into a copy of the code, make a spoon that can be fetched."""

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support import ROOT

TABLE, BODIES, DISH = "_TABLE = (\n", "_BODIES = {\n", 'dish = ["mug", "cup", "bowl", "plate"]\n'
SPOON = (
    '  { name = "wooden spoon", kind = "spoon", colour = "brown", size = [0.15, 0.03, 0.02], mass = 0.05, '
    'rgba = [0.45, 0.3, 0.18, 1.0], aliases = ["spoon"] },\n'
)
ASK = """
import json
import mujoco, numpy as np
from common import config
from common.kinds import KINDS, kind_of
from common.messages import KnownWorld, ObjectPose
from common.household import load_words, told
from common.scene import load_scene
from services.brain.world import placement
from services.manipulation.grasps.rules import candidates
from services.manipulation.grasps.target import Target
from services.perception.shapes.known import fit
from services.planner.grammar import grammar
from services.planner.config import PlannerConfig
from services.planner.world import believed
from services.sim.objects import geoms

scene = load_scene("spoon.toml")
spec = scene.object("spoon")
model = mujoco.MjModel.from_xml_string(f"<mujoco><worldbody><body>{geoms(spec)}</body></worldbody></mujoco>")
data = mujoco.MjData(model)
mujoco.mj_forward(model, data)
points, camera = [], np.array([-0.4, 0.0, 0.6])
for x in np.linspace(-0.08, 0.08, 40):
    for y in np.linspace(-0.02, 0.02, 20):
        way = np.array([x, y, 0.01]) - camera
        length = mujoco.mj_ray(model, data, camera, way, None, 1, -1, np.zeros(1, np.int32))
        if length >= 0:
            points.append(camera + length * way)
seen = fit(kind_of("spoon"), spec.size, np.array(points), -spec.size[2] / 2, camera)
held = candidates(Target("spoon", "spoon", (0.6, 0.0, 0.6), 0.3, spec.size), 0.12, 0.076)
parameters = config.load("planner", PlannerConfig, config.DEFAULT_DIR, {})
plan = grammar.plan("bring me the spoon", believed(told(scene), KnownWorld(), []), parameters)
lying = ObjectPose(query_id="q", found=True, position=(0.7, 0.0, 0.47), on="delivery tray", tilt=1.57)
print(json.dumps({
    "geoms": model.ngeom,
    "off_mm": round(1000 * float(np.hypot(seen.x, seen.y))),
    "turned": round(abs(float(np.sin(seen.yaw))), 1),
    "grasps": len(held) >= 3 and all(g.width == 0.03 for g in held),
    "plan": [" ".join((s.action, s.object)).strip() for s in plan.steps],
    "fault": placement.judge_placement(lying, "wooden spoon", "delivery tray", told(scene)).fault,
    "dishes": "spoon" in load_words(config.DEFAULT_DIR).groups["dish"],
}))
"""


def blocks() -> list[str]:
    """The recipe's code, in its order: row, body, the body's name, words."""
    page = (ROOT / "docs" / "EXTENDING.md").read_text(encoding="utf-8")
    section = page.partition("### A new kind")[2].partition("\n## ")[0]
    return re.findall(r"```(?:text|python|toml)\n(.*?)```", section, re.DOTALL)


def insert(path: Path, mark: str, text: str) -> None:
    before = path.read_text(encoding="utf-8")
    assert before.count(mark) == 1, f"{path} has not one {mark!r}"
    path.write_text(before.replace(mark, text), encoding="utf-8")


def ask(folder: Path) -> subprocess.CompletedProcess[str]:
    """What a process that runs the code in `folder` makes of the spoon."""
    command = [sys.executable, "-c", ASK]
    return subprocess.run(
        command, cwd=folder, env={"PYTHONPATH": str(folder), "PATH": ""}, capture_output=True, text=True
    )


@pytest.mark.timeout(120)
def test_the_recipe_for_a_kind_touches_three_files_and_makes_a_spoon(tmp_path: Path) -> None:
    folder = tmp_path / "copy"
    for part in ("common", "services", "config"):
        shutil.copytree(ROOT / part, folder / part, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "examples" / "tea.toml", folder / "spoon.toml")
    shutil.copy(ROOT / "pyproject.toml", folder)  # a checkout, and nothing installed
    insert(folder / "spoon.toml", "objects = [\n", "objects = [\n" + SPOON)
    refused = ask(folder)
    assert refused.returncode == 1
    assert "'wooden spoon' is a 'spoon'; known kinds: mug, can" in refused.stderr

    row, body, name, words = blocks()
    insert(folder / "common" / "kinds.py", TABLE, TABLE + row)
    insert(folder / "services" / "sim" / "objects.py", BODIES, f"{body}\n\n{BODIES}{name}")
    insert(folder / "config" / "words.toml", DISH, words)
    found = ask(folder)
    assert found.returncode == 0, found.stderr
    answers = json.loads(found.stdout)
    assert answers.pop("off_mm") < 8
    assert answers == {
        "geoms": 2,
        "turned": 0.0,
        "grasps": True,
        "plan": ["find wooden spoon", "grasp wooden spoon", "return", "release"],
        "fault": "",
        "dishes": True,
    }
