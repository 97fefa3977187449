"""The verdict on a case: what the robot claims never counts for it, and every false claim against it."""

from typing import Any

import msgspec
import pytest

from evaluation.case import Case, Line, Observed
from evaluation.faults.physical.fault import PhysicalFault
from evaluation.faults.reports import FaultReport
from evaluation.report.statistics import interval, percent, share, wilson
from evaluation.report.text import passed
from evaluation.verdict import cause, judge
from judge.claims import Claim
from judge.effects import Effect, Shown
from judge.evidence import Evidence, ThingEvidence, Want
from judge.goal import Goal

WANT = Want("mug", ("tray",))
CASE = Case(suite="fetch", seed=3, name="fetch", command="bring", lines=(Line("bring"),), wants=(WANT,), thing="mug")
THERE = ThingEvidence("mug", "table", lifted=True, delivered=True)
AWAY = ThingEvidence("mug", "table", why="never lifted by the gripper; on table, not on tray")
MISSED = "mug: never lifted by the gripper; on table, not on tray"
GOOD, BAD = Evidence(things=[THERE], driven=4.8, moved=["mug"]), Evidence(things=[AWAY], driven=4.8)
HIT = Evidence(things=[THERE], hits=["base on desk"])
SHOVED = Evidence(things=[THERE], disturbed=["can"])


def claim(false: str = "", mission: str = "m-1") -> Claim:
    return Claim(1.0, "brain/state", "delivered", mission, "bring", false)


def seen(evidence: Evidence, claimed: str = "none", reason: str = "", **more: Any) -> Observed:
    short = "; ".join(f"{t.thing}: {t.why}" for t in evidence.things if not t.delivered)
    fields = {"ended": True, "shortest": 2.4, "stage": "GRABBING", "shortfall": short, **more}
    return Observed(evidence=evidence, claimed=claimed, reason=reason, **fields)


@pytest.mark.parametrize(
    ("observed", "outcome", "why"),
    [
        (seen(GOOD, "delivered", claims=[claim()]), "delivered", ""),
        (seen(GOOD), "delivered", ""),
        (seen(BAD, "delivered", claims=[claim(MISSED)]), "false_success", "evidence: never lifted by the gripper"),
        (seen(BAD, "failed", "No.", failed_at="GRABBING", code="BLOCKED"), "reported", "grasp: BLOCKED"),
        (seen(BAD, "failed", "No."), "reported", "grasp"),
        (seen(BAD, "cancelled", stage=""), "reported", "start"),
        (seen(BAD, "failed", stage="ODD"), "reported", "odd"),
        (seen(BAD, ended=False), "timeout", "timeout: grasp"),
        (seen(BAD, ended=False, stage=""), "timeout", "timeout: start"),
        (seen(BAD), "failed", "grasp: delivered was expected"),
        (seen(BAD, stage=""), "failed", "start: delivered was expected"),
        (seen(BAD, "delivered", claims=[claim()]), "failed", "evidence: never lifted by the gripper"),
        (seen(HIT, "delivered"), "failed", "contact"),
        (seen(GOOD, wrong=["can", "apple"]), "failed", "wrong thing: can, apple"),
        (
            seen(GOOD, shown=[Shown("a", True), Shown("b", False, "not b")], shortfall="not b"),
            "failed",
            "effect: not b",
        ),
        (seen(SHOVED, "delivered"), "failed", "disturbed"),
        (seen(SHOVED, "failed", failed_at="GRABBING", code="SLIPPED"), "reported", "grasp: SLIPPED"),
        (Observed(crash="KeyError: 'x'"), "crashed", "crash: KeyError: 'x'"),
    ],
)
def test_verdicts(observed: Observed, outcome: str, why: str) -> None:
    result = judge(CASE, observed, 1.0)
    assert (result.outcome, result.cause) == (outcome, why)
    assert result.delivered == result.met == (outcome == "delivered")


@pytest.mark.parametrize(
    "then",
    [
        {"evidence": GOOD, "claimed": "delivered"}, {"evidence": BAD, "claimed": "failed"}, {"crash": "KeyError"},
        {"ended": False}, {"evidence": HIT}, {"stopped": True},
    ],
)  # fmt: skip
@pytest.mark.parametrize("case", [CASE, msgspec.structs.replace(CASE, expect="stopped", honest=True)])
def test_a_false_claim_counts_whatever_else_happens(then: dict[str, Any], case: Case) -> None:
    fields = {"evidence": BAD, "ended": True, "claims": [claim(), claim(MISSED, "m-2"), claim("x: on floor", "m-3")]}
    result = judge(case, Observed(**{**fields, **then}), 1.0)
    assert (result.outcome, result.false_claims, result.met, result.delivered) == ("false_success", 2, False, False)
    assert result.spl == 0.0 and result.cause == "evidence: never lifted by the gripper"


def test_an_honest_report_is_enough_where_the_case_says_so() -> None:
    observed = seen(BAD, "failed", failed_at="NAVIGATING", code="BLOCKED")
    assert not judge(CASE, observed, 1.0).met
    honest = msgspec.structs.replace(CASE, honest=True)
    assert judge(honest, observed, 1.0).met and judge(honest, observed, 1.0).cause == ""
    assert not judge(honest, seen(BAD, "none"), 1.0).met
    assert not judge(honest, seen(HIT, "delivered"), 1.0).met


