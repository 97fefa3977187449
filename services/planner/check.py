"""Is a plan of somebody else's making possible? Pure."""

from collections.abc import Sequence

import msgspec

from common.messages import GRIPPER, PlanStep
from services.planner.vocabulary import Vocabulary
from services.planner.words import normal
from services.planner.world import World


class Impossible(Exception):
    """The reason, as a clause."""


def checked(steps: Sequence[PlanStep], world: World, vocabulary: Vocabulary, max_steps: int) -> list[PlanStep]:
    """The steps with every name as the scene has it.

    Raises:
        Impossible: an unknown name, an order that cannot work, or too many steps.
    """
    if len(steps) > max_steps:
        raise Impossible(f"the plan has {len(steps)} steps")
    held = world.held.label if world.held else ""
    found: set[str] = set()
    done: list[PlanStep] = []
    for number, step in enumerate(steps, 1):
        try:
            step = _named(step, world, vocabulary)
            _in_order(step, held, found)
        except Impossible as impossible:
            raise Impossible(f"step {number}: {impossible}") from None
        if step.hand_alone:
            pass
        elif step.action == "find":
            found.add(step.object)
        elif step.action == "grasp":
            held = step.object
        elif step.action in ("place", "release"):
            held = ""
        done.append(step)
    return done


def _in_order(step: PlanStep, held: str, found: set[str]) -> None:
    match step.action:
        case "grasp" | "release" if step.hand_alone:
            if held:
                raise Impossible(f"the hand holds the {held}")
        case "grasp" if held:
            raise Impossible(f"the hand already holds the {held}")
        case "grasp" if step.object not in found:
            raise Impossible(f"the {step.object} must be found before it can be grasped")
        case "place" | "release" if not held:
            raise Impossible(f"there is nothing in the hand to {step.action}")
        case "say" if not step.text.strip():
            raise Impossible("there is nothing to say")


def _named(step: PlanStep, world: World, vocabulary: Vocabulary) -> PlanStep:
    """Aliases and odd spellings become the scene's names."""
    thing, target = step.object, step.target
    match step.action:
        case "grasp" | "release" if step.hand_alone:
            return PlanStep(action=step.action, target=GRIPPER)
        case "find" | "grasp":
            return msgspec.structs.replace(step, object=_thing(thing or target, world, vocabulary), target="", text="")
        case "place":
            receptacle = world.scene.receptacle(normal(target or thing))
            if receptacle is None:
                raise Impossible(f"there is no {target or thing or 'place'} to put things on")
            return msgspec.structs.replace(step, object="", target=receptacle.name)
        case "navigate":
            spots = vocabulary.spot(tuple(normal(target).split())) if target else []
            if spots:
                home = spots[0].home
                return PlanStep(action="return") if home else PlanStep(action="navigate", target=spots[0].name)
            try:
                return PlanStep(action="navigate", object=_thing(target or thing, world, vocabulary))
            except Impossible:
                raise Impossible(f"I know no place {target or thing!r}") from None
        case "say":
            return PlanStep(action="say", text=step.text)
        case _:
            return PlanStep(action=step.action)


def _thing(name: str, world: World, vocabulary: Vocabulary) -> str:
    if not name:
        raise Impossible("no object is named")
    known = [*world.things, *world.specs]
    wanted = normal(name).removeprefix("the ")
    spec = world.scene.object(wanted)
    label = spec.name if spec else next((t.label for t in known if normal(t.label) == wanted), "")
    if label:
        return label
    if wanted in vocabulary.kinds:
        return wanted
    raise Impossible(f"I know no {name} that I could pick up")
