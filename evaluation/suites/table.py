"""The table of suites, functions from a seed to a scenario. Case i of a run has seed `seed + i`."""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import NamedTuple

import msgspec
import numpy as np

from common.config import config_dir, load
from common.scene import ObjectSpec
from evaluation.case import Case, Line
from evaluation.faults.messages import Rule
from evaluation.faults.physical.fault import Kind as PhysicalKind
from evaluation.faults.physical.fault import PhysicalFault
from evaluation.homes.new import new
from evaluation.homes.suite import aged, homes, lost
from evaluation.suites.blocks import (
    VLA,
    WORDINGS,
    destination,
    fetch_case,
    flat,
    hallucinated,
    misheard_as,
    other,
    pick,
    random,
)
from evaluation.suites.chaos import CHAOS_SERVICES, CHAOS_STATES, chaos
from evaluation.suites.commands import ALL, commands
from evaluation.suites.spoken import HERE, MANIFEST, read_corpus, spoken
from evaluation.suites.taught import taught
from evaluation.suites.unknown import clutter, labels, lying, scanned, sizes
from judge.evidence import Want
from services.brain.config import BrainConfig

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
FAULTS = ("speech", "planning", "perception", "navigation", "shove", "slip", "jam", "heavy", "wide")
NAMED = ("fetch", "misheard", "hallucination", "not_in_view", "blocked_path")
SECONDS = {"slip": (0.06, 0.12), "jam": (2.0, 25.0)}
"""How long a fault lasts [s]: a slip from a slide of 12 mm to a fall, a jam from one grasp to three."""
AMOUNT = {"heavy": (7.0, 12.0), "wide": (0.087, 0.089)}
"""Mass [kg]: friction 1 and 25 N at each of two pads hold 5. Width [m]: the hand opens to 85 mm."""
GRASPED: dict[str, tuple[str, ...]] = {
    "wide": ("mug", "apple"), "shove": ("mug", "can", "bottle", "apple", "block", "box", "ball"),
}  # fmt: skip
"""Kinds that a fault concerns: a wide mug or bowl is taken by its handle or rim, where a shove hits the finger too."""
DIALOGUES = ("misheard", "correction", "rejection", "low_confidence", "stop", "cancel", "silence")

Make = Callable[[int], Case]


def cases(
    suite: str,
    scenarios: int,
    seed: int,
    settings: tuple[str, ...] = (),
    pipeline: str = "",
    voices: Path | None = None,
    snr: float | None = None,
    replaced: tuple[str, ...] = (),
) -> list[Case]:
    """The scenarios of a run; `settings` are added to each, `pipeline` where the suite leaves the brain's open.

    `voices` is a directory of recordings for the suite `spoken`, `snr` its signal-to-noise ratio [dB]. `replaced` are
    classes that stand in for services.
    """
    make = SUITES[suite].make
    if suite == "spoken":
        voices = voices or (HERE if (HERE / MANIFEST).exists() else None)
        make = partial(spoken, corpus=read_corpus(voices) if voices else None, snr=snr)
    return [dressed(make(seed + n), settings, pipeline, replaced) for n in range(scenarios)]


def dressed(case: Case, settings: tuple[str, ...], pipeline: str, replaced: tuple[str, ...]) -> Case:
    """A case with the settings that the command line adds to each."""
    chosen = (f"brain.pipeline={pipeline}",) if pipeline else ()
    own = case.settings if any(s.startswith("brain.pipeline=") for s in case.settings) else chosen + case.settings
    effective = own + settings
    return msgspec.structs.replace(case, settings=effective, wake=_wakes(effective), replaced=replaced)


def _wakes(settings: tuple[str, ...]) -> bool:
    """True when the robot has to be addressed before it takes a command: in the VLA pipeline."""
    chosen = [s.partition("=")[2] for s in settings if s.startswith("brain.pipeline=")]
    return (chosen[-1] if chosen else load("brain", BrainConfig, config_dir(), {}).pipeline) == "vla"


def fetch(seed: int) -> Case:
    """A random object, a random wording, typed or spoken."""
    scene, rng = flat(), random(seed, 1)
    spec = pick(rng, scene, seed)
    case = fetch_case("fetch", seed, spec, scene, WORDINGS[int(rng.integers(len(WORDINGS)))])
    case.spoken = bool(rng.random() < 0.5)
    return case


