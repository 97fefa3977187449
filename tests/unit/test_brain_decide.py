"""Where a mission goes on after a restart of the brain: the decision alone, case by case."""

import math
from typing import Any

import pytest

from common.messages import ObjectPose, PlanStep
from services.brain.config import BrainConfig
from services.brain.journal.records import Checkpoint, PathNode, Pose
from services.brain.mission.channel import SentGoal
from services.brain.mission.mission import Delivery, Failure, GripperState, Mission, Planning, Task
from services.brain.mission.search import Search
from services.brain.resume.policy import (
    CLOCK_SLACK,
    MAX_RESUMES,
    MOVED,
    TURNED,
    Change,
    Decision,
    Observation,
    apply,
    decide,
    refusal,
    resumes_since_progress,
    step_to_repeat,
)  # fmt: skip

MUG, CAN = "red mug", "green can"
HOME: Pose = (1.0, 2.0, 0.5)
PLAN = [
    PlanStep(action="find", object=MUG), PlanStep(action="grasp", object=MUG),
    PlanStep(action="navigate", target="desk"), PlanStep(action="place", target="desk"),
    PlanStep(action="find", object=CAN), PlanStep(action="grasp", object=CAN),
    PlanStep(action="return"), PlanStep(action="release"),
]  # fmt: skip


def in_plan(k: int, *below: str, inside: str = "execute") -> list[PathNode]:
    """The path of a plan's step `k` and the leaf at work in it."""
    return [
        PathNode("root"),
        PathNode("mission", 0, 1),
        PathNode(inside),
        PathNode("step", k),
        *(PathNode(n, 1) for n in below),
    ]


def in_fetch(*below: str) -> list[PathNode]:
    return [PathNode("root"), PathNode("as_asked"), PathNode("do"), *(PathNode(name, 1, 2) for name in below)]


def mission_of(steps: list[PlanStep] | None = None, **parts: Any) -> Mission:
    return Mission(id="m", planning=Planning(PLAN if steps is None else steps), **parts)


def left(path: list[PathNode], plan: bool = True, **more: object) -> Checkpoint:
    fields = {"t": 50.0, "base": HOME, "gripper": GripperState(), **more}
    mission = fields.pop("mission", mission_of(PLAN if plan else [], task=Task("fetch", label="the mug")))
    return Checkpoint(mission=mission, path=path, **fields)  # type: ignore[arg-type]


def seen(
    fingers: bool | None = None, base: Pose | None = HOME, t: float = 51.0, arm_answered: bool = False
) -> Observation:
    return Observation(fingers, base, t, arm_answered)


def sent(peer: str) -> SentGoal:
    return SentGoal(peer, "k", {"id": "m.1"})


# --- whether at all
def test_a_mission_is_taken_up_unless_there_is_a_reason_against_it() -> None:
    config = BrainConfig(run="a", resume_within=60.0)
    crashed = left([], date=1000.0, run="b")
    assert refusal(crashed, config, 1060.0) is None
    assert refusal(crashed, config, 1061.0) == Failure("RESTART", "TOO_LATE", "interrupted for 61 s")
    closed = left([], date=1000.0, run="b", closed=True)
    assert refusal(closed, config, 1000.0) == Failure("RESTART", "CANCELLED", "the robot was shut down")
    closed.run = "a"
    assert refusal(closed, config, 1000.0) is None, "the same run goes on: one process of it was restarted"
    closed.run = ""
    unnamed = BrainConfig(run="", resume_within=60.0)
    assert refusal(closed, unnamed, 1000.0) == Failure("RESTART", "CANCELLED", "the robot was shut down")
    tired = left([], date=1000.0, resumes=MAX_RESUMES - 1)
    assert refusal(tired, config, 1000.0) is None
    tired.resumes = MAX_RESUMES
    why = "the brain was restarted 10 times at the same place"
    assert refusal(tired, config, 1000.0) == Failure("RESTART", "CRASH_LOOP", why)


def test_a_mission_whose_base_gets_on_is_in_no_crash_loop() -> None:
    driving = left(in_plan(0), resumes=9)
    assert resumes_since_progress(driving, seen(base=(2.0, 2.0, 0.5))) == 1
    assert [resumes_since_progress(driving, seen(base=base)) for base in (HOME, None)] == [10, 10]


# --- where
def test_nothing_changed_goes_on_at_the_same_leaf() -> None:
    for path in (in_plan(4, "drive"), in_fetch("go"), []):
        assert decide(left(path), seen()) == Decision(path, "", "")


