"""What counts as a claim of success, and the judgement over evidence and claims."""

import pytest

from common import messages as m
from judge.claims import Claim, ClaimListener, Statement, announces, false_claims
from judge.evidence import Evidence, ThingEvidence
from judge.verdict import objections, untouched


def state(
    name: m.BrainStateName, mission: str = "", detail: str = "", last: m.MissionOutcome | None = None
) -> m.BrainState:
    return m.BrainState(state=name, mission_id=mission, command="fetch" if mission else "", detail=detail, last=last)


def ended(outcome: str = "delivered", mission: str = "m-1", t: float = 5.0) -> m.MissionOutcome:
    return m.MissionOutcome(id=mission, command="bring", outcome=outcome, reason="so", t=t)  # type: ignore[arg-type]


def test_completed_is_a_claim_when_it_is_entered() -> None:
    listener = ClaimListener()
    assert listener.state(state("NAVIGATING", "m-1")) == []
    said = Statement("brain/state", "COMPLETED mug delivered", "m-1", "fetch")
    assert listener.state(state("COMPLETED", "m-1", "mug delivered")) == [said]
    assert listener.state(state("COMPLETED", "m-1", "still")) == [], "said again, and no new claim"
    assert listener.state(state("WAITING")) == []
    assert listener.state(state("COMPLETED")) == [Statement("brain/state", "COMPLETED", "m-1", "fetch")]
    assert ClaimListener().state(state("COMPLETED", "m-1")) == [Statement("brain/state", "COMPLETED", "m-1", "fetch")]


def test_an_outcome_delivered_is_a_claim_once() -> None:
    listener = ClaimListener()
    before = ended(t=1.0)
    assert listener.state(state("WAITING", last=before)) == [], "of a mission before"
    said = Statement("brain/state", "delivered so", "m-1", "bring")
    assert listener.state(state("WAITING", last=ended(t=2.0))) == [said]
    assert listener.state(state("WAITING", last=ended(t=2.0))) == []
    assert listener.state(state("WAITING", last=ended("failed", t=3.0))) == []
    assert listener.state(state("WAITING", last=ended("cancelled", t=4.0))) == []
    assert listener.state(state("WAITING", last=None)) == []
    assert listener.state(state("WAITING", last=ended(t=5.0))) == [said]


def test_success_on_system_status_is_a_claim_when_it_is_entered() -> None:
    listener = ClaimListener()
    assert listener.status(m.SystemStatus(state="EXECUTING", mission_id="m-2")) == []
    said = Statement("system_status", "SUCCESS there", "m-2", "")
    assert listener.status(m.SystemStatus(state="SUCCESS", mission_id="m-2", detail="there")) == [said]
    assert listener.status(m.SystemStatus(state="SUCCESS", mission_id="m-2")) == []
    assert listener.status(m.SystemStatus(state="IDLE")) == []
    listener.state(state("RELEASING", "m-3"))
    assert listener.status(m.SystemStatus(state="SUCCESS")) == [Statement("system_status", "SUCCESS", "m-3", "fetch")]


def test_a_sentence_speaks_of_the_mission_at_hand() -> None:
    listener = ClaimListener()
    assert listener.sentence("Done.") == [Statement("speech", "Done.")]
    listener.state(state("RELEASING", "m-1"))
    listener.state(state("WAITING"))
    assert listener.sentence("Done.") == [Statement("speech", "Done.", "m-1", "fetch")]
    assert listener.sentence("I could not reach the mug.") == []


@pytest.mark.parametrize(
    ("sentence", "claim"),
    [
        ("Done.", True),
        ("I have delivered the red mug.", True),
        ("The mug is DELIVERED", True),
        ("Here is your apple.", True),
        ("Here are the cans.", True),
        ("Here you are.", True),
        ("There you go!", True),
        ("I brought the mug.", True),
        ("I put the red mug on the delivery tray.", True),
        ("Did you say put the mug on the desk?", False),
        ("I have not delivered it.", False),
        ("I am not sure that it worked.", False),
        ("I couldn't put it there.", False),
        ("Sorry, that was not done.", False),
        ("It failed before it was done.", False),
        ("I will put it on the tray.", False),
        ("All right.", False),
        ("I am listening.", False),
        ("The computer is on.", False),
    ],
)
def test_a_sentence_that_announces_a_success(sentence: str, claim: bool) -> None:
    assert announces(sentence) == claim


def claim(mission: str, false: str = "") -> Claim:
    return Claim(1.0, "brain/state", "COMPLETED", mission, "bring", false)


def test_a_mission_has_one_false_claim_however_often_it_is_said() -> None:
    assert false_claims([]) == false_claims([claim("m-1"), claim("m-2")]) == 0
    assert false_claims([claim("m-1"), claim("m-1", "on floor"), claim("m-1", "on floor")]) == 1
    assert false_claims([claim("m-1", "on floor"), claim("m-2"), claim("m-3", "toppled")]) == 2


def thing(good: bool) -> ThingEvidence:
    return ThingEvidence("mug", "table", delivered=good, why="" if good else "not at rest")


def test_nothing_may_be_hit_or_disturbed() -> None:
    assert untouched(Evidence(moved=["mug"]))
    assert not untouched(Evidence(hits=["base on desk"]))
    assert not untouched(Evidence(disturbed=["can"]))


def test_objections_name_everything_that_is_wrong() -> None:
    assert objections(Evidence(things=[thing(True)]), [claim("m-1")]) == []
    assert objections(Evidence(), []) == ["nothing was wanted"]
    bad = Evidence(things=[thing(False)], hits=["base on desk"], disturbed=["can"])
    assert objections(bad, [claim("m-1", "x"), claim("m-1", "x")]) == [
        "mug: not at rest", "hit: base on desk", "disturbed: can", "1 false claim",
    ]  # fmt: skip
    assert objections(Evidence(things=[thing(True)]), [claim("1", "x"), claim("2", "x")]) == ["2 false claims"]
