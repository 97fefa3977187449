"""The arm on its way along the legs of a path."""

from collections.abc import Generator
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from services.manipulation.arm.touch import BLOCKED, HIT, MET
from services.manipulation.arm.trajectory import Leg
from services.manipulation.config import ManipulationConfig
from services.manipulation.execution import pull_executor
from services.manipulation.execution.place_executor import _execute_place, untried_first
from services.manipulation.execution.robot import CALM, Failure, Robot

HAND = SimpleNamespace(share=lambda width: 0.4)


def test_the_arm_is_at_rest_before_it_begins_to_feel_for_what_is_near() -> None:
    """What brakes it at the end of a fast leg shows as a load, and then as something that was met."""
    done: list[tuple[str, float]] = []

    def follow(path: Any, speed: float, most: float = HIT) -> Generator[None, None, None]:
        done.append(("follow", most))
        yield

    def wait(seconds: float) -> Generator[None, None, None]:
        if seconds:
            done.append(("wait", seconds))
        yield

    robot = cast(Robot, SimpleNamespace(config=ManipulationConfig(), follow=follow, wait=wait))
    path = [np.zeros(7), np.ones(7)]
    assert not any(Robot.travel(robot, [Leg(path, near=True), Leg(path, near=False), Leg(path, near=True)]))
    assert done == [("follow", MET), ("follow", HIT), ("wait", CALM), ("follow", MET)]


def test_where_something_was_met_on_the_way_to_a_spot_another_one_comes_first() -> None:
    def travel(way: Any, share: float) -> Generator[None, None, None]:
        raise Failure(BLOCKED, "30 N on the hand")
        yield

    robot = cast(Robot, SimpleNamespace(base=(1.0, 0.0, np.pi / 2), met_before=[], travel=travel))
    spots = [(0.5, 0.0), (0.55, 0.05), (0.5, 0.3)]
    assert untried_first(robot, spots) == spots
    with pytest.raises(Failure):
        next(_execute_place(robot, cast(Any, SimpleNamespace(spot=spots[0], reach=[])), cast(Any, None), "desk", 0.7))
    assert untried_first(robot, spots) == [spots[2], *spots[:2]], "one beside it is reached by the same way"
    robot.base = (1.0, 0.25, np.pi / 2)
    assert untried_first(robot, [(0.25, 0.0), (0.5, 0.0)]) == [(0.5, 0.0), (0.25, 0.0)], "it stays on the map"


def test_what_was_pulled_is_grasped_though_the_hand_met_something_on_its_way_home(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    done: list[str] = []

    def nothing(*_: Any) -> Generator[None, None, None]:
        yield

    def travel(way: str) -> Generator[None, None, None]:
        yield
        if way == "home":
            raise Failure(BLOCKED, "25 N on the hand")

    def go_home(robot: Robot) -> Generator[None, None, None]:
        done.append("home")
        yield

    monkeypatch.setattr(pull_executor, "go_home", go_home)
    monkeypatch.setattr(pull_executor, "planner_of", lambda robot: SimpleNamespace(arm=SimpleNamespace(hand=HAND)))
    monkeypatch.setattr(pull_executor, "_remember", lambda robot, plan, found: "moved")
    robot = SimpleNamespace(
        config=ManipulationConfig(), move_gripper=nothing, travel=travel, follow=nothing, at_rest=nothing,
        guard=lambda *_: None, phase="reach", forget_command=lambda: None,
        io=SimpleNamespace(log=SimpleNamespace(warning=lambda *_, **__: None)),
    )  # fmt: skip
    pull = SimpleNamespace(opening=0.05, reach="reach", lower=[], pull=[], leave=[], home="home")
    steps = pull_executor._execute(cast(Any, robot), cast(Any, pull), cast(Any, None))
    with pytest.raises(StopIteration) as ended:
        while True:
            next(steps)
    assert (ended.value.value, done) == ("moved", ["home"])
