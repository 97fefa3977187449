"""Evidence from looks at the world, and the verdict: what the robot claims never counts."""

import math
from typing import Any

import msgspec
import pytest

from evaluation.case import Case, Line, Observed
from evaluation.evidence import Evidence, Recorder, Want, spl
from evaluation.replica import Look, Thing
from evaluation.verdict import judge

WANT = Want("mug", ("tray",))
ON_TABLE = Thing(position=(3.0, 0.0, 0.7), tilt=0.0, on="table", held=False, touched=False)
HELD = Thing(position=(3.0, 0.0, 0.9), tilt=0.0, on="", held=True, touched=True)
ON_TRAY = Thing(position=(0.7, 0.0, 0.5), tilt=0.0, on="tray", held=False, touched=False)
CAN = Thing(position=(3.3, 0.0, 0.75), tilt=0.0, on="table", held=False, touched=False)


def changed(thing: Thing, **fields: Any) -> Thing:
    return msgspec.structs.replace(thing, **fields)


def look(t: float, mug: Thing, x: float = 0.0, can: Thing = CAN, **more: Any) -> Look:
    return Look(t, (x, 0.0, 0.0), {"mug": mug, "can": can}, more.get("hits", ()), more.get("pushed", frozenset()))


GOOD = [
    look(0.0, ON_TABLE), look(1.0, ON_TABLE, 2.4), look(2.0, HELD, 2.4), look(3.0, HELD, 1.2), look(4.0, HELD),
    look(5.0, ON_TRAY), look(5.5, ON_TRAY), look(6.0, ON_TRAY),
]  # fmt: skip


def evidence(looks: list[Look]) -> Evidence:
    recorder = Recorder((WANT,), {"mug": "mug", "can": "can"})
    for one in looks:
        recorder.see(one)
    return recorder.conclude()


def test_lifted_carried_and_at_rest_is_delivered() -> None:
    found = evidence(GOOD)
    mug = found.things[0]
    assert mug.delivered and mug.lifted and mug.at_rest and not mug.dropped and mug.why == ""
    assert (mug.carried, found.driven) == (pytest.approx(2.4), pytest.approx(4.8))
    assert (found.hits, found.disturbed, found.moved) == ([], [], ["mug"])


@pytest.mark.parametrize(("bins", "later", "drops"), [({"tray"}, 0.4, 0), (set(), 0.4, 1), ({"tray"}, 2.0, 1)])
def test_a_thing_may_fall_into_the_bin_it_belongs_to(bins: set[str], later: float, drops: int) -> None:
    falling = changed(HELD, held=False, touched=False)
    recorder = Recorder((WANT,), {"mug": "mug"}, frozenset(bins))
    for one in [*GOOD[:5], look(4.5, falling), look(4.5 + later, ON_TRAY), look(9.0, ON_TRAY)]:
        recorder.see(one)
    mug = recorder.conclude().things[0]
    assert (mug.drops, mug.delivered) == (drops, not drops)


@pytest.mark.parametrize(
    ("looks", "why"),
    [
        ([*GOOD[:2], *GOOD[5:]], "never lifted"),
        (GOOD[:5], "still touched by the gripper"),
        ([*GOOD[:4], look(3.5, changed(HELD, held=False, touched=False), 1.0), *GOOD[5:]], "dropped"),
        ([*GOOD[:4], look(3.5, changed(ON_TABLE, on="floor"), 1.0), *GOOD[5:]], "dropped"),
        ([*GOOD[:-1], look(6.0, changed(ON_TRAY, on="floor", position=(0.9, 0, 0.05)))], "on floor, not on tray"),
        ([*GOOD[:-1], look(6.0, changed(ON_TRAY, position=(0.72, 0.0, 0.5)))], "not at rest"),
    ],
)
def test_what_is_not_a_delivery(looks: list[Look], why: str) -> None:
    mug = evidence(looks).things[0]
    assert not mug.delivered
    assert why in mug.why


