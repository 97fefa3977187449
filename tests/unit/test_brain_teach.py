"""The brain's part in names: the request to perception, the question which thing is meant, what is said of it."""

import math

import msgspec
import pytest

from common import messages as m
from common import topics
from common.geometry import wrap
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


# --- objects that have to be looked at from nearer
FIND = [m.PlanStep(action="find", object="tomato soup")]


def thing(label: str, x: float, y: float) -> m.WorldObject:
    return m.WorldObject(label=label, kind="can", colour="red", position=(x, y, 0.6), on="living table")


def looking(*things: m.WorldObject, command: str = "find the tomato soup") -> Bench:
    bench = asked(command, enable_confirmation=False)
    bench.send(topics.WORLD_OBJECTS, m.WorldObjects(t=bench.now, objects=[thing("tomato soup", -9.0, 9.0), *things]))
    bench.send(topics.POSE, m.PoseEstimate(t=bench.now, x=0.0, y=0.0, theta=0.0))
    answer_plan(bench, 1, FIND)
    return bench


def see(
    bench: Bench, count: int, label: str = "", unsure: tuple[str, ...] = (), candidates: tuple[str, ...] = ()
) -> None:
    query = bench.next_goal(topics.OBJECT_QUERY, count)
    pose = m.ObjectPose(
        query_id=query.id, found=bool(label), label=label, position=(-1.5, -2.3, 0.6), unsure=list(unsure),
        candidates=list(candidates),
    )  # fmt: skip
    bench.send(topics.OBJECT_POSE, pose)
    bench.step()


def arrive(bench: Bench, count: int, status: m.NavStatus = "arrived") -> m.NavGoal:
    goal = bench.next_goal(topics.NAV_GOAL, count)
    bench.send(topics.NAVIGATION_FEEDBACK, m.NavigationFeedback(goal_id=goal.id, status=status, code="BLOCKED"))
    bench.step()
    return goal


def test_what_cannot_be_read_from_here_is_looked_at_from_nearer_before_anything_is_searched() -> None:
    bench = looking(thing("red can", -1.5, -2.3), thing("red can 2", -1.1, -2.2))
    see(bench, 1, unsure=("red can", "red can 2"))
    goal = arrive(bench, 1)
    assert math.dist((goal.x, goal.y), (-1.5, -2.3)) < 0.9
    assert abs(wrap(math.atan2(-2.3 - goal.y, -1.5 - goal.x) - goal.theta)) < 0.1
    see(bench, 2, label="red can")
    assert ended(bench).outcome == "delivered"


def test_what_is_not_where_the_thing_was_said_to_be_is_not_looked_at_from_nearer_at_first() -> None:
    on_floor = msgspec.structs.replace(thing("red can 2", -1.1, 0.2), on="")
    bench = looking(thing("red can", -1.5, -2.3), on_floor, command="The tomato soup is on the floor. Find it.")
    see(bench, 1, unsure=("red can", "red can 2"))
    goal = arrive(bench, 1)
    assert math.dist((goal.x, goal.y), on_floor.position[:2]) < 0.9
    see(bench, 2, unsure=("red can",))
    arrive(bench, 2)
    assert "search" in bench.state.step


def test_of_several_that_match_those_in_doubt_are_seen_from_nearer_before_anybody_is_asked() -> None:
    bench = looking(thing("red can", -1.5, -2.3), thing("red box", -1.1, -2.2))
    said = bench.count(topics.SPEECH_GOAL)
    see(bench, 1, unsure=("red can", "red box"), candidates=("red can", "red box"))
    arrive(bench, 1)
    assert bench.count(topics.SPEECH_GOAL) == said
    see(bench, 2, label="red can")
    assert ended(bench).outcome == "delivered"


