"""The arm on its way along the legs of a path."""

from collections.abc import Generator
from types import SimpleNamespace
from typing import Any, cast

import numpy as np

from services.manipulation.arm.touch import HIT, MET
from services.manipulation.arm.trajectory import Leg
from services.manipulation.config import ManipulationConfig
from services.manipulation.execution.robot import CALM, Robot


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