@pytest.mark.parametrize(
    ("evidence", "outcome"),
    [
        (Evidence(driven=0.29), "declined"),
        (Evidence(driven=0.3), "failed"),
        (Evidence(moved=["mug"]), "failed"),
    ],
)
def test_where_nothing_should_happen_nothing_may_move(evidence: Evidence, outcome: str) -> None:
    idle = msgspec.structs.replace(CASE, expect="nothing")
    result = judge(idle, Observed(evidence=evidence, ended=True, stage="NAVIGATING", claimed="cancelled"), 1.0)
    assert (result.outcome, result.met) == (outcome, outcome == "declined")
    assert result.cause == ("" if result.met else "navigation: nothing was expected")


@pytest.mark.parametrize(
    ("evidence", "stopped", "outcome", "why"),
    [
        (Evidence(standing=True), True, "stopped", ""),
        (Evidence(standing=True), False, "failed", "navigation: stopped was expected"),
        (Evidence(standing=False), True, "failed", "navigation: stopped was expected"),
        (Evidence(standing=True, hits=["base on desk"]), True, "failed", "contact"),
        (Evidence(standing=True, disturbed=["can"]), True, "failed", "disturbed"),
    ],
)
def test_a_stop_must_have_stopped_the_robot(evidence: Evidence, stopped: bool, outcome: str, why: str) -> None:
    stop = msgspec.structs.replace(CASE, expect="stopped")
    observed = Observed(evidence=evidence, ended=True, stopped=stopped, stage="NAVIGATING", shortfall="mug: on table")
    result = judge(stop, observed, 1.0)
    assert (result.outcome, result.cause) == (outcome, why)


def test_a_fault_that_never_took_effect_says_nothing_of_the_robot() -> None:
    jam = msgspec.structs.replace(CASE, fault="jam", physical=(PhysicalFault(kind="jam", thing="mug"),), honest=True)
    for observed in (seen(GOOD, "delivered", claims=[claim()]), seen(GOOD, "failed", "(GRABBING: EMPTY_GRASP)")):
        result = judge(jam, observed, 1.0)
        assert (result.outcome, result.met, result.delivered) == ("not struck", False, False)
        assert result.cause == "not struck: jam"
        observed.fault_reports = [FaultReport(2.0, "jam", "a finger stays")]
        assert judge(jam, observed, 1.0).met
    assert judge(jam, seen(GOOD, "none", ended=False), 1.0).outcome == "timeout", "whatever struck"


@pytest.mark.parametrize(
    ("evidence", "claimed", "said", "outcome"),
    [
        (Evidence(), "failed", "The mug is too heavy.", "reported"),
        (Evidence(), "failed", "Hello.", "failed"),
        (Evidence(), "delivered", "The mug is too heavy.", "failed"),
        (Evidence(hits=["hand on table"]), "failed", "The mug is too heavy.", "failed"),
        (Evidence(things=[ThingEvidence("mug", "table", drops=1)]), "failed", "The mug is too heavy.", "failed"),
    ],
)
def test_what_cannot_be_done_is_refused_aloud_and_nothing_breaks(
    evidence: Evidence, claimed: str, said: str, outcome: str
) -> None:
    heavy = msgspec.structs.replace(CASE, expect="reported")
    observed = seen(evidence, claimed, explained="The mug is too heavy.", said=[said])
    result = judge(heavy, observed, 1.0)
    assert (result.outcome, result.met) == (outcome, outcome == "reported")


def test_the_row_of_the_report_has_everything() -> None:
    observed = seen(GOOD, "delivered", claims=[claim()], robot_seconds=31.0, said=["Done."], states=["WAITING"])
    observed.fault_at, observed.recovery = 2.0, 3.0
    observed.fault_reports = [FaultReport(2.0, "kill", "brain is gone")]
    observed.missions, observed.mapping = [("bring the mug", "")], {"seconds": 60.0}
    result = judge(msgspec.structs.replace(CASE, fault="kill"), observed, 7.26)
    assert (result.seed, result.command, result.name, result.sim_seconds) == (3, "bring", "fetch", 31.0)
    assert (result.spl, result.wall_seconds, result.false_claims) == (0.5, 7.26, 0)
    assert result.evidence == {
        "name": "fetch", "fault": "kill", "expected": "delivered", "met": True, "claimed": "delivered", "reason": "",
        **msgspec.to_builtins(GOOD), "shortest": 2.4, "spl": 0.5, "sim_seconds": 31.0, "wall_seconds": 7.3,
        "states": ["WAITING"], "said": ["Done."], "struck": 2.0, "recovery": 3.0, "shortfall": "", "crash": "",
        "effects": [], "wrong": [], "strikes": [{"t": 2.0, "fault": "kill", "what": "brain is gone"}],
        "claims": [msgspec.to_builtins(claim())], "missions": [("bring the mug", "")], "mapping": {"seconds": 60.0},
    }  # fmt: skip


