"""What the robot does with itself: going, waiting, looking for something, saying something. Pure."""

import re

from common.language.normalise import DETERMINERS, Words
from common.language.pattern import Slots
from common.language.quantities import LONGEST, duration, number
from common.messages import SENSELESS
from services.planner.commands.telling import capital
from services.planner.grammar.phrases import Phrase, read
from services.planner.grammar.senses import Spot
from services.planner.plan_builder import Lost, PlanBuilder, Refusal
from services.planner.reference.places import spot
from services.planner.reference.resolve import referent, referents

_GREETED = re.compile(
    r"^(?P<words>hello|hi|good (?:morning|afternoon|evening|night)|goodbye|bye|sorry|thank you|thanks) "
    r"to (?P<whom>(?!him\b|her\b|them\b)\w.*)$"
)
"""`hello to anna`: whom a courtesy is for is spoken to."""
_MANNER = re.compile(
    r"^(?:(?:loudly|softly|quietly|clearly|aloud|out loud) |the words? (?=\w))+"
    r"| (?:(?:(?:really|very|out) )?loud|aloud|loudly|softly|for me|to (?:him|her|them)|"
    r"so (?:that )?.+ (?:hears?|knows?)(?: it| that| you| me)?|"
    r"in (?:your|a) (?:\w+ ){0,2}voice)$"
)
"""How something is to be said, which is not said with it."""


def go(builder: PlanBuilder, slots: Slots) -> None:
    """To a place, or up to a thing."""
    try:
        place = spot(builder, slots["spot"])
    except Refusal:
        phrase = read(slots["spot"], builder.vocabulary)
        if not isinstance(phrase, Phrase) or phrase.sense.new:
            raise
        meant = referent(builder, slots["spot"])
        builder.approach(meant.object)
        return
    builder.go(place)


def go_there(builder: PlanBuilder, slots: Slots) -> None:
    """To the place that was spoken of."""
    go(builder, {"spot": ("there",)})


def come_back(builder: PlanBuilder, slots: Slots) -> None:
    """Home, unless the plan has just handed something over there."""
    if [step.action for step in builder.steps[-2:]] == ["return", "release"]:
        return
    builder.go(Spot(builder.world.household.home.name, home=True))


def leave(builder: PlanBuilder, slots: Slots) -> None:
    """Out of a place, which is back home; where the robot is sent away without a place there is none to go to."""
    if slots.get("spot") in (("it",), ("that",), ("there",), ("them",)):
        raise Lost("I do not know which place you mean")
    if "spot" not in slots or spot(builder, slots["spot"]).home:
        raise Refusal("you did not say where to go")
    come_back(builder, slots)
    builder.leaving = True


def wait(builder: PlanBuilder, slots: Slots) -> None:
    """For as long as was said, else for a moment."""
    _wait(builder, slots.get("words", ()))


def count(builder: PlanBuilder, slots: Slots) -> None:
    """Count to a number, one a second."""
    _wait(builder, slots["words"] if number(slots["words"]) is None else (*slots["words"], "seconds"))


def _wait(builder: PlanBuilder, said: Words) -> None:
    seconds = duration(said) if said else 0.0
    if seconds is None:
        raise Lost(f"{SENSELESS} {' '.join(said)!r}")
    if seconds > LONGEST:
        raise Refusal(f"I wait {LONGEST / 60:.0f} minutes at most")
    builder.wait(seconds)


def wait_there(builder: PlanBuilder, slots: Slots) -> None:
    """Wait at a place."""
    go(builder, slots)
    builder.wait()


def find(builder: PlanBuilder, slots: Slots) -> None:
    everything = referents(builder, slots["thing"])
    for meant in everything:
        if meant.at is not None:
            builder.go(meant.at)
        builder.find(meant.object, meant.words)
    builder.last = [m.object for m in everything]


def say(builder: PlanBuilder, slots: Slots) -> None:
    """What was said to be said, where it is to be heard."""
    if "spot" in slots:
        go(builder, slots)
    builder.say(utterance(" ".join(slots["words"])))


def utterance(text: str) -> str:
    """The sentence for `hello to anna`, `aloud the words dinner is ready`."""
    text = _MANNER.sub("", text)
    if greeted := _GREETED.match(text):
        named = greeted["whom"].split()[0] not in DETERMINERS
        text = f"{greeted['words']}, {greeted['whom'].title()}" if named else greeted["words"]
    return f"{capital(text)}."
