"""The harm that chaos does to a robot in one process, its cells, and the table of what came of them."""

import itertools
from collections.abc import Iterator
from io import StringIO
from pathlib import Path

import msgspec
import pytest
from rich.console import Console

from common import messages as m
from common import topics
from common.config import Config
from common.scene import Scene
from evaluation.case import Case, Line, Observed, Result, TimedFault
from evaluation.examiner import Examiner, examiner_of
from evaluation.faults.messages import Rule, faulty
from evaluation.faults.reports import FaultReport
from evaluation.report.matrix import cell, chaos_tables, tally
from evaluation.runner import FaultScheduler
from evaluation.stack import Stack
from evaluation.suites.chaos import CELLS, CHAOS_SERVICES, CHAOS_STATES, EVERY, MISTREATED, TRAFFIC, chaos
from evaluation.verdict import judge
from judge.claims import Claim
from judge.evidence import Evidence, ThingEvidence
from tests.node import Node
from tests.unit.test_eval_faults import SCENE, Counter
from tests.unit.test_eval_stack import OTHERS, go, status


@pytest.fixture
def stack(tmp_path: Path) -> Iterator[Stack]:
    """The small flat with navigation alone, and a disk."""
    opened = Stack("minimal", without=OTHERS, state_dir=tmp_path)
    opened.advance(0.3)
    yield opened
    opened.close()


# --- the host
def test_a_killed_simulation_goes_on_with_its_world(stack: Stack) -> None:
    go(stack, "a.1")
    stack.advance(1.8)
    now, base, epoch = stack.now, stack.truth()["base"], stack.bus.ios["sim"].epoch
    stack.restart_sim()
    assert now - 0.5 <= stack.now <= now and stack.bus.ios["sim"].epoch != epoch
    assert stack.truth()["base"] == pytest.approx(base, abs=0.5) and stack.truth()["base"] != [0.0, 0.0, 0.0]
    stack.advance(0.1)
    assert stack.truth()["t"] == pytest.approx(stack.now)
    stack.advance(12.0)
    assert (status(stack).goal_id, status(stack).status) == ("a.1", "arrived")


def test_without_a_router_nobody_hears_and_nothing_of_weight_is_lost(stack: Stack) -> None:
    go(stack, "b.1")
    stack.advance(0.5)
    said = stack.bus.tap(topics.NAVIGATION_STATUS)
    stack.cut(1.0)
    before = stack.now
    go(stack, "b.2")
    go(stack, "b.3")
    stack.advance(0.9)
    assert not said, "navigation stands still without the clock"
    assert stack.truth()["t"] == pytest.approx(before + 0.9), "the world does not"
    stack.advance(0.4)
    ids = [i for i, _ in itertools.groupby(msgspec.json.decode(s, type=m.NavigationStatus).goal_id for s in said)]
    assert ids[-1] == "b.3" and "b.2" in ids, "both came, in order"


def test_who_is_killed_while_it_hangs_comes_back_once(stack: Stack) -> None:
    stack.hang("navigation", 0.5)
    stack.cut(0.8)
    stack.advance(0.2)
    stack.kill("navigation")
    stack.start("navigation")
    stack.advance(0.3)
    assert status(stack).status == "idle" and not stack.bus.get(topics.NAV_PATH.key), "without a router it does not run"
    stack.advance(1.0)
    steps: list[float] = []
    service = stack.members["navigation"][0]
    service.step = steps.append
    stack.advance(0.5)
    assert len(steps) == len(set(steps)) == 0.5 * service.HZ


def test_a_full_disk_takes_nothing_until_there_is_room(stack: Stack, tmp_path: Path) -> None:
    stack.fill_disk(0.6)
    with pytest.raises(OSError, match="too large"):
        (tmp_path / "note").write_text("x")
    stack.advance(0.65)
    (tmp_path / "note").write_text("x")
    assert not (tmp_path / "sim.checkpoint").exists()
    stack.advance(0.6)
    assert (tmp_path / "sim.checkpoint").exists()