def test_what_cannot_be_read_from_one_side_is_looked_at_from_others_and_no_more_often_than_it_has_sides() -> None:
    bench = looking(thing("red can", -1.3, -2.2))
    angles: list[float] = []
    for count in (1, 2, 3):
        see(bench, count, unsure=("red can",))
        goal = arrive(bench, count)
        if "look closer" not in bench.state.step:
            break
        assert math.dist((goal.x, goal.y), (-1.3, -2.2)) < 1.0
        angles.append(math.atan2(goal.y + 2.2, goal.x + 1.3))
    assert len(angles) >= 2
    assert all(abs(wrap(a - b)) > 0.5 for n, a in enumerate(angles) for b in angles[:n])


def test_one_that_cannot_be_reached_is_passed_over_for_another() -> None:
    bench = looking(thing("red can", -1.5, -2.3), thing("red can 2", -1.5, 1.5))
    see(bench, 1, unsure=("red can", "red can 2"))
    arrive(bench, 1, "failed")
    second = arrive(bench, 2)
    assert math.dist((second.x, second.y), (-1.5, 1.5)) < 0.9


def test_what_is_seen_through_a_door_is_looked_at_when_nothing_else_is_left() -> None:
    bench = looking(thing("red can", 4.5, -3.1), thing("red can 2", -1.5, -2.3))
    see(bench, 1, unsure=("red can", "red can 2"))
    first = arrive(bench, 1)
    assert math.dist((first.x, first.y), (-1.5, -2.3)) < 0.9
    see(bench, 2, unsure=("red can",))
    arrive(bench, 2)
    assert "search" in bench.state.step


@pytest.mark.parametrize(("name", "y"), [("object-9", -2.21), ("object-3", -2.12)])
def test_under_another_name_or_measured_elsewhere_it_is_not_looked_at_from_the_same_side_again(
    name: str, y: float
) -> None:
    bench = looking(msgspec.structs.replace(thing("red can", -1.3, -2.2), id="object-3"))
    see(bench, 1, unsure=("red can",))
    first = arrive(bench, 1)
    again = msgspec.structs.replace(thing("brown jar", -1.3, y), id=name)
    renamed = [thing("tomato soup", -9.0, 9.0), again]
    bench.send(topics.WORLD_OBJECTS, m.WorldObjects(t=bench.now, objects=renamed))
    see(bench, 2, unsure=("brown jar",))
    second = arrive(bench, 2)
    one, two = (math.atan2(goal.y + 2.2, goal.x + 1.3) for goal in (first, second))
    assert "brown jar" in bench.state.step and abs(wrap(one - two)) > 0.5


def test_what_stands_before_the_robot_is_looked_at_from_another_side() -> None:
    bench = looking(thing("red can", 0.8, 0.0))
    shown = msgspec.structs.replace(thing("red can", 0.8, 0.0), seen_at=bench.now + 60.0)
    bench.send(topics.WORLD_OBJECTS, m.WorldObjects(t=bench.now, objects=[shown]))
    see(bench, 1, unsure=("red can",))
    goal = arrive(bench, 1)
    assert abs(wrap(math.atan2(goal.y, goal.x - 0.8) - math.pi)) > 0.5


def test_what_is_unlikely_to_be_it_is_looked_at_after_the_search_only() -> None:
    bench = looking(thing("white tool", -1.5, -2.3))
    steps: list[str] = []
    looks = 0
    while not steps or "look closer" not in steps[-1]:
        goals = bench.count(topics.NAV_GOAL)
        if looks < bench.count(topics.OBJECT_QUERY):
            looks += 1
            query = bench.next_goal(topics.OBJECT_QUERY, looks)
            pose = m.ObjectPose(query_id=query.id, found=False, unlikely=["white tool"])
            bench.send(topics.OBJECT_POSE, pose)
        elif goals > len(steps):
            steps.append(bench.state.step)
            goal = bench.last(topics.NAV_GOAL)
            bench.send(topics.NAVIGATION_FEEDBACK, m.NavigationFeedback(goal_id=goal.id, status="arrived"))
        bench.step()
    assert len(steps) > 3 and all("search" in step for step in steps[:-1])
    assert math.dist((goal.x, goal.y), (-1.5, -2.3)) < 0.9
