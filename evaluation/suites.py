"""The suites: a seed in, a scenario out. Case i of a run has the seed `seed + i` and can be repeated alone."""

import tomllib
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Literal

import msgspec
import numpy as np

from common.config import config_dir, load
from common.scene import ObjectSpec, Receptacle, Scene, load_scene
from evaluation.case import Case, Line, Strike
from evaluation.evidence import Want
from evaluation.faults import Kind, Rule
from services.brain.config import BrainConfig
from services.sim.layout import place_objects

VLA = "brain.pipeline=vla"
WORDINGS = (
    "bring me the {}", "fetch me the {}", "get me the {}", "give me the {}", "hand me the {}", "bring the {} to me",
    "please bring me the {}", "get me the {} please",
)  # fmt: skip
SHELVES = ("kitchen table", "counter", "bookshelf", "dresser", "bedside table", "study shelf", "desk")
CRATE = 'sim.obstacles=[{name="crate",kind="box",size=[0.5,0.9,0.9],position=[2.5,-0.75]}]'  # in the kitchen's door
WALKER = (
    'sim.obstacles=[{name="walker",kind="cylinder",size=[0.4,0.4,1.6],'
    "position=[2.5,-0.75],path=[[1.2,-0.9],[1.2,-2.4]],speed=0.3,repeat=true}]"
)
IMPOSSIBLE: tuple[list[dict[str, str]], ...] = (
    [{"action": "grasp", "object": "sofa"}, {"action": "return"}, {"action": "release"}],
    [{"action": "navigate", "target": "swimming pool"}, {"action": "return"}],
    [{"action": "place", "target": "counter"}, {"action": "return"}],
)
FAULTS = ("speech", "planning", "perception", "navigation", "grasp")
NAMED = ("fetch", "misheard", "hallucination", "not_in_view", "blocked_path")
DIALOGUES = ("misheard", "correction", "rejection", "low_confidence", "stop", "cancel", "silence")
CHAOS_STATES = ("CONFIRMING", "PLANNING", "GROUNDING", "NAVIGATING", "GRABBING", "RETURNING", "RELEASING")
HARM: tuple[Kind | Literal["kill", "hang", "jump"], ...] = (
    "kill", "hang", "drop", "duplicate", "delay", "reorder", "jump",
)  # fmt: skip
CHAOS_SERVICES = ("speech", "planner", "perception", "camera", "navigation", "manipulation", "brain")

Make = Callable[[int], Case]


def cases(suite: str, scenarios: int, seed: int, settings: tuple[str, ...] = (), pipeline: str = "") -> list[Case]:
    """The scenarios of a run; `settings` are added to each, `pipeline` where the suite leaves the brain's open."""
    chosen = (f"brain.pipeline={pipeline}",) if pipeline else ()
    found = []
    for n in range(scenarios):
        case = SUITES[suite](seed + n)
        own = case.settings if any(s.startswith("brain.pipeline=") for s in case.settings) else chosen + case.settings
        effective = own + settings
        found.append(msgspec.structs.replace(case, settings=effective, wake=_wakes(effective)))
    return found


def _wakes(settings: tuple[str, ...]) -> bool:
    """In the VLA pipeline the robot has to be addressed before it takes a command."""
    chosen = [s.partition("=")[2] for s in settings if s.startswith("brain.pipeline=")]
    return (chosen[-1] if chosen else load("brain", BrainConfig, config_dir(), {}).pipeline) == "vla"


# --- building blocks
@cache
def _flat() -> Scene:
    """The shipped apartment, read once."""
    return load_scene("apartment")


def _random(seed: int, suite: int) -> np.random.Generator:
    return np.random.default_rng([seed, suite])


def _pick(rng: np.random.Generator, scene: Scene, seed: int, room: str = "", not_room: str = "") -> ObjectSpec:
    """A random object of the seed's layout, in or out of a room."""
    placed = place_objects(scene, seed)

    def where(p: tuple[float, float, float]) -> str:
        found = scene.room_at(p[0], p[1])
        return found.name if found else ""

    fitting = [p.spec for p in placed if (not room or where(p.position) == room) and where(p.position) != not_room]
    pool = fitting or [p.spec for p in placed]
    return pool[int(rng.integers(len(pool)))]