def test_harm_comes_at_its_moment_and_is_told(stack: Stack) -> None:
    told: list[FaultReport] = []
    strikes = (TimedFault("navigation", "GRABBING", after=0.5), TimedFault("router", "RELEASING"))
    scheduler = FaultScheduler(stack, (*strikes, TimedFault("speech", "GRABBING")), told.append)
    stack.bus.send(topics.BRAIN_STATE, m.BrainState(state="GRABBING"))
    scheduler.step()
    began = stack.now
    stack.advance(0.3)
    scheduler.step()
    assert "navigation" in stack.members and not told
    stack.advance(0.3)
    scheduler.step()
    assert "navigation" not in stack.members, "and speech, which is not there, was not struck"
    assert [(s.fault, s.what.split()[0], s.t) for s in told] == [("kill", "navigation", pytest.approx(began + 0.6))]


# --- messages
@pytest.mark.parametrize("service", ["sim", "navigation"])
def test_a_message_that_is_hit_is_told(service: str) -> None:
    topic = topics.ODOMETRY if service == "sim" else topics.NAVIGATION_STATUS
    rule = Rule(service=service, key=topic.key, kind="drop")
    told: list[FaultReport] = []
    opened = Stack("minimal", without=OTHERS, swaps={service: lambda kind: faulty(kind, (rule,), told.append)})
    opened.advance(0.5)
    opened.close()
    assert [s.fault for s in told] == ["drop"] and topic.key in told[0].what


def test_a_rule_for_a_state_holds_in_that_state_only() -> None:
    rule = Rule(service="navigation", key=topics.NAVIGATION_STATUS.key, kind="drop", count=99, state="GRABBING")
    told: list[FaultReport] = []
    node = Node(faulty(Counter, (rule,), told.append), None, SCENE)
    for state in ("NAVIGATING", "NAVIGATING", "GRABBING", "GRABBING", "RETURNING"):
        node.send(topics.BRAIN_STATE, m.BrainState(state=state))  # type: ignore[arg-type]
        node.step()
    assert [status.detail for status in node.sent(topics.NAVIGATION_STATUS)] == ["1", "2", "5"]
    assert [s.t for s in told] == pytest.approx([0.3, 0.4])


# --- cells
def test_every_service_is_killed_in_every_state() -> None:
    kills = {(c.service, c.state) for c in CELLS if c.fault == "kill" and c.state != EVERY}
    assert kills == set(itertools.product(CHAOS_SERVICES, CHAOS_STATES))
    assert {c.fault for c in CELLS} >= {"hang", "router loss", "disk full", "clock jump", *MISTREATED}
    for (service, state), keys in TRAFFIC.items():
        assert service in CHAOS_SERVICES and state in CHAOS_STATES
        for key in keys:
            assert {service, "*"} & {*topics.BY_KEY[key].writers}, key
    for seed, found in enumerate(CELLS):
        case = chaos(seed)
        assert case.name == f"{found.service} {found.state}" and case.fault == found.fault
        assert bool(case.timed_faults) != bool(case.rules)
        assert len(case.timed_faults) == (len(CHAOS_STATES) if found.state == EVERY else not case.rules)


# --- the examiner's clock
def test_recovered_is_the_next_step_of_the_mission() -> None:
    case = Case(suite="chaos", seed=0, name="brain NAVIGATING", command="fetch", lines=(Line("fetch"),))
    # The states alone: there is no simulation to be seen.
    following = type("Following", (examiner_of(case),), {"step": Examiner.follow})
    node = Node(following, Config(), SCENE, world=Scene(name="empty", low=SCENE.low, high=SCENE.high, home=SCENE.home))
    examiner: Examiner = node.service

    def show(state: str, step: str, mission: str = "m-1") -> None:
        node.send(topics.BRAIN_STATE, m.BrainState(state=state, step=step, mission_id=mission))  # type: ignore[arg-type]
        node.later(1.0)
        node.run()

    show("NAVIGATING", "go")
    examiner.note_fault(FaultReport(1.5, "kill", "brain is gone"))
    show("IDLE", "", mission="")
    show("IDLE", "")
    assert examiner.active, "a mission that is being taken up has not ended"
    show("NAVIGATING", "go")
    assert examiner.observed.recovery is None
    show("GRABBING", "grab")
    show("RETURNING", "return")
    assert (examiner.observed.fault_at, examiner.observed.recovery) == (1.5, 3.5)