def test_furniture_is_hit_when_the_contact_is_deep() -> None:
    touched = [*GOOD[:3], look(3.0, HELD, 1.2, hits=(("base", "desk", 0.002),)), *GOOD[4:]]
    rammed = [*GOOD[:3], look(3.0, HELD, 1.2, hits=(("base", "desk", 0.02),)), *GOOD[4:]]
    assert evidence(touched).hits == []
    assert evidence(rammed).hits == ["base on desk, 20 mm"]


def test_others_are_disturbed_only_by_the_robot() -> None:
    tipped = changed(CAN, tilt=math.radians(88))
    pushed = [*GOOD[:2], look(2.0, HELD, 2.4, tipped, pushed=frozenset({"can"}))]
    pushed += [look(one.t, one.things["mug"], one.base[0], tipped) for one in GOOD[3:]]
    alone = [look(one.t, one.things["mug"], one.base[0], tipped if one.t > 1 else CAN) for one in GOOD]
    assert evidence(pushed).disturbed == ["can"]
    assert evidence(alone).disturbed == []


CASE = Case(suite="fetch", seed=3, name="fetch", command="bring", lines=(Line("bring"),), wants=(WANT,), thing="mug")


def seen(looks: list[Look], claimed: str, reason: str = "", **more: Any) -> Observed:
    fields = {"ended": True, "shortest": 2.4, "stage": "GRABBING", **more}
    return Observed(evidence=evidence(looks), claimed=claimed, reason=reason, **fields)


HIT = [*GOOD[:3], look(3.0, HELD, 1.2, hits=(("base", "desk", 0.02),)), *GOOD[4:]]


@pytest.mark.parametrize(
    ("observed", "outcome", "cause"),
    [
        (seen(GOOD, "delivered"), "delivered", ""),
        (seen(GOOD, "none"), "delivered", ""),
        (seen(GOOD[:5], "delivered"), "false_success", "evidence: still touched by the gripper"),
        (seen(GOOD[:2], "failed", "No. (GRABBING: BLOCKED: joint_4)"), "reported", "grasp: BLOCKED"),
        (seen(GOOD[:2], "none", ended=False), "timeout", "timeout: grasp"),
        (seen(GOOD[:2], "none"), "failed", "grasp: delivered was expected"),
        (seen(HIT, "delivered"), "failed", "contact"),
        (Observed(crash="KeyError: 'x'"), "crashed", "crash: KeyError: 'x'"),
    ],
)
def test_verdicts(observed: Observed, outcome: str, cause: str) -> None:
    result = judge(CASE, observed, 1.0)
    assert (result.outcome, result.cause) == (outcome, cause)
    assert result.delivered == (outcome == "delivered")


def test_an_honest_report_is_enough_where_the_case_says_so() -> None:
    observed = seen(GOOD[:2], "failed", "(NAVIGATING: BLOCKED: no way)")
    assert not judge(CASE, observed, 1.0).met
    honest = msgspec.structs.replace(CASE, honest=True)
    assert judge(honest, observed, 1.0).met
    assert not judge(honest, seen(GOOD[:5], "delivered"), 1.0).met


def test_where_nothing_should_happen_nothing_may_move() -> None:
    idle = msgspec.structs.replace(CASE, expect="nothing")
    still = [look(0.0, ON_TABLE), look(1.0, ON_TABLE, 0.1)]
    assert judge(idle, seen(still, "cancelled"), 1.0).outcome == "declined"
    assert judge(idle, seen([*still, look(2.0, ON_TABLE, 2.0)], "cancelled"), 1.0).outcome == "failed"
    assert judge(idle, seen(GOOD, "delivered"), 1.0).outcome == "false_success"


def test_a_stop_must_have_stopped_the_robot() -> None:
    stop = msgspec.structs.replace(CASE, expect="stopped")
    assert judge(stop, seen(GOOD[:2], "cancelled", stopped=True), 1.0).met
    assert not judge(stop, seen(GOOD[:2], "cancelled"), 1.0).met


def test_path_efficiency() -> None:
    assert spl(True, 6.0, 8.0) == 0.75
    assert spl(True, 6.0, 5.0) == 1.0
    assert spl(False, 6.0, 6.0) == spl(True, 0.0, 6.0) == 0.0
    assert judge(CASE, seen(GOOD, "delivered"), 1.0).spl == 0.5
