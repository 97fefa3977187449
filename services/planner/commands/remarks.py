"""What is said beside a command: a reason, a thing or a place that is spoken of next. Pure."""

from common.language.normalise import without_determiners
from common.language.pattern import Slots
from common.messages import SENSELESS, PlanStep
from common.naming.names import normalise
from services.planner.grammar.phrases import Phrase, read
from services.planner.grammar.senses import LONGEST_NAME
from services.planner.plan_builder import Lost, PlanBuilder, Refusal
from services.planner.reference.places import spot
from services.planner.reference.pronouns import speak_of
from services.planner.reference.resolve import referents

_ASKING = frozenset({"what", "how", "who", "which", "again"})
"""Words of a question for a name: `the box is called what, again?`."""


def remark(builder: PlanBuilder, slots: Slots) -> None:
    """A reason for what is asked next, such as "I'm thirsty"; a need that is known is met if nothing else is asked."""
    words = slots.get("words", ())
    if "and" in words:
        raise Lost("I do not understand that")
    needs = builder.world.household.words.needs
    builder.need = next((n for w, n in needs.items() if w in words), builder.need)


def mention(builder: PlanBuilder, slots: Slots) -> None:
    """A thing that is spoken of next as "it"; where it is said to be is where it is looked for."""
    if "and" in slots.get("words", ()):
        raise Lost(f"{SENSELESS} that")
    words = (*slots["thing"], "on", *slots["spot"]) if "spot" in slots else slots["thing"]
    try:
        speak_of(builder, referents(builder, words))
    except Refusal:
        speak_of(builder, referents(builder, slots["thing"]))


def untidy(builder: PlanBuilder, slots: Slots) -> None:
    """The place that is spoken of next as "it"."""
    builder.spot = spot(builder, slots["spot"])


def again(builder: PlanBuilder, slots: Slots) -> None:
    """What was done before is worked out from its words, before any clause is read."""
    raise Refusal("I have done nothing yet that I could do again")


# --- names of things: what they are taught for, and which are forgotten
def teach(builder: PlanBuilder, slots: Slots) -> None:
    """The thing that is named, or "this", gets a name. Which one that is perception decides, which sees it."""
    thing = " ".join(without_determiners(slots.get("thing", ())))
    phrase = read(slots["thing"], builder.vocabulary) if thing else None
    if thing and (not isinstance(phrase, Phrase) or phrase.sense.new):
        raise Lost(f"I know no {thing} that could have a name")
    builder.steps.append(PlanStep(action="teach", object=thing, text=_name(builder, slots)))


def teach_owned(builder: PlanBuilder, slots: Slots) -> None:
    """`that's grandma's cup` of what the hand holds or has just brought, or of a thing of that kind that is named."""
    *owners, kind = slots["words"]
    owned = owners and owners[-1].endswith("'s")
    alike = kind == slots["thing"][-1] if "thing" in slots else builder.world.held or builder.world.history.last
    if not (owned or kind.endswith("'s")) or not alike:
        raise Lost(f"{SENSELESS} what {' '.join(slots['words'])!r} has to do with it")
    teach(builder, slots)


def forget(builder: PlanBuilder, slots: Slots) -> None:
    """A name that was taught is forgotten, of a thing or of a place."""
    words = " ".join(without_determiners(slots["words"]))
    if any(n.name == normalise(words) for n in builder.world.edits.names):
        builder.steps.append(PlanStep(action="forget", target="place", text=words))
        return
    builder.steps.append(PlanStep(action="forget", text=_name(builder, slots)))


def _name(builder: PlanBuilder, slots: Slots) -> str:
    """The name as it is to be kept.

    Raises:
        Refusal: it is a place, a word that says how a thing is ("the ball is my favourite"), or one that asks.
    """
    words = without_determiners(slots["words"])
    if len(words) > LONGEST_NAME:
        raise Lost(f"{' '.join(words)} is too long a name")
    no_name = _ASKING | set(builder.world.household.words.qualities)
    if not words or builder.vocabulary.spot(words) or set(words) <= no_name:
        raise Refusal(f"{' '.join(slots['words'])} is no name for a thing")
    return " ".join(words)
