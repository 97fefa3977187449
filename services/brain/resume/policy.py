"""Resume policy: where to go on with a mission that a restart of the brain or a stop has suspended. Pure."""

import math
from collections.abc import Sequence
from typing import Literal

import msgspec

from common.messages import PlanStep
from services.brain.config import BrainConfig
from services.brain.journal.records import Checkpoint, PathNode, Pose
from services.brain.mission.mission import Failure, GripperState, Mission
from services.brain.tree.path import AS_ASKED, DO, GRAB, PLAN_STEP, PLANS

MAX_RESUMES = 10
"""Restarts without progress after which a mission is given up (chosen: a crash loop, not bad luck)."""
MOVED, TURNED = 0.3, 0.5
"""m, rad by which the base must have moved to be elsewhere (chosen: well above errors of localisation)."""
CLOCK_SLACK = 2.0
"""s by which robot time may go back before the simulation counts as new (chosen: more than a crash of it loses)."""
Change = Literal["", "lost", "holding", "moved", "new world"]


class Observation(msgspec.Struct, frozen=True):
    """What the world says: the fingers, the base, robot time, and whether a peer still has or has done our arm goal."""

    fingers: bool | None
    base: Pose | None
    t: float
    arm_answered: bool = False


class Decision(msgspec.Struct, frozen=True):
    """`path` is where to go on; `change` is what is not as the journal left it; `label` the object it is about."""

    path: list[PathNode]
    change: Change = ""
    label: str = ""


def refusal(left: Checkpoint, config: BrainConfig, now: float) -> Failure | None:
    """Why the mission is not resumed at Unix time `now` [s]; None when it is."""
    if left.outdated:
        return Failure("RESTART", "OLD_JOURNAL", "another version of the brain wrote the journal")
    same_run = bool(config.run) and config.run == left.run
    if left.closed and not same_run:
        return Failure("RESTART", "CANCELLED", "the robot was shut down")
    if now - left.date > config.resume_within:
        return Failure("RESTART", "TOO_LATE", f"interrupted for {now - left.date:.0f} s")
    if left.resumes >= MAX_RESUMES:
        return Failure("RESTART", "CRASH_LOOP", f"the brain was restarted {left.resumes} times at the same place")
    return None


def resumes_since_progress(left: Checkpoint, seen: Observation) -> int:
    """How often, with this time, the mission has been resumed since it advanced or the base got on with it."""
    return 1 if _moved(left.base, seen.base) else left.resumes + 1


def decide(left: Checkpoint, seen: Observation) -> Decision:
    """Go on at the same leaf unless the world has changed: then no further back than the change makes necessary."""
    mission, hand, path = left.mission, left.gripper, left.path
    under_way = {sent.peer for sent in left.sent}
    arm_busy = "manipulation" in under_way
    fresh = seen.t < left.t - CLOCK_SLACK
    if hand.holding and not arm_busy and seen.fingers is False:
        return Decision(_back(path, mission, "lost"), "lost", hand.holding)
    # Whoever was closing the hand finds it full and folds the arm; only then may the base move.
    closing = bool(path) and path[-1].node == GRAB
    if seen.fingers and not (hand.holding or hand.grasp_uncertain or arm_busy or mission.delivery.released or closing):
        label, behind = _about_to_grasp(path, mission)
        if label:
            return Decision(behind, "holding", label)
    if fresh and not hand.holding and not mission.delivery.released:
        return Decision(_back(path, mission, "new world"), "new world")
    if "navigation" not in under_way and not seen.arm_answered and _moved(left.base, seen.base):
        return Decision(_back(path, mission, "moved"), "moved")
    return Decision(path)


def apply(decision: Decision, mission: Mission, hand: GripperState) -> None:
    """Correct what is believed by what was seen."""
    if decision.change == "lost":
        hand.holding, mission.delivery.grabbed = "", False
        mission.search.found = {k: p for k, p in mission.search.found.items() if decision.label not in (k, p.label)}
    elif decision.change == "holding":
        hand.mark_grasped(decision.label)
        mission.delivery.grabbed = True
    elif decision.change == "new world":
        mission.search.found, mission.search.visited, hand.put_down = {}, [], {}
        mission.delivery.rests = {}
        mission.search.unreached = []
    if decision.change:
        mission.at = ""


def _moved(before: Pose | None, now: Pose | None) -> bool:
    if before is None or now is None:
        return False
    turned = math.remainder(now[2] - before[2], math.tau)
    return math.hypot(now[0] - before[0], now[1] - before[1]) > MOVED or abs(turned) > TURNED


# --- where to go on
def _at(path: Sequence[PathNode], node: str) -> int:
    return next((i for i, step in enumerate(path) if step.node == node), -1)


def _plan(path: Sequence[PathNode]) -> int | None:
    """Where in the path a plan is carried out: the place after it is the plan's step."""
    return next((i for i, step in enumerate(path[:-1]) if step.node in PLANS), None)


def _back(path: list[PathNode], mission: Mission, change: Change) -> list[PathNode]:
    """The place from which the rest of the mission can be done again: in a plan the step that needs it."""
    plan = _plan(path)
    if plan is not None:
        return [
            *path[: plan + 1],
            PathNode(PLAN_STEP, step_to_repeat(mission.planning.steps, path[plan + 1].ordinal, change)),
        ]
    return path[: _at(path, DO) + 1] if _at(path, AS_ASKED) >= 0 else path


def step_to_repeat(plan: Sequence[PlanStep], k: int, change: Change) -> int:
    """Index of the step, not after `k`, from which the plan has to be done again."""
    if change == "moved" and plan[k].action == "release":
        return next((j for j in range(k, -1, -1) if plan[j].action in ("return", "navigate")), k)
    if change == "moved":
        return k
    grasps = [j for j, step in enumerate(plan) if step.action == "grasp" and not step.hand_alone]
    grasp = max((j for j in grasps if j <= k), default=None) if change == "lost" else k
    if grasp is None:
        return k
    item = plan[grasp].object
    finds = [j for j in range(grasp + 1) if plan[j].action == "find" and plan[j].object == item]
    return max(finds, default=grasp)


def _about_to_grasp(path: list[PathNode], mission: Mission) -> tuple[str, list[PathNode]]:
    """The object that the mission was about to take, and the place behind the taking; "" if there is none."""
    plan = _plan(path)
    if plan is not None:
        for j in range(path[plan + 1].ordinal, len(mission.planning.steps) - 1):
            step = mission.planning.steps[j]
            if step.hand_alone:
                continue
            if step.action == "grasp":
                pose = mission.search.found.get(step.object)
                return (pose.label if pose else "") or step.object, [*path[: plan + 1], PathNode(PLAN_STEP, j + 1)]
            if step.action in ("place", "release"):
                break
        return "", path
    if _at(path, AS_ASKED) >= 0 and mission.task.kind == "fetch":
        return mission.task.label, _back(path, mission, "holding")
    return "", path