def _other(rng: np.random.Generator, scene: Scene, spec: ObjectSpec) -> ObjectSpec:
    """What the object can be mistaken for: one of the same kind or colour."""
    alike = [o for o in scene.objects if o is not spec and (o.kind == spec.kind or o.colour == spec.colour)]
    pool = alike or [o for o in scene.objects if o is not spec]
    return pool[int(rng.integers(len(pool)))]


def _fetch(suite: str, seed: int, spec: ObjectSpec, scene: Scene, wording: str = WORDINGS[0]) -> Case:
    command = wording.format(spec.name)
    return Case(
        suite=suite, seed=seed, name="fetch", command=command, lines=(Line(command),), thing=spec.name,
        wants=(Want(spec.name, (scene.delivery,)),),
    )  # fmt: skip


def misheard_as(command: str, confidence: float = 0.85) -> tuple[Rule, ...]:
    """What recognition makes of the person's first command."""
    said = {"text": command, "confidence": confidence, "confirmed": False}
    return (Rule(service="speech", key="voice_command", kind="edit", fields=said),)


def hallucinated(plan: list[dict[str, str]]) -> tuple[Rule, ...]:
    return (Rule(service="planner", key="action_plan", kind="edit", fields={"steps": plan, "source": "fault"}),)


# --- suites
def fetch(seed: int) -> Case:
    """A random object, a random wording, typed or spoken."""
    scene, rng = _flat(), _random(seed, 1)
    spec = _pick(rng, scene, seed)
    case = _fetch("fetch", seed, spec, scene, WORDINGS[int(rng.integers(len(WORDINGS)))])
    case.spoken = bool(rng.random() < 0.5)
    return case


def named(seed: int) -> Case:
    """The contract's five scenarios, by the seed."""
    scene, rng = _flat(), _random(seed, 2)
    name = NAMED[seed % len(NAMED)]
    if name == "not_in_view":
        spec = _pick(rng, scene, seed, not_room="living room")
    elif name == "blocked_path":
        spec = _pick(rng, scene, seed, room="kitchen")
    else:
        spec = _pick(rng, scene, seed)
    case = _fetch("seed", seed, spec, scene)
    case.name, case.settings, case.spoken = name, (VLA,), True
    if name == "misheard":
        case.fault, case.rules = "speech", misheard_as(f"bring me the {_other(rng, scene, spec).name}")
    elif name == "hallucination":
        case.fault, case.rules = "planning", hallucinated(IMPOSSIBLE[seed % len(IMPOSSIBLE)])
    elif name == "blocked_path":
        case.fault, case.settings = "navigation", (VLA, CRATE)
    return case


def faults(seed: int) -> Case:
    """One of the failure kinds, by the seed; recovering and honestly reporting both count."""
    scene, rng = _flat(), _random(seed, 3)
    fault = FAULTS[seed % len(FAULTS)]
    spec = _pick(rng, scene, seed, room="kitchen" if fault == "navigation" else "")
    case = _fetch("faults", seed, spec, scene)
    case.name = case.fault = fault
    case.settings, case.honest = (VLA,), True
    if fault == "speech":
        case.spoken = True
        case.rules = misheard_as(f"bring me the {_other(rng, scene, spec).name}", float(rng.uniform(0.5, 0.95)))
    elif fault == "planning":
        case.rules = hallucinated(IMPOSSIBLE[int(rng.integers(len(IMPOSSIBLE)))])
        if rng.random() < 0.3:
            case.rules = (Rule(service="planner", key="action_plan", kind="drop"),)
    elif fault == "perception":
        blind = int(rng.integers(1, 4))
        case.rules = (Rule(service="perception", key="object_pose", kind="edit", count=blind, fields={"found": False}),)
    elif fault == "navigation":
        case.settings = (VLA, CRATE if rng.random() < 0.5 else WALKER)
    else:
        case.rules = (Rule(service="manipulation", key="gripper_command", kind="drop", match={"position": 1.0}),)
    return case


