"""The suite of harm: services killed and hung in every state, messages mistreated on their keys, clocks that jump."""

from typing import Literal

from evaluation.blocks import VLA, fetch_case, flat, pick, random
from evaluation.case import Case, Strike
from evaluation.faults import Kind, Rule

CHAOS_STATES = ("CONFIRMING", "PLANNING", "GROUNDING", "NAVIGATING", "GRABBING", "RETURNING", "RELEASING")
HARM: tuple[Kind | Literal["kill", "hang", "jump"], ...] = (
    "kill", "hang", "drop", "duplicate", "delay", "reorder", "jump",
)  # fmt: skip
CHAOS_SERVICES = ("speech", "planner", "perception", "camera", "navigation", "manipulation", "brain")
KEYS = {
    "speech": ("voice_command", "brain/speech_result", "speech/status"),
    "planner": ("action_plan",),
    "perception": ("object_pose", "world/objects"),
    "camera": ("camera/head/rgbd", "camera/wrist/rgbd"),
    "navigation": ("brain/navigation_status", "base/target_pose", "navigation_feedback"),
    "manipulation": ("brain/manipulation_status", "gripper_command"),
    "brain": ("brain/navigation_goal", "brain/manipulation_goal", "plan_request", "object_query"),
}


def chaos(seed: int) -> Case:
    """Service, state and harm in turn: the first 49 seeds kill each service in each state, the next 49 hang it."""
    scene, rng = flat(), random(seed, 6)
    case = fetch_case("chaos", seed, pick(rng, scene, seed), scene)
    service = CHAOS_SERVICES[seed % len(CHAOS_SERVICES)]
    state = CHAOS_STATES[seed // len(CHAOS_SERVICES) % len(CHAOS_STATES)]
    how = HARM[seed // (len(CHAOS_SERVICES) * len(CHAOS_STATES)) % len(HARM)]
    case.name, case.fault, case.honest, case.settings = f"{service} {state}", how, True, (VLA,)
    case.spoken = True
    if how == "kill" or how == "hang" or how == "jump":
        hang, jump = (3.0 if how == "hang" else 0.0), (2.0 if how == "jump" else 0.0)
        case.strikes = (Strike(service, state, hang, jump),)
    else:
        keys = KEYS[service]
        case.rules = (
            Rule(
                service=service, key=keys[int(rng.integers(len(keys)))], kind=how, skip=int(rng.integers(3)),
                count=2, seconds=float(rng.uniform(0.5, 3.0)),
            ),
        )  # fmt: skip
    return case