def test_what_was_held_and_is_not_is_found_and_grasped_again() -> None:
    hand = GripperState(holding=MUG)
    assert decide(left(in_plan(2), gripper=hand), seen(False)) == Decision(
        [*in_plan(2)[:3], PathNode("step", 0)], "lost", MUG
    )
    assert decide(left(in_fetch("return"), gripper=hand), seen(False)) == Decision(in_fetch(), "lost", MUG)
    nowhere = [PathNode("root"), PathNode("say")]
    assert decide(left(nowhere, gripper=hand), seen(False)) == Decision(nowhere, "lost", MUG)
    for fingers in (True, None):
        assert decide(left(in_plan(2), gripper=hand), seen(fingers)).change == ""
    busy = left(in_plan(3), gripper=hand, sent=[sent("manipulation")])
    assert decide(busy, seen(False)).change == "", "the arm is asked first"
    assert decide(left(in_plan(3), gripper=hand, sent=[sent("navigation")]), seen(False)).change == "lost"


def test_a_full_hand_before_a_grasp_is_that_grasp_done() -> None:
    assert decide(left(in_plan(0, "drive")), seen(True)) == Decision(
        [*in_plan(0)[:3], PathNode("step", 2)], "holding", MUG
    )
    assert decide(left(in_plan(4)), seen(True)) == Decision([*in_plan(4)[:3], PathNode("step", 6)], "holding", CAN)
    assert decide(left(in_plan(0, inside="go_and_look")), seen(True)).change == "holding"
    grounded = mission_of(search=Search({MUG: ObjectPose(query_id="q", found=True, label="mug 2")}))
    assert decide(left(in_plan(0), mission=grounded), seen(True)).label == "mug 2"
    nameless = mission_of(search=Search({MUG: ObjectPose(query_id="q", found=True)}))
    assert decide(left(in_plan(0), mission=nameless), seen(True)).label == MUG
    assert decide(left(in_fetch("go"), plan=False), seen(True)) == Decision(in_fetch(), "holding", "the mug")


@pytest.mark.parametrize(
    "checkpoint",
    [
        left(in_plan(2)), left(in_plan(3)), left(in_plan(6)), left(in_plan(7)),
        left(in_plan(0, "grab")), left(in_fetch("approach_and_grab", "grab")),
        left(in_plan(0), gripper=GripperState(grasp_uncertain=MUG)),
        left(in_plan(0), gripper=GripperState(holding=MUG)), left(in_plan(0), sent=[sent("manipulation")]),
        left(in_plan(0), mission=mission_of(delivery=Delivery(released=True))),
        left(in_fetch("go"), mission=mission_of([], task=Task("return", label=MUG))),
        left([PathNode("root"), PathNode("listen")], plan=False), left([], plan=False),
    ],
)  # fmt: skip
def test_a_full_hand_at_any_other_time_changes_nothing(checkpoint: Checkpoint) -> None:
    assert decide(checkpoint, seen(True)) == Decision(checkpoint.path, "", "")


def test_a_grasp_as_the_last_step_is_not_skipped() -> None:
    mission = mission_of(PLAN[:2])
    assert decide(left(in_plan(0), mission=mission), seen(True)).change == ""


def test_a_world_begun_anew_is_looked_at_anew() -> None:
    early = 50.0 - CLOCK_SLACK
    assert decide(left(in_plan(5, "go")), seen(t=early - 0.1)) == Decision(
        [*in_plan(5)[:3], PathNode("step", 4)], "new world"
    )
    assert decide(left(in_plan(5, "go")), seen(t=early)).change == "", "clocks differ a little"
    assert decide(left(in_fetch("go")), seen(t=0.0)) == Decision(in_fetch(), "new world")
    assert decide(left(in_plan(5), gripper=GripperState(holding=CAN)), seen(t=0.0)).change == ""
    done = mission_of(delivery=Delivery(released=True))
    assert decide(left(in_plan(5), mission=done), seen(t=0.0)).change == ""


