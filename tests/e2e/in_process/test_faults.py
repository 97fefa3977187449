"""Scenarios with faults, in one process: they repeat with a seed, are noticed, and end as what they are."""

import msgspec
import pytest

from common.scene import load_scene
from evaluation import runner
from evaluation.case import Case, Line, Result
from evaluation.faults.messages import Rule
from evaluation.suites.table import FAULTS, cases
from judge.evidence import Want

pytestmark = pytest.mark.timeout(600)
FETCH = ("brain.pipeline=fetch",)


def case_of(seed: int, thing: str, **more: object) -> Case:
    """A fetch in the small flat, typed."""
    command = f"bring me the {thing}"
    fields = {
        "suite": "fetch", "seed": seed, "name": "fetch", "command": command, "lines": (Line(command),),
        "thing": thing, "wants": (Want(thing, ("delivery tray",)),), "settings": FETCH,
        "scene": load_scene("minimal"), **more,
    }  # fmt: skip
    return Case(**fields)  # type: ignore[arg-type]


def untimed(result: Result) -> dict[str, object]:
    return {k: v for k, v in result.evidence.items() if k != "wall_seconds"}


@pytest.mark.slow
def test_a_seed_repeats_with_all_its_evidence() -> None:
    """To the last digit; the first seconds of a mission are enough to differ in."""
    first, second = (runner.run(case_of(2, "green can", limit=20.0)) for _ in range(2))
    assert first.outcome == "timeout"
    assert float(str(first.evidence["driven"])) > 0.5
    assert untimed(first) == untimed(second)


@pytest.mark.slow
def test_a_gripper_that_does_not_close_is_noticed_and_tried_again() -> None:
    rule = Rule(service="manipulation", key="gripper_command", kind="drop", match={"position": 1.0})
    result = runner.run(case_of(2, "yellow block", rules=(rule,)))
    assert result.delivered, result.evidence
    assert [s["fault"] for s in result.evidence["strikes"]] == ["drop"]  # type: ignore[attr-defined]
    assert result.evidence["things"][0]["carried"] > 0.5  # type: ignore[index]
    always = msgspec.structs.replace(rule, count=1000)
    lame = runner.run(case_of(2, "yellow block", rules=(always,)))
    assert (lame.outcome, lame.evidence["claimed"]) == ("reported", "failed")
    assert lame.cause.startswith("grasp")


@pytest.mark.parametrize("key", ["brain/navigation_status", "navigation_feedback"])
def test_a_service_that_raises_ends_its_case_as_crashed(key: str) -> None:
    """At its start, or with its first answer."""
    rule = Rule(service="navigation", key=key, kind="edit", fields={"status": "flying"})
    result = runner.run(case_of(2, "green can", rules=(rule,)))
    assert result.outcome == "crashed"
    assert "status" in result.cause


@pytest.mark.slow
@pytest.mark.parametrize("fault", ["shove", "slip", "jam", "heavy", "wide"])
def test_every_fault_of_a_grasp_strikes_and_nothing_is_claimed_that_is_not_so(fault: str) -> None:
    result = runner.run(cases("faults", 1, 2 * len(FAULTS) + FAULTS.index(fault))[0])
    strikes = result.evidence["strikes"]
    assert isinstance(strikes, list) and [s["fault"] for s in strikes] == [fault], result.evidence
    assert result.outcome not in ("not struck", "false_success", "crashed", "timeout"), result.cause
    assert not result.false_claims
