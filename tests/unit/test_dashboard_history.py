"""Transcript, services, curves, and how they are written."""

import numpy as np
import pytest

from common import messages as m
from common.mission_log.transcript import Transcript
from common.process.health_records import HealthRecords
from services.dashboard.panels import markup
from services.dashboard.panels.history_buffers import Curves, Jitter, TreeReasons


def health(name: str, epoch: str, **more: object) -> m.Health:
    values: dict[str, object] = {"t": 0.0, "uptime": 1.0, "hz": 20.0, "drops": 0, "rss_mb": 50.0, "pid": 1}
    return m.Health(name=name, epoch=epoch, **{**values, **more})  # type: ignore[arg-type]


def test_a_new_epoch_is_a_restart() -> None:
    services = HealthRecords()
    for epoch in ("a", "a", "b", "b", "c"):
        services.take(health("sim", epoch, drops=3, last_error="bad"))
    services.take(health("brain", "x"))
    brain, sim = services.rows(lambda name: name == "sim")
    assert (brain.name, brain.alive, brain.restarts) == ("brain", False, 0)
    assert (sim.name, sim.alive, sim.restarts, sim.drops, sim.error) == ("sim", True, 2, 3, "bad")


def test_transcript_has_both_sides_once() -> None:
    talk = Transcript()
    talk.add_result(1.0, m.SpeechResult(text="bring me the mug"))
    talk.add_result(1.2, m.SpeechResult(text="bring me the mug"))
    talk.add_goal(2.0, m.SpeechGoal(goal="say Did you say mug?"))
    talk.add_goal(2.1, m.SpeechGoal(goal="listen"))
    talk.add_result(3.0, m.SpeechResult(text="ERROR", code="NOISE", detail="no words"))
    talk.add_result(4.0, m.SpeechResult(text="ERROR", code="TIMEOUT"))
    talk.add_result(9.0, m.SpeechResult(text="bring me the mug"))
    assert [(line.who, line.text) for line in talk.lines] == [
        ("heard", "bring me the mug"),
        ("said", "Did you say mug?"),
        ("robot", "not understood: NOISE no words"),
        ("heard", "bring me the mug"),
    ]


def test_curves_keep_peaks_between_samples_and_forget_the_old() -> None:
    curves = Curves(("v",), seconds=1.0, spacing=0.1)
    for n in range(300):
        curves.add(n * 0.01, v=9.0 if n == 245 else 1.0)
    age, v = curves.arrays()
    assert len(age) == len(v) == 10
    assert age[-1] == 0.0
    assert -1.0 <= age[0] < -0.8
    assert v.max() == 9.0
    assert np.sum(v == 9.0) == 1


def test_empty_curves_can_be_drawn() -> None:
    assert [len(a) for a in Curves(("a", "b")).arrays()] == [1, 1, 1]


def test_jitter_is_the_difference_of_two_clocks() -> None:
    jitter = Jitter()
    assert jitter.late(5.0, 100.0) == 0.0
    assert jitter.late(5.03, 100.03) == pytest.approx(0.0)
    assert jitter.late(5.06, 100.10) == pytest.approx(0.04)


def node(name: str, status: str, *children: m.TreeNode, detail: str = "") -> m.TreeNode:
    return m.TreeNode(name=name, type="Sequence", status=status, detail=detail, children=list(children))


def test_the_tree_shows_the_running_branch_and_reasons() -> None:
    leaf = node("drive", "RUNNING", detail="2.0 m left")
    root = node("root", "RUNNING", node("wait", "SUCCESS"), node("mission", "RUNNING", leaf), node("say", "INVALID"))
    text = markup.tree(root)
    assert "2.0 m left" in text
    assert text.count("▶") == 3
    assert text.count("✓") == 1


def test_nothing_from_the_bus_becomes_html() -> None:
    evil = "<img src=x onerror=alert(1)>"
    state = m.BrainState(
        state="ERROR", detail=evil, command=evil, step=evil, mission_id="a",
        last=m.MissionOutcome(id="b", command=evil, outcome="failed", reason=evil),
    )  # fmt: skip
    steps = [m.PlanStep(action="say", text=evil)]
    talk = Transcript()
    talk.add(0.0, evil, evil)
    services = HealthRecords()
    services.take(health(evil, "a", last_error=evil))
    pages = (
        markup.tree(node(evil, "RUNNING", detail=evil)),
        markup.mission(state, 1.0, steps, m.NavigationFeedback(goal_id="m.1", status="failed", detail=evil), None),
        markup.transcript(talk.lines),
        markup.services(services.rows(lambda name: True)),
    )
    for page in pages:
        assert "<img" not in page
        assert "&lt;img" in page


def test_mission_panel_names_state_step_time_and_plan() -> None:
    state = m.BrainState(state="NAVIGATING", command="fetch it", step="find mug", mission_id="m-1", started=10.0)
    state.plan_step = 2
    steps = [m.PlanStep(action="find", object="red mug"), m.PlanStep(action="grasp", object="red mug")]
    text = markup.mission(state, 17.4, steps, None, m.ManipulationStatus(status="executing", phase="lift"))
    for word in (
        "NAVIGATING",
        "fetch it",
        "find mug",
        "7 s",
        "<li>find red mug</li>",
        "<b>grasp red mug</b>",
        "executing lift",
    ):
        assert word in text
    assert "not been heard" in markup.mission(None, 0.0, [], None, None)
    over = m.MissionOutcome(id="m-1", command="fetch it", outcome="failed", reason="it is not there")
    done = m.BrainState(state="WAITING", last=over)
    text = markup.mission(done, 20.0, steps, None, m.ManipulationStatus(status="failed", code="SLIPPED", detail="0 mm"))
    assert "fetch it: failed" in text and "it is not there" in text and "failed: SLIPPED 0 mm" in text
    assert "<li>" not in text, "the plan of a mission that is over is not under way"


def grown(status: str, detail: str) -> m.TreeSnapshot:
    leaf = m.TreeNode(name="look", type="Leaf", status=status, detail=detail)
    branch = m.TreeNode(name="search", type="Sequence", status=status, children=[leaf])
    part = m.TreeNode(name="fetch", type="Sequence", status="RUNNING", children=[branch])
    return m.TreeSnapshot(t=7.0, root=m.TreeNode(name="root", type="Selector", status="RUNNING", children=[part]))


def test_a_node_that_was_reset_still_tells_its_last_reason() -> None:
    reasons = TreeReasons()
    reasons.take(grown("RUNNING", "turning"))
    reasons.take(grown("FAILURE", "no <mug> in sight"))
    later = grown("INVALID", "")
    later.t = 30.0
    reasons.take(later)
    shown = markup.tree(later.root, reasons.last)
    assert "no &lt;mug&gt; in sight (7 s)" in shown
    assert "turning" not in shown
    assert "look" not in markup.tree(later.root, {}), "what was never reached stays folded"


def test_reasons_of_nodes_that_are_gone_are_forgotten() -> None:
    reasons = TreeReasons()
    reasons.take(grown("FAILURE", "why"))
    root = m.TreeNode(name="root", type="Selector", status="RUNNING")
    reasons.take(m.TreeSnapshot(t=8.0, root=root))
    assert reasons.last == {}
