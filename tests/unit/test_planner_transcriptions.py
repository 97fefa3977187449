"""Which of several transcriptions was said, by what could be done for each."""

import pytest

from common.messages import SENSELESS, ActionPlan, PlanStep, Transcription
from services.planner.transcriptions import chosen
from tests.unit.test_planner_service import Desk, targets


def fetch(thing: str) -> ActionPlan:
    return ActionPlan(request_id="", steps=[PlanStep(action="grasp", object=thing)])


def refused(why: str, suggestion: str = "") -> ActionPlan:
    return ActionPlan(request_id="", steps=[], detail=why, suggestion=suggestion)


PLANS = {
    "fetch the mug": fetch("mug"), "get the mug": fetch("mug"), "fetch the mud": fetch("mud"),
    "fetch the cup": fetch("cup"), "fetch the jug": refused("I see no jug"),
    "fletch the mug": refused(f"{SENSELESS} fletch", "fetch the mug"), "fish the mug": refused(SENSELESS),
}  # fmt: skip
PLANS["what fetch the mug"] = ActionPlan(request_id="", steps=[PlanStep(action="say", text="I know of no mug.")])
KNOWN = frozenset({"mug", "cup"})


def meant(heard: str, **others: float) -> str:
    """What is asked about, "" where what was heard first is done."""
    alternatives = [Transcription(text=name.replace("_", " "), score=p) for name, p in others.items()]
    found = chosen(heard, alternatives, PLANS.__getitem__, KNOWN)
    assert found.suggestion or found.steps == PLANS[heard].steps
    assert not (found.suggestion and found.steps), "nothing is done for what is only suggested"
    return found.suggestion


def test_what_makes_a_plan_of_known_things_is_meant_rather_than_what_does_not() -> None:
    assert meant("fish the mug", fetch_the_mug=0.2) == "fetch the mug"
    assert meant("fetch the mud", fetch_the_mug=0.4) == "fetch the mug"
    assert meant("fetch the jug", fetch_the_mug=0.3) == "fetch the mug"
    assert meant("fletch the mug", fetch_the_cup=0.3) == "fetch the cup", "a guess is less than a plan"
    assert meant("fletch the mug", what_fetch_the_mug=0.3) == "fletch the mug", "an answer is little more than a guess"


def test_what_was_heard_first_is_asked_about_where_another_is_nearly_as_likely() -> None:
    assert meant("fetch the mug", fetch_the_cup=0.1) == ""
    assert meant("fetch the mug", fetch_the_cup=0.4) == meant("fetch the mug", fetch_the_cup=0.9) == "fetch the mug"
    assert meant("fetch the mug", get_the_mug=0.45) == "", "nothing else would be done"
    assert meant("fletch the mug", get_the_mug=0.45) == "fetch the mug", "which a yes comes to in any case"


@pytest.mark.parametrize("other", ["fish_the_mug", "fetch_the_jug"])
def test_what_nothing_can_be_done_for_is_never_suggested(other: str) -> None:
    assert meant("fetch the mud", **{other: 0.99}) == ""


@pytest.mark.parametrize(
    ("heard", "others", "planned"),
    [
        ("fetch the mug", {"fetch_the_cup": 0.01}, ["fetch the mug"]),
        ("fetch the mug", {"fetch_the_cup": 0.3, "fetch_the_mud": 0.25}, ["fetch the mug", "fetch the cup"]),
        ("fish the mug", {"fetch_the_cup": 0.1, "fetch_the_mug": 0.4}, ["fish the mug", "fetch the mug"]),
        ("fletch the mug", {"fetch_the_mug": 0.4, "fish_the_mug": 0.02}, ["fletch the mug", "fetch the mug"]),
    ],
)  # fmt: skip
def test_only_what_may_change_the_outcome_is_planned_and_once(
    heard: str, others: dict[str, float], planned: list[str]
) -> None:
    found: list[str] = []

    def plan(text: str) -> ActionPlan:
        found.append(text)
        return PLANS[text]

    chosen(heard, [Transcription(text=name.replace("_", " "), score=p) for name, p in others.items()], plan, KNOWN)
    assert found == planned


def test_a_request_with_alternatives_is_told_what_to_ask_about() -> None:
    node = Desk()
    others = [{"text": "bring me the red mug", "score": 0.4}]
    found = node.ask("bring me the reed mud", "m.1", alternatives=others)
    assert (found.steps, found.suggestion) == ([], "bring me the red mug")
    found = node.ask("bring me the red mug", "m.2", alternatives=[{"text": "bring me the reed mud", "score": 0.4}])
    assert targets(found)[0] == "red mug" and not found.suggestion
