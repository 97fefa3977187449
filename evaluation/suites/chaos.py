"""The chaos suite: every service killed and hung in every state, its messages mistreated, the host out of order."""

from collections.abc import Sequence

import msgspec

from evaluation.case import Case, TimedFault
from evaluation.faults.messages import Kind, Rule
from evaluation.suites.blocks import VLA, fetch_case, flat, pick, random

CHAOS_STATES = ("CONFIRMING", "PLANNING", "GROUNDING", "NAVIGATING", "GRABBING", "RETURNING", "RELEASING")
CHAOS_SERVICES = ("speech", "planner", "perception", "camera", "navigation", "manipulation", "brain", "sim")
EVERY = "every one"
MISTREATED: tuple[Kind, ...] = ("drop", "duplicate", "delay", "reorder")
PARAMETERS: dict[str, dict[str, float]] = {
    "hang": {"seconds": 3.0}, "router loss": {"seconds": 5.0}, "disk full": {"full": 30.0},
    "disk full, kill": {"full": 30.0}, "clock jump": {"jump": 2.0},
}  # fmt: skip
CHATTY = frozenset({
    "speech/status", "world/objects", "camera/head/rgbd", "camera/wrist/rgbd", "brain/manipulation_status",
    "navigation_feedback", "joint_states", "scan", "base/odom",
})  # fmt: skip
"""Keys with more than two messages in a state, of which not only the first are worth hitting."""
MOMENTS = {"CONFIRMING": 3.0, "PLANNING": 0.2, "GROUNDING": 0.4, "NAVIGATING": 4.0, "GRABBING": 10.0,
           "RETURNING": 6.0, "RELEASING": 6.0}  # fmt: skip
"""How long into a state [s] a fault can come: about as long as the state usually lasts."""
TRAFFIC: dict[tuple[str, str], tuple[str, ...]] = {
    ("speech", "CONFIRMING"): ("brain/speech_result", "speech/status"),
    ("planner", "PLANNING"): ("action_plan",),
    ("perception", "GROUNDING"): ("object_pose",),
    ("camera", "GROUNDING"): ("camera/head/rgbd",),
    ("navigation", "NAVIGATING"): ("base/target_pose", "navigation_feedback"),
    ("navigation", "RETURNING"): ("brain/navigation_status", "base/target_pose", "navigation_feedback"),
    ("manipulation", "GRABBING"): ("brain/manipulation_status", "gripper_command"),
    ("manipulation", "RELEASING"): ("brain/manipulation_status", "gripper_command"),
    ("brain", "CONFIRMING"): ("brain/speech_goal",),
    ("brain", "PLANNING"): ("plan_request",),
    ("brain", "GROUNDING"): ("object_query",),
    ("brain", "NAVIGATING"): ("nav_goal",),
    ("brain", "GRABBING"): ("brain/manipulation_goal",),
    ("brain", "RETURNING"): ("brain/navigation_goal",),
    ("brain", "RELEASING"): ("brain/manipulation_goal",),
    ("sim", "NAVIGATING"): ("base/odom", "scan", "base/goal_reached"),
    ("sim", "GRABBING"): ("joint_states",),
    ("sim", "RETURNING"): ("base/odom", "scan", "base/goal_reached"),
    ("sim", "RELEASING"): ("joint_states",),
}
"""What a service says in a state: only that can be dropped, doubled, late or out of order there."""


class Cell(msgspec.Struct, frozen=True):
    """One square of the matrix."""

    service: str
    state: str
    fault: str


def _cells() -> tuple[Cell, ...]:
    def all_of(fault: str, services: Sequence[str]) -> list[Cell]:
        return [Cell(service, state, fault) for state in CHAOS_STATES for service in services]

    found = all_of("kill", CHAOS_SERVICES)
    # A simulation that hangs stops the time that all others follow: nothing happens.
    found += all_of("hang", [s for s in CHAOS_SERVICES if s != "sim"])
    found += all_of("router loss", ["router"]) + all_of("disk full", ["host"])
    found += all_of("disk full, kill", ["brain"]) + all_of("clock jump", ["host"])
    found += [Cell(service, state, kind) for service, state in TRAFFIC for kind in MISTREATED]
    found += [Cell(service, EVERY, "kill") for service in CHAOS_SERVICES]
    found += [Cell("router", EVERY, "router loss"), Cell("host", EVERY, "clock jump")]
    return tuple(found)


CELLS = _cells()


def chaos(seed: int) -> Case:
    """Cell after cell: the first 56 seeds kill each service in each state, the next 49 hang it; then the rest.

    The last ten take effect in every state of one mission.
    """
    cell = CELLS[seed % len(CELLS)]
    scene, rng = flat(), random(seed, 6)
    # What lies near makes a short mission: it is the fault that counts here, not the search.
    near = scene.room_at(scene.home.x, scene.home.y)
    case = fetch_case("chaos", seed, pick(rng, scene, seed, room=near.name if near else ""), scene)
    case.name, case.fault, case.honest, case.settings = f"{cell.service} {cell.state}", cell.fault, True, (VLA,)
    case.spoken = cell.service == "speech" or cell.state == "CONFIRMING"
    match cell.fault:
        case "kill" | "hang" | "router loss" | "disk full" | "disk full, kill" | "clock jump":
            states = CHAOS_STATES if cell.state == EVERY else (cell.state,)
            moments = [round(float(rng.uniform(0.0, MOMENTS[state])), 2) for state in states]
            case.timed_faults = tuple(
                TimedFault(cell.service, state, after=moment, **PARAMETERS.get(cell.fault, {}))
                for state, moment in zip(states, moments, strict=True)
            )
        case kind:
            keys = TRAFFIC[cell.service, cell.state]
            key = keys[int(rng.integers(len(keys)))]
            skip, seconds = int(rng.integers(3)) if key in CHATTY else 0, float(rng.uniform(0.5, 3.0))
            case.rules = (
                Rule(
                    service=cell.service, key=key, kind=msgspec.convert(kind, Kind), skip=skip, count=2,
                    seconds=seconds, state=cell.state,
                ),
            )  # fmt: skip
    return case
