"""Plans against the known world, replies to questions, viewpoints: the pure parts of the VLA pipeline."""

import math

import pytest

from common.messages import PlanStep
from common.scene import load_scene
from services.brain.dialogue import corrected, reply
from services.brain.search import next_place, turned
from services.brain.validate import known_world, objection

SCENE = load_scene("apartment")
FIND, GRASP = PlanStep(action="find", object="red mug"), PlanStep(action="grasp", object="red mug")
RELEASE, RETURN = PlanStep(action="release"), PlanStep(action="return")


def check(*steps: PlanStep, held: str = "") -> str:
    return objection(steps, known_world(SCENE, [], held), SCENE)


def test_possible_plans_pass() -> None:
    assert check(FIND, GRASP, RETURN, RELEASE) == ""
    assert check(FIND, GRASP, PlanStep(action="place", target="bin")) == ""
    assert check(PlanStep(action="navigate", target="kitchen"), PlanStep(action="say", text="hello")) == ""
    assert check(RELEASE, held="apple") == ""
    assert check(PlanStep(action="find", object="red cup"), GRASP) == ""
    bowl = (PlanStep(action="find", object="yellow bowl"), PlanStep(action="grasp", object="yellow bowl"))
    assert check(*bowl) == ""


@pytest.mark.parametrize(
    ("steps", "reason"),
    [
        ((), "no steps"),
        ((GRASP,), "found before"),
        ((RELEASE,), "nothing in the hand"),
        ((PlanStep(action="place", target="bin"),), "nothing in the hand"),
        ((FIND, GRASP, PlanStep(action="place", target="moon")), "no moon"),
        ((FIND, GRASP, RELEASE, RELEASE), "step 4: there is nothing in the hand"),
        ((FIND, GRASP, FIND, GRASP), "already holds the red mug"),
        ((PlanStep(action="navigate", target="ballroom"),), "ballroom"),
        ((PlanStep(action="find", object="sofa"),), "sofa"),
        ((PlanStep(action="find", object="unicorn"),), "unicorn"),
        ((PlanStep(action="find"),), "no object is named"),
        ((PlanStep(action="say", text=" "),), "nothing to say"),
        ((PlanStep(action="wait"),) * 100, "100 steps"),
    ],
)
def test_impossible_plans_are_refused_with_the_reason(steps: tuple[PlanStep, ...], reason: str) -> None:
    assert reason in check(*steps)


@pytest.mark.parametrize(
    ("text", "kind", "rest"),
    [
        ("Yes!", "yes", ""),
        ("that's right", "yes", ""),
        ("no", "no", ""),
        ("never mind", "cancel", ""),
        ("no, the blue mug", "correction", "the blue mug"),
        ("no I said bring me the apple", "correction", "bring me the apple"),
        ("the blue mug", "correction", "the blue mug"),
    ],
)
def test_reply(text: str, kind: str, rest: str) -> None:
    assert reply(text) == (kind, rest)


def test_correction_changes_the_object_only() -> None:
    assert corrected("put the red mug in the bin", "the blue mug", SCENE) == "put the blue mug in the bin"
    assert corrected("Bring me the red cup", "blue cup", SCENE) == "bring me the blue cup"
    assert corrected("bring me the red mug", "bring me the apple", SCENE) == "bring me the apple"


def test_turning_three_times_comes_round() -> None:
    pose = (1.0, 2.0, 0.3)
    for _ in range(3):
        pose = turned(pose, 1)
        assert -math.pi <= pose[2] <= math.pi
    assert pose == pytest.approx((1.0, 2.0, 0.3))


def test_search_visits_every_place_once() -> None:
    visited: list[str] = []
    while (place := next_place((0.0, 0.0, 0.0), SCENE, visited)) is not None:
        visited.append(place.name)
    assert sorted(visited) == sorted([SCENE.home.name, *(p.name for p in SCENE.places)])
    assert visited[0] == SCENE.home.name