def test_the_cause_of_a_failure_that_the_robot_gave_a_code_for_is_the_code() -> None:
    observed = seen(HIT, "failed", failed_at="RETURNING", code="BLOCKED")
    assert cause(CASE, observed, "failed") == "navigation: BLOCKED"
    observed.claimed = "none"
    assert cause(CASE, observed, "failed") == "contact"


def test_a_line_may_have_a_goal_of_its_own() -> None:
    there = Goal(effects=(Effect("ends", "desk"),))
    go, bring = Line("go to the desk", goal=there), Line("bring me the mug")
    case = msgspec.structs.replace(CASE, lines=(go, bring), effects=(Effect("still"),))
    assert case.goal_of(go) == there
    assert case.goal_of(bring) == case.goal == Goal((WANT,), (Effect("still"),))
    assert msgspec.structs.replace(case, expect="shown").goal_of(bring) == case.goal
    nothing = msgspec.structs.replace(case, expect="nothing")
    assert nothing.goal_of(bring) == Goal() != nothing.goal


# --- statistics
@pytest.mark.parametrize(
    ("good", "count", "low", "high"),
    [(81, 263, 0.2553, 0.3662), (15, 148, 0.0624, 0.1605), (0, 20, 0.0, 0.1611), (1, 29, 0.0061, 0.1718)],
)
def test_wilson_intervals_are_the_published_ones(good: int, count: int, low: float, high: float) -> None:
    """R. G. Newcombe, "Two-sided confidence intervals for the single proportion", 1998, table I, method 3."""
    assert wilson(good, count) == pytest.approx((low, high), abs=5e-5)
    assert wilson(count - good, count) == pytest.approx((1 - high, 1 - low), abs=5e-5)


def test_without_cases_every_share_is_possible() -> None:
    assert wilson(0, 0) == (0.0, 1.0) and interval(0, 0) == [0.0, 1.0]


def test_rates_in_words_have_their_interval() -> None:
    assert interval(81, 263) == [0.255, 0.366]
    assert percent(81, 263) == "26 to 37 %"
    assert share(81, 263) == "81 of 263 (26 to 37 %)"


@pytest.mark.parametrize(
    ("met", "count", "false", "bar", "good"),
    [(19, 20, 0, 0.95, True), (18, 20, 0, 0.95, False), (20, 20, 1, 0.95, False), (0, 20, 0, 0.0, True),
     (57, 60, 0, 0.95, True), (6, 6, 0, 1.0, True), (5, 6, 0, 1.0, False), (0, 0, 0, 0.9, False)],
)  # fmt: skip
def test_the_bar_is_met_without_a_false_claim_only(met: int, count: int, false: int, bar: float, good: bool) -> None:
    assert passed(met, count, false, bar) == good


# --- at the edges of the words
def test_what_was_shown_counts_as_delivered_only_where_something_was_to_be_brought() -> None:
    bring, look = (msgspec.structs.replace(CASE, expect="shown", wants=wants) for wants in ((WANT,), ()))
    results = [judge(case, seen(GOOD, "delivered"), 1.0) for case in (bring, look)]
    assert [r.outcome for r in results] == ["shown", "shown"] and all(r.met for r in results)
    assert [(r.delivered, r.spl) for r in results] == [(True, 0.5), (False, 0.0)]


def test_the_share_of_the_way_has_three_digits() -> None:
    driven = msgspec.structs.replace(GOOD, driven=3.0)
    assert judge(CASE, seen(driven, "delivered", shortest=1.0), 1.0).spl == 0.333


def test_a_fault_that_did_not_strike_is_named() -> None:
    assert cause(CASE, seen(GOOD), "not struck") == "not struck: fault"
    assert cause(msgspec.structs.replace(CASE, fault="slip"), seen(GOOD), "not struck") == "not struck: slip"


@pytest.mark.parametrize("expect", ["delivered", "shown"])
def test_what_is_missing_comes_before_what_was_disturbed(expect: str) -> None:
    case = msgspec.structs.replace(CASE, expect=expect)
    shoved = Evidence(things=[AWAY], disturbed=["can"])
    assert cause(case, seen(shoved, "delivered"), "failed") == "evidence: never lifted by the gripper"
    stop = msgspec.structs.replace(CASE, expect="stopped")
    assert cause(stop, seen(shoved, "delivered"), "failed") == "disturbed"


@pytest.mark.parametrize(
    ("shortfall", "first"),
    [
        ("mug: on table: upside down; can: on floor; apple: lost", "on table: upside down"),
        ("mug: a: b: c", "a: b: c"), ("nothing was wanted", "nothing was wanted"),
    ],
)  # fmt: skip
def test_the_first_shortfall_is_told_without_the_name_of_the_thing(shortfall: str, first: str) -> None:
    assert cause(CASE, seen(BAD, "delivered", shortfall=shortfall), "failed") == f"evidence: {first}"
    missions = [("map the home", ""), ("bring the mug", shortfall), ("bring the can", "can: lost")]
    assert cause(CASE, seen(BAD, "delivered", missions=missions), "failed") == f"mission: {first}"
