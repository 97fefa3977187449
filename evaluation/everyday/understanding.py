"""What the brain and the planner make of everyday sentences in their context."""

from typing import NamedTuple

from common.messages import ActionPlan, History, MissionOutcome, PlanStep, WorldObject
from common.plan_rules import known_world, objection
from evaluation.everyday.flat import CONFIG, FLAT, HOME, NOW, PLAINLY
from evaluation.everyday.sentences import Sentence
from services.brain.language.choosing import chosen
from services.brain.language.corrections import corrected
from services.brain.language.dialogue import reply
from services.brain.language.interjection import interjection
from services.planner.config import PlannerConfig
from services.planner.grammar import grammar
from services.planner.world import believed


class Understood(NamedTuple):
    """What the robot makes of a sentence. `kind`: "queue", "replace" or another word that stands before it, "" none.

    `looks` are steps that only go and look before the plan proper; `reason` says why there is no plan.
    """

    kind: str
    looks: list[PlanStep]
    steps: list[PlanStep]
    reason: str = ""
    asks: str = ""


def understand(sentence: Sentence) -> Understood:
    """What the brain and the planner make of a sentence in its context."""
    tag, _, about = sentence.context.partition(":")
    match tag:
        case "heard":
            kind, rest = reply(sentence.said, about)
            if kind == "correction":
                return planned(corrected(about, rest, HOME), FLAT, "", History())
            return Understood(kind, [], [])
        case "which":
            options = about.split("|")
            kind = reply(sentence.said)[0]
            label = None if kind == "cancel" else chosen(sentence.said, options, FLAT, HOME)
            if label is None and kind in ("no", "cancel"):
                return Understood(kind, [], [])
            return Understood(f"pick {label}", [], []) if label else Understood("", [], [], "no choice")
        case "busy":
            said = interjection(sentence.said, about)
            if said.kind == "aside":
                return planned(said.text, FLAT, "", History(doing=about, step=f"find {about}"))
            if said.kind in BEFORE:
                return planned(said.text, FLAT, "", after(BEFORE[said.kind], about)[2])._replace(kind=said.kind)
            return Understood(said.kind, [], [])
    return planned(sentence.said, *after(tag, about))


BEFORE: dict[str, str] = {"queue": "last", "replace": "instead"}
"""Context in which something is planned that was said for later, or instead of what was under way."""


def at_rest(sentence: Sentence) -> Sentence:
    """What was said to a robot at work as the planner gets it, with the readings that are for then; others as it is."""
    tag, _, about = sentence.context.partition(":")
    said = interjection(sentence.said, about) if tag == "busy" else None
    if said is None or said.kind not in BEFORE:
        return sentence
    readings = [r.strip().removeprefix(f"{said.kind}: ") for r in sentence.right.split("||") if said.kind in r]
    return Sentence(f"{BEFORE[said.kind]}:{about}", said.text, "||".join(readings)) if readings else sentence


def after(tag: str, about: str) -> tuple[list[WorldObject], str, History]:
    """Flat, what is in the hand, and history of a context."""
    flat = list(FLAT)
    if tag == "held":
        history = History(taken_from={about: next((o.on for o in FLAT if o.label == about), "")})
        return [o for o in flat if o.label != about], about, history
    if tag == "instead":  # what was under way is the last command by then
        return flat, "", History(last=MissionOutcome(id="m", command=about, outcome="cancelled", reason="", t=NOW))
    if tag not in ("last", "failed"):
        return flat, "", History(said="x")
    done = planned(about, FLAT, "", History(), PLAINLY)
    label = next((s.object for s in (*done.looks, *done.steps) if s.object), "")
    origin = next((o.on for o in FLAT if o.label == label), "")  # "" of what nobody has listed, and of a rule's things
    if not origin and tag == "last":
        return (
            flat,
            "",
            History(
                last=MissionOutcome(id="m", command=about, outcome="delivered", reason="", t=NOW - 5),
                said=" ".join(s.text for s in done.steps),
            ),
        )
    target = next((s.target for s in done.steps if s.action == "place"), HOME.delivery)
    if tag == "failed":
        spoken = f"I could not find the {label}."
        last = MissionOutcome(id="m", command=about, outcome="failed", reason=spoken, spoken=spoken, t=NOW - 5)
        return flat, "", History(last=last, objects=[label] if label else [])
    last = MissionOutcome(id="m", command=about, outcome="delivered", reason="", t=NOW - 5)
    actions = [s.action for s in done.steps]
    if "grasp" not in actions:  # it stands where it was
        return flat, "", History(last=last, objects=[label])
    if actions[-1] == "grasp":
        return (
            [o for o in flat if o.label != label],
            label,
            History(last=last, objects=[label], taken_from={label: origin}),
        )
    receptacle = HOME.receptacle(target)
    assert receptacle is not None
    x, y, z = receptacle.center
    moved = [
        o if o.label != label else WorldObject(label=o.label, kind=o.kind, colour=o.colour, position=(x, y, z + 0.05),
                                               size=o.size, on=receptacle.name, seen_at=NOW - 5)
        for o in flat
    ]  # fmt: skip
    return moved, "", History(last=last, objects=[label], taken_from={label: origin})


def planned(
    command: str,
    objects: list[WorldObject] | None = None,
    held: str = "",
    history: History | None = None,
    settings: PlannerConfig = CONFIG,
) -> Understood:
    """The planner's last word, after it has looked where it wanted to."""
    objects = FLAT if objects is None else objects
    told = known_world(HOME, [o.label for o in objects], held)
    world = believed(HOME, told, objects, (0.0, 0.0, 0.0), NOW, history)
    looked: list[PlanStep] = []
    for _ in range(5):
        plan: ActionPlan = grammar.plan(command, world, settings, (), looked)
        wrong = objection(plan.steps, told, HOME)
        assert not plan.steps or wrong is None, f"{command!r}: the brain objects: {wrong}"
        if not plan.again:
            break
        looked += plan.steps
    return Understood("", looked, plan.steps, plan.detail, plan.suggestion)