def named(seed: int) -> Case:
    """The contract's five scenarios, by the seed."""
    scene, rng = flat(), random(seed, 2)
    name = NAMED[seed % len(NAMED)]
    if name == "not_in_view":
        spec = pick(rng, scene, seed, not_room="living room")
    elif name == "blocked_path":
        spec = pick(rng, scene, seed, room="kitchen")
    else:
        spec = pick(rng, scene, seed)
    case = fetch_case("seed", seed, spec, scene)
    case.name, case.settings, case.spoken = name, (VLA,), True
    if name == "misheard":
        case.fault, case.rules = "speech", misheard_as(f"bring me the {other(rng, scene, spec).name}")
    elif name == "hallucination":
        case.fault, case.rules = "planning", hallucinated(IMPOSSIBLE[seed % len(IMPOSSIBLE)])
    elif name == "blocked_path":
        case.fault, case.settings = "navigation", (VLA, CRATE)
        case.physical = (PhysicalFault(kind="obstacle", thing="crate"),)
    return case


def faults(seed: int) -> Case:
    """One of the failure kinds, by the seed; recovering and honestly reporting both count.

    What is too heavy or too wide cannot be fetched: there only the honest report does.
    """
    scene, rng = flat(), random(seed, 3)
    fault = FAULTS[seed % len(FAULTS)]
    room = "kitchen" if fault == "navigation" else ""
    spec = pick(rng, scene, seed, room=room, kinds=GRASPED.get(fault, ()))
    case = fetch_case("faults", seed, spec, scene)
    case.name = case.fault = fault
    case.settings, case.honest = (VLA,), True
    if fault == "speech":
        case.spoken = True
        case.rules = misheard_as(f"bring me the {other(rng, scene, spec).name}", float(rng.uniform(0.5, 0.95)))
    elif fault == "planning":
        case.rules = hallucinated(IMPOSSIBLE[int(rng.integers(len(IMPOSSIBLE)))])
        if rng.random() < 0.3:
            case.rules = (Rule(service="planner", key="action_plan", kind="drop"),)
    elif fault == "perception":
        blind = int(rng.integers(1, 4))
        case.rules = (Rule(service="perception", key="object_pose", kind="edit", count=blind, fields={"found": False}),)
    elif fault == "navigation":
        crate = rng.random() < 0.5
        case.settings = (VLA, CRATE if crate else WALKER)
        case.physical = (PhysicalFault(kind="obstacle", thing="crate" if crate else "walker"),)
    else:
        grasp_fault(case, spec, rng)
    return case


def grasp_fault(case: Case, spec: ObjectSpec, rng: np.random.Generator) -> None:
    """What the case's fault does to the grasp of its object."""
    fault = msgspec.convert(case.fault, PhysicalKind)
    low, high = SECONDS.get(fault, (0.0, 0.0))
    case.physical = (
        PhysicalFault(
            kind=fault, thing=spec.name, seconds=float(rng.uniform(low, high)), after=float(rng.uniform(0.1, 0.6)),
            amount=float(rng.uniform(*AMOUNT.get(fault, (0.0, 0.0)))),
        ),
    )  # fmt: skip
    case.expect = "reported" if fault in AMOUNT else "delivered"


def dialogue(seed: int) -> Case:
    """What can happen between the command and the first movement, and a stop after it."""
    scene, rng = flat(), random(seed, 4)
    name = DIALOGUES[seed % len(DIALOGUES)]
    spec = pick(rng, scene, seed)
    wrong = f"bring me the {other(rng, scene, spec).name}"
    case = fetch_case("dialogue", seed, spec, scene)
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
    """Four objects from the living table to where the rules of `config/words.toml` want them."""
    scene, rng = flat(), random(seed, 5)
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


class Suite(NamedTuple):
    """`make`: a case from a seed. `bar`: the share of cases that must end as expected. `scenarios` unless told.

    The bar is all where every case is a scenario of the contract or a dialogue, less where a random scene, voice or
    fault at a random moment may leave nothing to be done.
    """

    make: Make
    bar: float
    scenarios: int = 10


SUITES: dict[str, Suite] = {
    "fetch": Suite(fetch, 0.95),
    "seed": Suite(named, 1.0, len(NAMED)),
    "tidy": Suite(tidy, 0.9),
    "faults": Suite(faults, 0.9, 2 * len(FAULTS)),
    "dialogue": Suite(dialogue, 1.0, len(DIALOGUES)),
    "chaos": Suite(chaos, 0.95, len(CHAOS_SERVICES) * len(CHAOS_STATES)),
    "commands": Suite(commands, 0.9, len(ALL)),
    "spoken": Suite(spoken, 0.8),
    "sizes": Suite(sizes, 0.95),
    "clutter": Suite(clutter, 0.9),
    "lying": Suite(lying, 0.9),
    "labels": Suite(labels, 0.9),
    "things": Suite(scanned, 0.85),
    "taught": Suite(taught, 0.9),
    "homes": Suite(homes, 0.95),
    "aged": Suite(aged, 0.9),
    "lost": Suite(lost, 0.9),
    "new": Suite(new, 0.85),
}
WORLD_BAR = 0.9
"""The bar of worlds from outside; chosen: as of the suites in homes that somebody has furnished."""