def test_each_line_of_a_conversation_waits_for_the_end_of_the_mission_before_it() -> None:
    lines = (Line("first"), Line("second", "ended"), Line("third", "ended"))
    case = Case(suite="new", seed=0, name="talk", command="first", lines=lines)

    def step(self: Examiner, now: float) -> None:
        self.follow(now)
        self._talk(now)

    talking = type("Talking", (examiner_of(case),), {"step": step})
    node = Node(talking, Config(), SCENE, world=Scene(name="empty", low=SCENE.low, high=SCENE.high, home=SCENE.home))

    def said(state: str, mission: str = "") -> list[str]:
        node.send(topics.BRAIN_STATE, m.BrainState(state=state, mission_id=mission))  # type: ignore[arg-type]
        node.run()
        return [typed.text for typed in node.sent(topics.SPEECH_TEXT)]

    assert said("WAITING") == said("PLANNING", "m-1") == ["first"]
    assert said("WAITING") == said("WAITING") == ["first", "second"], "the third one waits"
    assert said("PLANNING", "m-2") == ["first", "second"]
    assert said("WAITING") == ["first", "second", "third"]


def test_of_missions_in_a_row_each_counts_when_it_ends() -> None:
    case = Case(suite="new", seed=0, name="talk", command="first", lines=(), expect="shown", explores=True)
    seen = Observed(
        missions=[("first", ""), ("go to room 2", "ended at (0, 0)")], shortfall="", ended=True, claimed="delivered"
    )
    result = judge(case, seen, 1.0)
    assert not result.met and result.outcome == "failed" and result.cause == "mission: ended at (0, 0)"
    seen.missions = [("first", ""), ("go to room 2", "")]
    assert judge(case, seen, 1.0).met


# --- the table
def result(seed: int, delivered: bool, struck: float | None = 3.0, lies: bool = False, drops: int = 0) -> Result:
    thing = ThingEvidence("mug", "table", delivered=delivered, drops=drops)
    case = Case(
        suite="chaos", seed=seed, name="brain GRABBING", command="x", lines=(), fault="kill", honest=True,
        timed_faults=(TimedFault("brain", "GRABBING"),),
    )  # fmt: skip
    seen = Observed(
        evidence=Evidence(things=[thing]), claimed="delivered" if delivered or lies else "failed", ended=True,
        fault_at=struck, recovery=2.0 if delivered and struck else None, shortfall="" if delivered else "not at rest",
        claims=[Claim(3.0, "speech", "Done.", "m-1", "x", "mug: not at rest")] if lies else [],
        fault_reports=[FaultReport(struck, "kill", "brain is gone")] if struck else [],
    )  # fmt: skip
    return judge(case, seen, 1.0)


def test_what_came_of_it_is_counted() -> None:
    rows = [result(0, True), result(1, False), result(2, False, lies=True, drops=1), result(3, True, None)]
    found = tally(rows)
    assert (found.recovered, found.reported, found.lost, found.missed) == (1, 1, 1, 1)
    assert (found.dropped, found.lies, found.seconds) == (1, 1, [2.0])
    assert "1/0/0" in cell(rows[:1]) and "2.0 s" in cell(rows[:1])
    assert rows[3].outcome == "not struck" and not rows[3].met and not rows[3].delivered
    assert "not struck" in cell(rows[3:]) and cell([]) == ""
    console = Console(record=True, width=160, file=StringIO())
    console.print(chaos_tables(rows))
    text = console.export_text()
    assert "brain" in text and "GRABBING" in text and "1/1/1" in text and "false claims" in text
