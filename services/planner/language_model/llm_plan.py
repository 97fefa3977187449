"""Plans of a language model: odd names become the household's, then the rules for all plans decide. Pure."""

from collections.abc import Sequence

import msgspec

from common.language.normalise import normalise
from common.messages import GRIPPER, PlanStep
from common.plan_rules import known_world, objection
from services.planner.grammar.vocabulary import Vocabulary
from services.planner.world import World


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
