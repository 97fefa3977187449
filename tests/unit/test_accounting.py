"""A plan that has nothing to do with a colour, a kind or a place that was said is asked about first."""

import pytest

from common.messages import PlanStep, RejectedPlan
from common.plan_rules import known_world
from evaluation.everyday.flat import CONFIG, FLAT, HOME
from evaluation.everyday.understanding import planned
from services.planner.grammar import grammar
from services.planner.grammar.accounting import as_command, unaccounted
from services.planner.grammar.vocabulary import Vocabulary
from services.planner.world import World, believed

WORLD: World = believed(HOME, known_world(HOME, [o.label for o in FLAT], ""), FLAT)
BRING = [
    PlanStep(action="find", object="red mug"), PlanStep(action="grasp", object="red mug"),
    PlanStep(action="return"), PlanStep(action="release"),
]  # fmt: skip
PUT = [*BRING[:2], PlanStep(action="place", object="red mug", target="bin")]


@pytest.mark.parametrize(
    ("said", "ignored"),
    [
        ("bring me the red mug", []),
        ("bring me the cup on the living table", []),
        ("can i have the red mug", []),
        ("bring me the red mug next to the green can", []),
        ("bring me the red mug but not the white one", []),
        ("the mug is on the desk", ["desk"]),
        ("bring me a blue or a red mug", []),
        ("bring me the blue mug", ["blue"]),
        ("bring me the red bottle", ["bottle"]),
    ],
)
def test_what_left_no_trace_in_a_plan_is_found(said: str, ignored: list[str]) -> None:
    assert unaccounted([said], BRING, WORLD, Vocabulary(WORLD, CONFIG)) == ignored


def test_an_answer_sets_nothing_in_motion_and_needs_no_trace() -> None:
    answer = [PlanStep(action="say", text="I do not know.")]
    assert unaccounted(["where is the blue bottle"], answer, WORLD, Vocabulary(WORLD, CONFIG)) == []


def test_a_plan_is_said_as_a_command_that_is_planned_alike() -> None:
    assert as_command(BRING, WORLD) == "bring me the red mug"
    assert as_command(PUT, WORLD) == "put the red mug in the bin"
    assert as_command([PlanStep(action="release", target="gripper")], WORLD) == ""
    for steps in (BRING, PUT):
        assert planned(as_command(steps, WORLD)).steps == steps


def test_it_is_asked_about_and_not_done_after_a_no() -> None:
    said = "bring me the bottle, not the white one"
    asked = grammar.plan(said, WORLD, CONFIG)
    assert (asked.steps, asked.suggestion) == ([], "bring me the bottle")
    refused = grammar.plan(said, WORLD, CONFIG, [RejectedPlan(steps=[], reason="not meant")])
    assert (refused.steps, refused.suggestion) == ([], "")
