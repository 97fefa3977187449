"""The choice of a robot for a command, and the way that it has to go."""

import math
import zlib
from typing import Any

import numpy as np
import pytest

from cli.fleet.choice import EMPTY, LOW, goals, rank, refusal, things
from cli.fleet.dispatch import Dispatch, path_length
from cli.fleet.robots import RobotNow, robot
from common import messages as m

MUG = {"red mug": (3.0, 0.0)}


def free(name: str, **how: Any) -> RobotNow:
    return RobotNow(**{"name": name, "state": "WAITING", "pose": (0.0, 0.0, 0.0), "knows": MUG} | how)


def order(*robots: RobotNow, metres: dict[str, float | None], text: str = "bring me the red mug") -> list[str]:
    return [c.name for c in rank(robots, goals(text, robots), metres) if c.able]


def test_of_two_alike_the_nearer_one_goes() -> None:
    assert order(free("a"), free("b"), metres={"a": 5.0, "b": 2.0}) == ["b", "a"]


def test_one_that_knows_the_thing_goes_before_a_nearer_one_that_has_to_look() -> None:
    assert order(free("a", knows={}), free("b"), metres={"a": 2.0, "b": 9.0}) == ["b", "a"]
    assert order(free("a", knows={}), free("b"), metres={"a": 2.0, "b": 90.0}) == ["a", "b"], "but not across the town"


def test_a_full_hand_and_a_low_battery_are_spared() -> None:
    assert order(free("a", holding="apple"), free("b"), metres={"a": 2.0, "b": 4.0}) == ["b", "a"]
    assert order(free("a", battery=LOW / 2), free("b", battery=1.0), metres={"a": 2.0, "b": 9.0}) == ["b", "a"]


@pytest.mark.parametrize(
    "how", [{"state": ""}, {"state": "NAVIGATING"}, {"state": "IDLE"}, {"braked": True}, {"battery": EMPTY / 2}]
)
def test_one_that_cannot_is_never_chosen(how: dict[str, Any]) -> None:
    assert order(free("a", **how), free("b"), metres={"a": 0.0, "b": 50.0}) == ["b"]
    assert refusal(free("a", **how))


def test_one_that_lacks_something_says_what_and_is_not_called_busy() -> None:
    assert refusal(free("a", state="IDLE", detail="waiting for speech")) == "is not ready: waiting for speech"


def test_no_way_is_no_choice_and_the_reasons_are_told() -> None:
    robots = [free("a"), free("b", battery=0.5), free("c", state="NAVIGATING", command="bring me the apple")]
    found = rank(robots, goals("bring me the red mug", robots), {"a": None, "b": 2.5})
    assert [c.name for c in found if c.able] == ["b"]
    why = {c.name: c.why for c in found}
    assert why["a"] == "no way leads there" and why["c"] == "is busy: bring me the apple"
    assert why["b"] == "2.5 m away, knows the red mug, battery 50 %"


def test_the_order_does_not_depend_on_who_answers_first() -> None:
    robots = [free("a"), free("b"), free("c")]
    same = {"a": 2.0, "b": 2.0, "c": 2.0}
    assert order(*robots, metres=same) == order(*reversed(robots), metres=same) == ["a", "b", "c"]


def test_what_a_command_is_about() -> None:
    known = ["red mug", "blue mug", "apple", "mug"]
    assert things("Bring me the red mug, please!", known) == ["red mug"]
    assert things("put the apple next to the blue mug", known) == ["blue mug", "apple"]
    assert things("bring me the cup", known) == [] and things("go to the kitchen", known) == []
    assert things("bring me a mug", ["red mug", "blue mug"]) == ["blue mug", "red mug"], "whichever of them"


def test_a_robot_is_what_it_told() -> None:
    brain = m.BrainState(state="NAVIGATING", mission_id="m1", command="bring me the apple", command_id="fleet-1")
    held = m.WorldObject(label="apple", kind="apple", colour="red", position=(0.0, 0.0, 1.0), held=True)
    mug = m.WorldObject(label="red mug", kind="mug", colour="red", position=(1.0, 2.0, 0.5), names=["daddy"])
    now = robot("a", brain, sim=m.SimStatus(state="stopped"), world=m.WorldObjects(t=0.0, objects=[held, mug]))
    assert now.command_id == "fleet-1" and now.holding == "apple" and now.braked and not now.free
    assert now.knows == {"red mug": (1.0, 2.0), "daddy": (1.0, 2.0)}
    assert robot("b").state == "" and not robot("b").free
    asking = robot("c", m.BrainState(state="CONFIRMING", mission_id="m2", command="x", step="Did you say x?"))
    assert asking.question == "Did you say x?"


class Desk:
    """Of one robot that has just ended a mission, tells of it once more, and then begins what it was offered."""

    def __init__(self) -> None:
        self.told, self.sent = 0, []  # type: ignore[var-annotated]

    def names(self) -> set[str]:
        return {"anna"}

    def look(self, among: set[str]) -> list[RobotNow]:
        return [free(name, state="COMPLETED", knows={}) for name in among]

    def send(self, name: str, topic: Any, command: m.VoiceCommand) -> None:
        self.sent.append(command)

    def state(self, name: str) -> m.BrainState:
        self.told += 1
        if self.told > 2:
            return m.BrainState(state="PLANNING", mission_id="2", command_id=self.sent[0].id)
        ended = m.MissionOutcome(id="1", command="", outcome="delivered", command_id="old")
        return m.BrainState(state="COMPLETED", mission_id="1", command_id="old", last=ended)


def test_who_reports_on_its_last_mission_has_not_begun_another() -> None:
    desk = Desk()
    given = Dispatch(desk, "bring me the red mug")  # type: ignore[arg-type]
    assert given.offer() and given.by == "anna"
    assert [c.withdraws for c in desk.sent] == [""]


def flat(wall: slice | None = None) -> m.Costmap:
    """6 x 4 m in cells of 0.1 m, clearance without end but for a wall across the middle."""
    cells = np.full((40, 60), 255, np.uint8)
    if wall is not None:
        cells[wall, 30] = 0
    return m.Costmap(
        t=0.0, x=0.0, y=0.0, resolution=0.1, width=60, height=40, far=2.0, cells=zlib.compress(cells.tobytes())
    )


def test_the_way_is_that_around_walls_up_to_the_arm_s_reach() -> None:
    start, end = (1.05, 0.55), (5.05, 0.55)
    straight, around = path_length(flat(), start, end), path_length(flat(slice(0, 30)), start, end)
    assert straight == pytest.approx(4.0 - 0.9, abs=0.11)
    assert around is not None and straight is not None
    assert around > 2 * math.hypot(1.95, 2.5) - 0.9 - 0.11 > straight
    assert path_length(flat(slice(None)), start, end) is None, "a wall without a door"


def test_a_robot_off_the_map_or_a_thing_out_of_reach_has_no_way() -> None:
    assert path_length(flat(), (-3.0, 1.0), (5.0, 1.0)) is None
    assert path_length(flat(), (1.0, 1.0), (9.0, 1.0)) is None
    torn = m.Costmap(t=0.0, x=0.0, y=0.0, resolution=0.1, width=60, height=40, far=2.0, cells=b"no map")
    with pytest.raises(ValueError, match="cells: "):
        path_length(torn, (1.0, 1.0), (2.0, 1.0))
