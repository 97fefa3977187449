"""The planner on the memory bus with its default backend."""

import msgspec
import pytest

from common import config, topics
from common import messages as m
from common.goal_inbox import CAPACITY
from common.household import load_household
from services.planner.config import PlannerConfig
from services.planner.service import PlannerService
from tests.node import Node

SCENE = load_household("apartment")
CONFIG = config.load("planner", PlannerConfig, config.DEFAULT_DIR, {})


class Desk(Node):
    def __init__(self) -> None:
        super().__init__(PlannerService, CONFIG, SCENE)

    def ask(self, command: str, request_id: str = "m.1", **fields: object) -> m.ActionPlan:
        request = msgspec.convert(
            {"id": request_id, "command": command, "mission_id": request_id.partition(".")[0], **fields}, m.PlanRequest
        )
        self.bus.send(topics.PLAN_REQUEST, request)
        self.step()
        self.until(lambda: any(p.request_id == request_id for p in self.sent(topics.ACTION_PLAN)))
        plan = self.sent(topics.ACTION_PLAN)[-1]
        assert plan.request_id == request_id
        return plan


def targets(plan: m.ActionPlan) -> list[str]:
    return [s.object if s.action != "place" else s.target for s in plan.steps]


def mugs(*rows: tuple[str, tuple[float, float, float]]) -> m.WorldObjects:
    objects = [m.WorldObject(label=f"{c} mug", kind="mug", colour=c, position=p, on="counter") for c, p in rows]
    return m.WorldObjects(t=1.0, objects=objects)


def test_what_was_seen_and_where_the_robot_stands_decide_which_one_is_meant() -> None:
    node = Desk()
    node.bus.send(topics.WORLD_OBJECTS, mugs(("red", (4.0, -3.1, 0.8)), ("white", (4.8, -3.1, 0.8))))
    node.bus.send(topics.POSE, m.PoseEstimate(t=1.0, x=4.4, y=-2.3, theta=-1.6))
    assert targets(node.ask("bring me the mug on the left", "m.1"))[0] == "white mug"
    node.bus.send(topics.POSE, m.PoseEstimate(t=1.0, x=4.4, y=-3.9, theta=1.6))
    assert targets(node.ask("bring me the mug on the left", "m.2"))[0] == "red mug", "from the other side"
    node.bus.send(topics.WORLD_OBJECTS, mugs(("white", (4.8, -3.1, 0.8))))
    assert targets(node.ask("bring me the mug", "m.3"))[0] == "white mug"


def test_the_request_says_what_is_held() -> None:
    plan = Desk().ask("put it on the desk", world={"held": "red cup"})
    assert [(s.action, s.object, s.target) for s in plan.steps] == [("place", "red mug", "desk")]


def test_the_same_request_twice_gets_the_same_plan() -> None:
    node = Desk()
    first = node.ask("bring me the red mug")
    assert node.ask("bring me the apple") == first
    assert node.count(topics.ACTION_PLAN) == 2


def test_every_rejected_plan_of_a_mission_is_remembered() -> None:
    node, command, seen = Desk(), "take the red mug to the living room", []
    plan = node.ask(command, "m.1")
    for number in range(2, 5):
        if not plan.steps:
            break
        seen.append(plan.steps[-1].target)
        rejected = {"steps": msgspec.to_builtins(plan.steps), "reason": f"the {seen[-1]} is full", "step": 3}
        plan = node.ask(command, f"m.{number}", rejected=rejected)
    assert sorted(seen) == ["bookshelf", "living table"]
    assert plan.detail == f"the {seen[-1]} is full"
    assert node.ask(command, "n.1").steps[-1].target == seen[0], "another mission starts afresh"


def test_its_memory_is_bounded() -> None:
    node = Desk()
    rejected = {"steps": [], "reason": "no"}
    node.send(topics.WORLD_OBJECTS, mugs(("red", (4.0, -3.1, 0.8))))
    for number in range(CAPACITY + 1):
        node.ask("bring me the mug", f"m{number}.1", rejected=rejected)
    node.send(topics.WORLD_OBJECTS, mugs(("white", (4.0, -3.1, 0.8))))
    remembered = [targets(node.ask("bring me the mug", f"m{number}.1"))[0] for number in (1, CAPACITY, 0)]
    assert remembered == ["red mug", "red mug", "white mug"], "the oldest answer is forgotten"


def test_a_request_that_does_not_decode_is_counted() -> None:
    node = Desk()
    node.bus.put(topics.PLAN_REQUEST, b'{"command": "bring me the apple"}')
    node.bus.put(topics.PLAN_REQUEST, b"bring me the apple")
    node.step()
    assert node.io.drops["plan_request"] == 2 and not node.count(topics.ACTION_PLAN)


def test_what_no_wording_covers_is_compared_with_known_commands() -> None:
    node = Desk()
    plan = node.ask("my heart longs for the blue bottle")
    assert (plan.steps, plan.suggestion) == ([], "bring me the blue bottle")
    literally = {"steps": [], "reason": "not meant"}
    assert node.ask("my heart longs for the blue bottle", "m.2", rejected=literally).suggestion == ""
    assert node.ask("open the fridge", "n.1").suggestion == "", "what is understood and cannot be done is no riddle"


@pytest.mark.parametrize(
    "command", ["\x00\x01", "'" * 300, "and and and", "the the the", "é ü ß", "put", "all of", "it"]
)
def test_odd_words_are_refused(command: str) -> None:
    plan = Desk().ask(command)
    assert not plan.steps and plan.detail
