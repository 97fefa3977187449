"""The brain's part in names: the request to perception, the question which thing is meant, what is said of it."""

import pytest

from common import messages as m
from common import topics
from tests.unit.brain_bench import Bench
from tests.unit.test_brain_vla import answer_plan, asked

TEACH = [m.PlanStep(action="teach", text="vitamin box")]


def told(steps: list[m.PlanStep]) -> Bench:
    bench = asked("this is my vitamin box", enable_confirmation=False)
    answer_plan(bench, 1, steps)
    return bench


def answer(bench: Bench, count: int, **fields: object) -> m.TeachRequest:
    request = bench.next_goal(topics.TEACH, count)
    result = m.TeachResult(goal_id=request.id, attempt=request.attempt, name=request.name, **fields)  # type: ignore[arg-type]
    bench.send(topics.TAUGHT, result)
    bench.step()
    return request


def said(bench: Bench) -> list[str]:
    return [g.goal.removeprefix("say ") for g in bench.sent(topics.SPEECH_GOAL) if g.goal.startswith("say ")]


def ended(bench: Bench) -> m.MissionOutcome:
    bench.until(lambda: bench.state.last is not None)
    assert bench.state.last is not None
    return bench.state.last


def test_what_stands_before_it_is_taught_and_said_to_be_known() -> None:
    bench = told(TEACH)
    request = answer(bench, 1, ok=True, label="white box")
    assert (request.name, request.label, request.forget) == ("vitamin box", "", False)
    assert ended(bench).outcome == "delivered" and "I will know the vitamin box again." in said(bench)
    assert not bench.count(topics.NAV_GOAL) and not bench.count(topics.MANIPULATION_GOAL)


def test_of_two_it_asks_which_and_teaches_the_one_that_was_meant() -> None:
    bench = told(TEACH)
    answer(bench, 1, ok=False, code="AMBIGUOUS", detail="which", candidates=["blue can", "white box"])
    bench.until(lambda: "Do you mean the blue can or the white box?" in said(bench))
    bench.until(lambda: bench.sent(topics.SPEECH_GOAL)[-1].goal == "listen")
    goal = bench.sent(topics.SPEECH_GOAL)[-1]
    bench.send(topics.SPEECH_RESULT, m.SpeechResult(text="the white one", goal_id=goal.id))
    request = answer(bench, 2, ok=True, label="white box")
    assert (request.name, request.label) == ("vitamin box", "white box")
    assert ended(bench).outcome == "delivered"


@pytest.mark.parametrize("action", ["teach", "forget"])
def test_a_refusal_is_said_and_no_success_is_claimed(action: str) -> None:
    bench = told([m.PlanStep(action=action, text="mug")])  # type: ignore[arg-type]
    answer(bench, 1, ok=False, code="NAME_TAKEN", detail="mug means every mug already")
    outcome = ended(bench)
    assert outcome.outcome == "failed" and outcome.code == "NAME_TAKEN"
    bench.until(lambda: any("mug means every mug already" in line for line in said(bench)))


def test_what_the_page_has_taught_is_no_answer_to_the_brain() -> None:
    bench = told(TEACH)
    bench.next_goal(topics.TEACH, 1)
    bench.send(topics.TAUGHT, m.TeachResult(goal_id="page-1", ok=True, name="tea", label="can"))
    bench.step(1.0)
    assert bench.state.last is None and not any("know" in line for line in said(bench))
    answer(bench, 1, ok=True, label="white box")
    assert ended(bench).outcome == "delivered"