@pytest.mark.parametrize(
    ("base", "moved"),
    [
        (HOME, False), ((1.0 + MOVED - 0.01, 2.0, 0.5), False), ((1.0 + MOVED + 0.01, 2.0, 0.5), True),
        ((1.0, 2.0 - MOVED - 0.01, 0.5), True), ((1.0 + 0.22, 2.0 + 0.22, 0.5), True),
        ((1.0, 2.0, 0.5 + TURNED - 0.01), False), ((1.0, 2.0, 0.5 + TURNED + 0.01), True),
        ((1.0, 2.0, 0.5 - TURNED - 0.01), True), ((1.0, 2.0, 0.5 + math.tau), False), (None, False),
    ],
)  # fmt: skip
def test_a_base_that_was_moved_drives_there_again(base: Pose | None, moved: bool) -> None:
    expected = Decision([*in_plan(1)[:3], PathNode("step", 1)], "moved") if moved else Decision(in_plan(1, "reach"))
    assert decide(left(in_plan(1, "reach")), seen(base=base)) == expected


def test_a_move_counts_only_when_nobody_answers_for_it() -> None:
    there: Pose = (5.0, 5.0, 0.0)
    assert decide(left(in_plan(1), sent=[sent("navigation")]), seen(base=there)).change == ""
    assert decide(left(in_plan(1), sent=[sent("manipulation")]), seen(base=there)).change == "moved"
    assert decide(left(in_plan(1)), seen(base=there, arm_answered=True)).change == ""
    assert decide(left(in_plan(1), base=None), seen(base=there)).change == ""


@pytest.mark.parametrize(
    ("k", "change", "step"),
    [
        (7, "moved", 6), (3, "moved", 3), (5, "moved", 5),
        (2, "lost", 0), (1, "lost", 0), (7, "lost", 4), (6, "lost", 4), (5, "lost", 4), (0, "lost", 0), (4, "lost", 0),
        (1, "new world", 0), (5, "new world", 4), (4, "new world", 4), (2, "new world", 2), (0, "new world", 0),
    ],
)  # fmt: skip
def test_the_step_that_has_to_be_done_again(k: int, change: Change, step: int) -> None:
    assert step_to_repeat(PLAN, k, change) == step


def test_the_step_to_do_again_without_a_find_or_a_drive() -> None:
    grasp, release = PlanStep(action="grasp", object=MUG), PlanStep(action="release")
    assert step_to_repeat([grasp, release], 1, "lost") == 0
    assert step_to_repeat([grasp, release], 1, "moved") == 1
    assert step_to_repeat([release], 0, "lost") == 0
    assert step_to_repeat([release, release], 1, "lost") == 1
    again = [PlanStep(action="find", object=MUG), PlanStep(action="find", object=CAN), PLAN[0], grasp, PLAN[0]]
    assert step_to_repeat(again, 3, "lost") == 2, "the nearest find before the grasp"
    drives = [PLAN[2], PLAN[6], PLAN[2], release]
    assert step_to_repeat(drives, 3, "moved") == 2, "the nearest drive"
    assert step_to_repeat([release, PLAN[6]], 0, "moved") == 0


# --- what is believed from then on
def believing() -> tuple[Mission, GripperState]:
    poses = {
        MUG: ObjectPose(query_id="a", found=True, label="mug 2"),
        CAN: ObjectPose(query_id="b", found=True, label=CAN),
    }
    mission = mission_of([], delivery=Delivery(grabbed=True), search=Search(poses, [HOME]), at="desk")
    return mission, GripperState(holding=MUG, put_down={CAN: 3.0})


def test_what_was_lost_is_nowhere_known() -> None:
    for label in (MUG, "mug 2"):
        mission, hand = believing()
        apply(Decision([], "lost", label), mission, hand)
        assert (hand.holding, mission.delivery.grabbed, mission.at) == ("", False, "")
        assert list(mission.search.found) == [CAN] and mission.search.visited == [HOME] and hand.put_down == {CAN: 3.0}


def test_what_is_held_was_grabbed() -> None:
    mission, hand = Mission(id="m", at="desk"), GripperState(grasp_uncertain=CAN)
    apply(Decision([], "holding", MUG), mission, hand)
    assert (hand.holding, hand.grasp_uncertain, mission.delivery.grabbed, mission.at) == (MUG, "", True, "")


def test_of_a_new_world_nothing_is_known() -> None:
    mission, hand = believing()
    apply(Decision([], "new world"), mission, hand)
    assert (mission.search.found, mission.search.visited, hand.put_down, mission.at) == ({}, [], {}, "")
    assert (hand.holding, mission.delivery.grabbed) == (MUG, True)


def test_a_moved_base_is_nowhere_and_no_change_is_none() -> None:
    mission, hand = believing()
    apply(Decision([], ""), mission, hand)
    assert (mission, hand) == believing()
    apply(Decision([], "moved"), mission, hand)
    assert mission.at == "" and hand == believing()[1] and len(mission.search.found) == 2
