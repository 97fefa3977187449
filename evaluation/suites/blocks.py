"""Building blocks of scenarios: random objects, commands, misunderstandings, and where things belong."""

from functools import cache

import numpy as np

from common.config import config_dir
from common.household import load_words
from common.scene import ObjectSpec, Receptacle, Scene, load_scene
from evaluation.case import Case, Line
from evaluation.faults.messages import Rule
from judge.evidence import Want
from services.sim.layout import place_objects

VLA = "brain.pipeline=vla"
WORDINGS = (
    "bring me the {}", "fetch me the {}", "get me the {}", "give me the {}", "hand me the {}", "bring the {} to me",
    "please bring me the {}", "get me the {} please",
)  # fmt: skip


@cache
def flat() -> Scene:
    """The shipped apartment, read once."""
    return load_scene("apartment")


def random(seed: int, suite: int) -> np.random.Generator:
    return np.random.default_rng([seed, suite])


def pick(
    rng: np.random.Generator, scene: Scene, seed: int, room: str = "", not_room: str = "", kinds: tuple[str, ...] = ()
) -> ObjectSpec:
    """A random object of the seed's layout, in or out of a room, of one of the kinds."""
    placed = place_objects(scene, seed)

    def where(p: tuple[float, float, float]) -> str:
        found = scene.room_at(p[0], p[1])
        return found.name if found else ""

    fitting = [
        p.spec
        for p in placed
        if (not room or where(p.position) == room)
        and where(p.position) != not_room
        and (not kinds or p.spec.kind in kinds)
    ]
    pool = fitting or [p.spec for p in placed]
    return pool[int(rng.integers(len(pool)))]


def other(rng: np.random.Generator, scene: Scene, spec: ObjectSpec) -> ObjectSpec:
    """Another object that this one can be mistaken for: of the same kind or colour."""
    alike = [o for o in scene.objects if o is not spec and (o.kind == spec.kind or o.colour == spec.colour)]
    pool = alike or [o for o in scene.objects if o is not spec]
    return pool[int(rng.integers(len(pool)))]


def fetch_case(suite: str, seed: int, spec: ObjectSpec, scene: Scene, wording: str = WORDINGS[0]) -> Case:
    command = wording.format(spec.name)
    return Case(
        suite=suite, seed=seed, name="fetch", command=command, lines=(Line(command),), thing=spec.name,
        wants=(Want(spec.name, (scene.delivery,)),),
    )  # fmt: skip


def misheard_as(command: str, confidence: float = 0.85) -> tuple[Rule, ...]:
    """A fault by which speech recognition takes what the user says for `command`."""
    said = {"text": command, "confidence": confidence, "confirmed": False}
    return (Rule(service="speech", key="voice_command", kind="edit", fields=said),)


def hallucinated(plan: list[dict[str, str]]) -> tuple[Rule, ...]:
    return (Rule(service="planner", key="action_plan", kind="edit", fields={"steps": plan, "source": "fault"}),)


def destination(spec: ObjectSpec, scene: Scene) -> str:
    """Where an object belongs by the tidying rules: the first receptacle of the first rule; "" when none fits."""
    for rule in load_words(config_dir()).tidy:
        if (rule.kinds and spec.kind not in rule.kinds) or (rule.colours and spec.colour not in rule.colours):
            continue
        for name in rule.to:
            if found := _receptacle(name, scene):
                return found.name
    return ""


def _receptacle(name: str, scene: Scene) -> Receptacle | None:
    return scene.receptacle(name) or next((r for r in scene.receptacles if r.kind == name), None)