def dialogue(seed: int) -> Case:
    """What can happen between the command and the first movement, and a stop after it."""
    scene, rng = _flat(), _random(seed, 4)
    name = DIALOGUES[seed % len(DIALOGUES)]
    spec = _pick(rng, scene, seed)
    wrong = f"bring me the {_other(rng, scene, spec).name}"
    case = _fetch("dialogue", seed, spec, scene)
    case.name, case.settings, case.spoken = name, (VLA,), True
    if name == "misheard":
        case.rules = misheard_as(wrong)
    elif name in ("correction", "rejection"):
        case.lines = (Line(wrong),)
    elif name == "low_confidence":
        case.rules, case.settings = misheard_as(wrong, 0.5), (VLA, "brain.enable_confirmation=false")
    elif name == "stop":
        case.lines, case.expect = (*case.lines, Line("stop", "NAVIGATING", 2.0)), "stopped"
    elif name == "cancel":
        case.lines, case.expect, case.thing = (*case.lines, Line("cancel", "CONFIRMING", 4.0)), "nothing", ""
        case.silent = True
    else:
        case.expect, case.silent = "nothing", True
    return case


def tidy(seed: int) -> Case:
    """Four objects from the living table to where the rules of `config/planner.toml` want them."""
    scene, rng = _flat(), _random(seed, 5)
    table = "living table"
    order = [scene.objects[int(i)] for i in rng.permutation(len(scene.objects))]
    chosen = [o for o in order if destination(o, scene) not in ("", table)][:4]
    others = [o for o in order if o not in chosen][:4]
    laid = [msgspec.structs.replace(o, on=table) for o in chosen]
    laid += [msgspec.structs.replace(o, on=SHELVES[n % len(SHELVES)]) for n, o in enumerate(others)]
    laid_out = msgspec.structs.replace(scene, objects=tuple(laid))
    command = "tidy up the living table"
    return Case(
        suite="tidy", seed=seed, name="tidy", command=command, lines=(Line(command),), scene=laid_out, limit=1500.0,
        wants=tuple(Want(o.name, (destination(o, scene),)) for o in chosen), settings=(VLA,),
    )  # fmt: skip


def destination(spec: ObjectSpec, scene: Scene, path: Path | None = None) -> str:
    """Where an object belongs by the tidying rules: the first receptacle of the first rule; "" when none fits."""
    for rule in _rules(path or config_dir() / "planner.toml"):
        if spec.kind not in rule.get("kinds", [spec.kind]) or spec.colour not in rule.get("colours", [spec.colour]):
            continue
        for name in rule["to"]:
            if found := _receptacle(name, scene):
                return found.name
    return ""


@cache
def _rules(path: Path) -> list[dict[str, list[str]]]:
    found: list[dict[str, list[str]]] = tomllib.loads(path.read_text(encoding="utf-8")).get("tidy", [])
    return found


def _receptacle(name: str, scene: Scene) -> Receptacle | None:
    return scene.receptacle(name) or next((r for r in scene.receptacles if r.kind == name), None)


def chaos(seed: int) -> Case:
    """Service, state and harm in turn: the first 49 seeds kill each service in each state, the next 49 hang it."""
    scene, rng = _flat(), _random(seed, 6)
    case = _fetch("chaos", seed, _pick(rng, scene, seed), scene)
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


KEYS = {
    "speech": ("voice_command", "brain/speech_result", "speech/status"),
    "planner": ("action_plan",),
    "perception": ("object_pose", "world/objects"),
    "camera": ("camera/head/rgbd", "camera/wrist/rgbd"),
    "navigation": ("brain/navigation_status", "base/target_pose", "navigation_feedback"),
    "manipulation": ("brain/manipulation_status", "gripper_command"),
    "brain": ("brain/navigation_goal", "brain/manipulation_goal", "plan_request", "object_query"),
}
SUITES: dict[str, Make] = {
    "fetch": fetch, "seed": named, "tidy": tidy, "faults": faults, "dialogue": dialogue, "chaos": chaos,
}  # fmt: skip
DEFAULT_SCENARIOS = {"seed": len(NAMED), "dialogue": len(DIALOGUES), "faults": len(FAULTS) * 2, "chaos": 49}
