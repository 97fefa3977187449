"""The evaluation's HTML report: stages by physics, honest intervals, nothing from outside, nothing unescaped."""

import base64
import io
import re
from typing import Any

import numpy as np
from PIL import Image

from common import messages as m
from common import topics
from common.bus import codec
from common.scene import load_scene
from evaluation.case import Result
from evaluation.report import html as html_report
from evaluation.report import text as report
from evaluation.report.html import by_stage, reached
from evaluation.report.picture import HEIGHT, WIDTH, last_picture
from services.sim.physics import Physics


def result(seed: int, stage: int, command: str = "bring me the red mug", **more: Any) -> Result:
    """A case that came `stage` stages far: 0 not understood .. 5 delivered."""
    thing = {"thing": "red mug", "lifted": stage >= 3, "carried": 1.0 if stage >= 4 else 0.0, "delivered": stage >= 5}
    states = ["LISTENING", "NAVIGATING", "GRABBING"][: 1 + min(stage, 2)]
    good = stage >= 5
    evidence = {
        "expected": "delivered",
        "states": states,
        "things": [thing],
        "reason": "why",
        "said": ["sorry"],
        **more,
    }
    return Result(
        seed=seed, command=command, outcome="delivered" if good else "reported", evidence=evidence,
        cause="" if good else "grasp: SLIPPED", name="fetch", delivered=good, met=good, spl=0.8 if good else 0.0,
        sim_seconds=40.0 + seed, wall_seconds=4.0,
    )  # fmt: skip


def test_stages_are_counted_as_far_as_each_case_came() -> None:
    rows = by_stage([result(n, n) for n in range(6)])
    assert rows == [
        ("understood", 5, 6), ("at the object", 4, 6), ("lifted", 3, 6), ("carried", 2, 6), ("delivered", 1, 6),
    ]  # fmt: skip
    nothing_wanted = result(9, 0, expected="nothing")
    assert by_stage([nothing_wanted])[0] == ("understood", 0, 0)


def test_a_lift_counts_as_understood_whatever_the_robot_said_of_itself() -> None:
    one = result(1, 3, states=[])
    assert reached(one) == {
        "understood": True, "at the object": True, "lifted": True, "carried": False, "delivered": False,
    }  # fmt: skip


def test_the_page_shows_failures_with_their_pictures_and_asks_nothing_from_outside() -> None:
    results = [result(1, 5), result(2, 2, command="<script>alert(1)</script>", picture="QUJD", timeline=["1 s <b>x"])]
    results[1].false_claims = 2
    page = html_report.render(report.record("fetch", results, 8.0), results)
    assert "data:image/jpeg;base64,QUJD" in page
    assert "<script" not in page
    assert "1 s &lt;b&gt;x" in page
    assert "1 of 2 (9 to 91 %)" in page
    assert "scenarios with a false claim</dt><dd>1 of 2 (9 to 91 %)" in page
    assert "false claims</dt><dd>2<" in page and "<td>2</td>" in page
    loaded = re.findall(r'(?:src|href)="([^"]*)"|url\(([^)]*)\)', page)
    assert loaded
    assert all((a or b).startswith("data:") for a, b in loaded)
    assert "http" not in page


def test_the_picture_is_not_in_the_json() -> None:
    found = report.record("fetch", [result(2, 2, picture="QUJD")], 8.0)
    assert "picture" not in found["cases"][0]["evidence"]
    assert found["cases"][0]["evidence"]["reason"] == "why"


def test_a_run_without_cases_makes_a_page() -> None:
    assert "0 of 0" in html_report.render(report.record("fetch", [], 0.0), [])


def test_the_last_picture_is_of_the_world_as_it_ended() -> None:
    physics = Physics(load_scene("minimal"), 0, ())
    model = m.SimModel(scene="minimal", seed=0, epoch="e", mjcf=physics.mjcf)
    state = m.SimState(t=1.0, tick=100, epoch="e", qpos=physics.data.qpos.tobytes())
    known = {
        topics.SIM_MODEL.key: codec.encode(topics.SIM_MODEL, model),
        topics.SIM_STATE.key: codec.encode(topics.SIM_STATE, state),
    }
    picture = Image.open(io.BytesIO(base64.b64decode(last_picture(known.get))))
    assert picture.size == (WIDTH, HEIGHT)
    assert np.asarray(picture).std() > 10, "something is in it"
    assert last_picture({}.get) == ""
    known[topics.SIM_STATE.key] = codec.encode(topics.SIM_STATE, m.SimState(t=1.0, tick=1, epoch="e", qpos=bytes(8)))
    assert last_picture(known.get) == "", "a state of another model"
