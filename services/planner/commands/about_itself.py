"""What the robot says about itself: what it does, did and can do, and why something failed. Pure."""

from common.language.indirect import indirect
from common.language.normalise import enumeration
from common.language.pattern import Slots
from services.planner.commands.telling import capital
from services.planner.plan_builder import PlanBuilder, Refusal
from services.planner.reference.resolve import referents

ABILITIES = (
    "I can bring you things, find them, put them somewhere or where they belong, throw them away, "
    "tidy up a table or a"
    " room, go somewhere, look around, wait, and say something. You can ask me what I have seen and where, what I am"
    " doing, what I did and why something failed. I cannot open doors or drawers, pour, cook, clean or switch"
    " things on. Say stop at any time."
)

LIMITS = (
    "With my one hand I lift up to about two kilograms and take hold of what is at most seven centimetres wide. I reach"
    " from the floor to about a metre, drive half a metre a second, and cannot climb stairs."
)
"""As in the data sheets of the arm and the gripper, and as the base drives."""

_STEPS = {
    "plan:": "working out how", "look for": "looking for the {}", "look around": "looking around",
    "look closer at": "looking at the {} from nearer", "search:": "looking around", "approach": "on my way to the {}",
    "find": "on my way to the {}", "goto": "on my way to the {}", "return_to_start": "on my way back",
    "grab": "picking it up", "place": "putting it down", "release": "letting go of it", "check": "checking the {}",
}  # fmt: skip
"""What is done at the moment, by the beginning of a step that the brain shows."""


def doing(builder: PlanBuilder, slots: Slots) -> None:
    """The command under way, and what is done for it at the moment."""
    told, held = builder.world.history, builder.world.held
    if not told.doing:
        hand = f", with the {held.label} in my hand" if held else ""
        builder.say(f"I have nothing to do at the moment{hand}.")
        if told.last is not None:
            done(builder, slots)
        return
    builder.say(f"{_asked(told.doing)}.{_at_present(told.step)}")


def done(builder: PlanBuilder, slots: Slots) -> None:
    """The last command and what came of it."""
    last = builder.world.history.last
    if builder.world.history.doing and (last is None or "words" in slots):
        doing(builder, slots)
        return
    if last is None:
        builder.say("I have done nothing yet.")
        return
    came_of_it = {
        "delivered": "and I have done that",
        "failed": f"but I did not manage it. {last.spoken or last.reason}".rstrip(". "),
        "cancelled": "and that was called off",
    }[last.outcome]
    builder.say(f"{_asked(last.command)}, {came_of_it}.")


def why(builder: PlanBuilder, slots: Slots) -> None:
    """Why the last command failed."""
    last = builder.world.history.last
    if builder.world.history.doing:
        doing(builder, slots)
        return
    if last is None or last.outcome == "delivered":
        builder.say("Nothing has failed.")
        if last is not None:
            done(builder, slots)
        return
    reason = (last.spoken or last.reason or "I do not know why").rstrip(". ")
    builder.say(f"{_asked(last.command)}. {capital(reason)}.")


def _asked(command: str) -> str:
    """`You asked me to bring you the mug`; what cannot be turned is quoted."""
    turned = indirect(command)
    return f"You asked me to {turned}" if turned else f'You said "{command}"'


def _at_present(step: str) -> str:
    """` Right now I am looking for the mug.` of a step as the brain shows it; "" of one that people do not know."""
    for shown, spoken in _STEPS.items():
        if step == shown or step.startswith(f"{shown} "):
            return f" Right now I am {spoken.format(step[len(shown) + 1 :])}."
    return ""


def origin(builder: PlanBuilder, slots: Slots) -> None:
    """Where something stood before the robot took it."""
    for meant in referents(builder, slots["thing"], prefer_held=True):
        label = meant.object.label
        where = builder.world.history.taken_from.get(label)
        if not where:
            raise Refusal(f"I have not taken the {label} from anywhere")
        builder.say(f"I took the {label} from the {where}.")


def repeat(builder: PlanBuilder, slots: Slots) -> None:
    builder.say(builder.world.history.said or "I have said nothing yet.")


def abilities(builder: PlanBuilder, slots: Slots) -> None:
    builder.say(ABILITIES)


def capacity(builder: PlanBuilder, slots: Slots) -> None:
    builder.say("No, I can carry one thing at a time. Of several I bring one after the other.")


def limits(builder: PlanBuilder, slots: Slots) -> None:
    builder.say(LIMITS)


def hearing(builder: PlanBuilder, slots: Slots) -> None:
    builder.say("Yes, I hear you, and I understand English.")


def identity(builder: PlanBuilder, slots: Slots) -> None:
    builder.say("I am TidyBot, a household robot. I fetch things and tidy up.")


def battery(builder: PlanBuilder, slots: Slots) -> None:
    state = builder.world.battery
    if state is None:
        builder.say("I cannot tell how full my battery is.")
        return
    builder.say(f"My battery is at {state.charge:.0%}{' and charging' if state.charging else ''}.")


def rooms(builder: PlanBuilder, slots: Slots) -> None:
    names = [f"the {room.name}" for room in builder.world.household.rooms]
    count = f" {len(names)} rooms:" if len(names) > 1 else ""
    builder.say(f"I know{count} {enumeration(names)}." if names else "I know no rooms.")


def thanks(builder: PlanBuilder, slots: Slots) -> None:
    builder.say("You are welcome.")


def greeting(builder: PlanBuilder, slots: Slots) -> None:
    builder.say("Hello. What can I do for you?")


def parting(builder: PlanBuilder, slots: Slots) -> None:
    builder.say("Goodbye.")
