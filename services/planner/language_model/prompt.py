"""What a language model is told and the form its answer must have. Pure."""

from collections.abc import Sequence
from typing import Any

import msgspec

from common.language.normalise import normalise
from common.messages import GRIPPER, PlanStep, RejectedPlan, StepAction
from common.naming.words import Destination
from common.plan_rules import known_world, objection
from services.planner.grammar.vocabulary import Vocabulary
from services.planner.world import World

RULES = """\
You plan for a household robot with one arm. Answer with JSON only: {"steps": [...], "detail": "..."}.
Actions: find (object), grasp (object), place (target: a receptacle; near: the object on it to put it next to),
release (set down here), return (to the person), navigate (target: a place, room or receptacle), say (text), wait,
teach (text: the name that a person gives to the object, or to what is before the robot if object is ""), forget (text:
a name), name (text: what the room, surface or place is called that the robot stands in or before), rule (text:
things in words, such as mugs; target: the receptacle where they go from now on).
Unused fields are "".
- A thing must be found before it is grasped; the hand holds one thing; place and release empty it.
- Bringing something to the person is: find, grasp, return, release.
- The empty hand alone is opened by release and closed by grasp, both with the target "gripper".
- place drives to the receptacle by itself.
- Use only names from the lists, letter by letter. Never invent objects, places or actions.
- Questions are answered with say, from what is listed.
- If it cannot be done, or several things could be meant, answer with no steps and the reason in detail."""


class Step(msgspec.Struct, forbid_unknown_fields=True):
    """As asked for: every field present."""

    action: StepAction
    object: str
    target: str
    text: str


class Answer(msgspec.Struct, forbid_unknown_fields=True):
    steps: list[Step]
    detail: str


def schema(world: World) -> dict[str, Any]:
    """JSON schema of an answer, with the names of this world as the only values of `object` and `target`."""
    (_,), parts = msgspec.json.schema_components([Answer], ref_template="#/$defs/{name}")
    root = parts.pop("Answer")
    fields = parts["Step"]["properties"]
    fields["object"] = {"type": "string", "enum": ["", *_objects(world)]}
    fields["target"] = {"type": "string", "enum": ["", *_targets(world), GRIPPER]}
    return {**root, "$defs": parts}


def messages(command: str, world: World, rejected: list[RejectedPlan]) -> list[dict[str, str]]:
    """System and user message; the latter is the world and the command as JSON."""
    told: dict[str, object] = {
        "objects": [
            {"name": t.label, "kind": t.kind, "colour": t.colour, "where": t.on or world.room_of(t)}
            for t in world.objects
            if not t.held
        ],
        "objects_not_seen_yet": [n for n in _objects(world) if n not in {t.label for t in world.objects}],
        "in_hand": world.held.label if world.held else "",
        "receptacles": [r.name for r in world.household.receptacles],
        "places": [n for n in _targets(world) if world.household.receptacle(n) is None],
        "where_things_go": [_rule(r) for r in world.household.words.tidy],
        "where_rubbish_goes": [_rule(r) for r in world.household.words.throw],
        "command": command,
    }
    if rejected:
        told["rejected_plans"] = [{"steps": r.steps, "step": r.step, "reason": r.reason} for r in rejected]
    user = msgspec.json.encode(told).decode()
    return [{"role": "system", "content": RULES}, {"role": "user", "content": user}]


def _rule(rule: Destination) -> str:
    which = " ".join((*rule.colours, *(rule.kinds or ("anything else",))))
    return f"{which}: {' or '.join(rule.to)}"


def _objects(world: World) -> list[str]:
    return list(dict.fromkeys(t.label for t in (*world.objects, *world.specs)))


def _targets(world: World) -> list[str]:
    household = world.household
    names = (
        [r.name for r in household.receptacles] + [r.name for r in household.rooms] + [p.name for p in household.places]
    )
    return list(dict.fromkeys([*names, *world.places, household.home.name]))


# --- plans of a language model: odd names become the household's, then the rules for all plans decide
class Impossible(Exception):
    """The reason, as a clause."""


def checked(steps: Sequence[PlanStep], world: World, vocabulary: Vocabulary, max_steps: int) -> list[PlanStep]:
    """The steps with every name as the household has it; no steps are no plan, and nothing to object to.

    Raises:
        Impossible: an unknown name, or what `common.plan_rules` objects to.
    """
    named: list[PlanStep] = []
    for number, step in enumerate(steps, 1):
        try:
            named.append(_named(step, world, vocabulary))
        except Impossible as impossible:
            raise Impossible(f"step {number}: {impossible}") from None
    known = known_world(world.household, [t.label for t in world.objects], world.held.label if world.held else "")
    if named and (against := objection(named, known, world.household, max_steps)):
        raise Impossible(str(against))
    return named


def _named(step: PlanStep, world: World, vocabulary: Vocabulary) -> PlanStep:
    """Aliases and odd spellings become the household's names."""
    item, target = step.object, step.target
    match step.action:
        case "grasp" | "release" if step.hand_alone:
            return PlanStep(action=step.action, target=GRIPPER)
        case "find" | "grasp":
            return msgspec.structs.replace(step, object=_thing(item or target, world, vocabulary), target="", text="")
        case "place":
            receptacle = world.household.receptacle(normalise(target or item))
            if receptacle is None:
                raise Impossible(f"there is no {target or item or 'place'} to put things on")
            near = _thing(step.near, world, vocabulary) if step.near else ""
            return msgspec.structs.replace(step, object="", target=receptacle.name, near=near)
        case "navigate":
            spots = vocabulary.spot(tuple(normalise(target).split())) if target else []
            if spots:
                home = spots[0].home
                return PlanStep(action="return") if home else PlanStep(action="navigate", target=spots[0].name)
            try:
                return PlanStep(action="navigate", object=_thing(target or item, world, vocabulary))
            except Impossible:
                raise Impossible(f"I know no place {target or item!r}") from None
        case "say":
            return PlanStep(action="say", text=step.text)
        case "rule":
            return PlanStep(action="rule", object=step.object or step.text, target=step.target)
        case "teach" | "forget" | "name":
            return PlanStep(action=step.action, object=step.object, target=step.target, text=step.text)
        case _:
            return PlanStep(action=step.action)


def _thing(name: str, world: World, vocabulary: Vocabulary) -> str:
    if not name:
        raise Impossible("no object is named")
    known = [*world.objects, *world.specs]
    wanted = normalise(name).removeprefix("the ")
    spec = world.household.thing(wanted)
    label = spec.name if spec else next((t.label for t in known if normalise(t.label) == wanted), "")
    if label:
        return label
    if wanted in vocabulary.kinds:
        return wanted
    raise Impossible(f"I know no {name} that I could pick up")
