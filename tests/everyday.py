"""What the robot makes of everyday sentences, and whether that is right by the notation of tests/data/sentences.tsv."""

import re
from itertools import chain, permutations, product
from pathlib import Path
from typing import Literal, NamedTuple

import msgspec

from common import config
from common.household import load_household
from common.language.contractions import expand
from common.language.normalise import normalise
from common.messages import ActionPlan, History, MissionOutcome, PlanStep, WorldObject
from common.plan_rules import known_world, objection
from services.brain.language.choosing import chosen
from services.brain.language.corrections import corrected
from services.brain.language.dialogue import reply
from services.brain.language.interjection import interjection
from services.planner.config import PlannerConfig
from services.planner.grammar import grammar
from services.planner.world import believed

Verdict = Literal["right", "asked rightly", "asked back", "not understood", "wrong"]
DATA = Path(__file__).parent / "data" / "sentences.tsv"
LEARNING = DATA.with_name("learning.tsv")
CONFIG = config.load("planner", PlannerConfig, config.DEFAULT_DIR, {})
PLAINLY = msgspec.structs.replace(CONFIG, guess=False)
"""Settings of a planner that does not guess, so that no guess is learnt from."""
HOME = load_household("apartment")
NOW = 500.0
MUG, CAN, BLOCK, BOTTLE, BOX = (
    (0.08, 0.08, 0.095), (0.066, 0.066, 0.115), (0.05, 0.05, 0.05), (0.064, 0.064, 0.21), (0.06, 0.08, 0.13),
)  # fmt: skip
BALL, APPLE, BOWL = (0.066, 0.066, 0.066), (0.072, 0.072, 0.072), (0.14, 0.14, 0.06)


def _object(
    label: str, on: str, x: float, y: float, z: float, size: tuple[float, float, float], names: str = "", text: str = ""
) -> WorldObject:
    colour, kind = ("red", "apple") if label == "apple" else label.split()
    return WorldObject(
        label=label, kind=kind, colour=colour, position=(x, y, z + size[2] / 2), size=size, on=on,
        seen_at=NOW - 60.0, names=[names] if names else [], text=text, colours=[colour],
    )  # fmt: skip


FLAT = [
    _object("red mug", "living table", -1.9, -2.2, 0.5, MUG),
    _object("green can", "living table", -1.6, -2.3, 0.5, CAN),
    _object("white box", "living table", -1.1, -2.3, 0.5, BOX), _object("blue mug", "counter", 3.8, -3.1, 0.76, MUG),
    _object("red can", "counter", 4.2, -3.1, 0.76, CAN), _object("yellow bowl", "counter", 4.7, -3.1, 0.76, BOWL),
    _object("blue bottle", "counter", 5.1, -3.1, 0.76, BOTTLE),
    _object("apple", "kitchen table", 5.0, -0.7, 0.72, APPLE),
    _object("yellow block", "kitchen table", 5.4, -0.7, 0.72, BLOCK),
    _object("white mug", "desk", -2.6, 2.7, 0.72, MUG),
    _object("orange box", "desk", -2.6, 3.2, 0.72, BOX, names="vitamin box"),
    _object("red ball", "bookshelf", 1.2, 1.74, 0.7, BALL),
    _object("blue block", "bookshelf", 1.7, 1.74, 0.7, (0.04, 0.04, 0.04)),
    _object("green bottle", "bedside table", 4.7, 4.18, 0.55, BOTTLE),
    _object("white can", "dresser", 6.7, 1.5, 0.74, CAN, text="TOMATO SOUP"),
    _object("white bottle", "dresser", 6.7, 2.0, 0.74, (0.07, 0.07, 0.26)),
]  # fmt: skip
"""The flat that the head of sentences.tsv describes."""


class Sentence(NamedTuple):
    context: str
    said: str
    right: str


def lists(path: Path = DATA) -> dict[str, list[Sentence]]:
    """The rows of tests/data/sentences.tsv, or of another such file, by the number of their list."""
    found: dict[str, list[Sentence]] = {}
    for line in path.read_text(encoding="utf-8").splitlines():
        if line and not line.startswith("#"):
            number, *row = line.split("\t")
            found.setdefault(number, []).append(Sentence(*row))
    return found


def all_lists() -> dict[str, list[Sentence]]:
    """The lists that are tested, and those that are only learnt from."""
    return {**lists(), **lists(LEARNING)}


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
            if said.kind in _BEFORE:
                return planned(said.text, FLAT, "", after(_BEFORE[said.kind], about)[2])._replace(kind=said.kind)
            return Understood(said.kind, [], [])
    return planned(sentence.said, *after(tag, about))


_BEFORE: dict[str, str] = {"queue": "last", "replace": "instead"}
"""Context in which something is planned that was said for later, or instead of what was under way."""


def at_rest(sentence: Sentence) -> Sentence:
    """What was said to a robot at work as the planner gets it, with the readings that are for then; others as it is."""
    tag, _, about = sentence.context.partition(":")
    said = interjection(sentence.said, about) if tag == "busy" else None
    if said is None or said.kind not in _BEFORE:
        return sentence
    readings = [r.strip().removeprefix(f"{said.kind}: ") for r in sentence.right.split("||") if said.kind in r]
    return Sentence(f"{_BEFORE[said.kind]}:{about}", said.text, "||".join(readings)) if readings else sentence


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


# --- right or wrong
def verdict(sentence: Sentence, found: Understood) -> Verdict:
    """Whether what was understood is one of the readings that are right."""
    if any(_fits(reading.strip(), sentence, found) for reading in sentence.right.split("||")):
        return "right"
    acts = [s for s in found.steps if s.action != "say"]
    if (
        "none()" in sentence.right
        and not acts
        and not found.looks
        and found.kind in ("", "no", "queue", "encouragement", "idle")
    ):
        return "right"
    if sentence.right == "none()" and found.kind in ("cancel", "stop"):
        return "right"
    if found.asks and _after_a_yes(sentence, found):
        return "asked rightly"
    if found.asks or (not acts and not found.kind and re.search(r"which|do you mean", found.reason)):
        return "asked back"
    heard = not found.kind or f"{found.kind}: " in sentence.right  # a command for later or instead, as it should be
    if not acts and heard:
        return "wrong" if found.steps and "answer" not in sentence.right else "not understood"
    return "wrong"


def _after_a_yes(sentence: Sentence, found: Understood) -> bool:
    """Does what was asked about come to the right plan?"""
    tag, _, about = sentence.context.partition(":")
    meant = planned(found.asks, *after(_BEFORE.get(found.kind, tag), about))
    return verdict(sentence, meant._replace(kind=found.kind)) == "right"


def _fits(reading: str, sentence: Sentence, found: Understood) -> bool:
    kind, colon, rest = reading.partition(": ")
    if colon and kind in ("queue", "replace"):
        return found.kind == kind and _fits(rest, sentence, found._replace(kind=""))
    if reading == "yes()" and sentence.context.startswith("heard:") and found.steps:  # the same in other words
        return found.steps == planned(sentence.context.removeprefix("heard:"), FLAT, "", History()).steps
    if reading in ("stop()", "pause()", "yes()", "no()"):
        stops = ("stop", "cancel")
        return found.kind in {"stop()": stops, "pause()": stops, "yes()": ("yes",), "no()": ("no", "cancel")}[reading]
    if found.looks and found.steps and _left(reading, found):
        return True
    if choice := re.fullmatch(r"pick\(([^()]+)\)", reading):
        return found.kind in [f"pick {label}" for label in choice[1].split("/")]
    if reading == "return()" and found.kind == "come_back":
        return True
    if found.kind or not found.steps:
        if untold := re.fullmatch(r"norule\(([^)]+)\)", reading):
            return f"no rule about {untold[1]}" in found.reason
        return reading == "refuse()" and found.kind in ("", "queue")
    groups = [_wanted(group) for group in reading.split(";")]
    wanted = tuple(act for group in groups for act in group)
    answers = all(name in ("answer", "say") for name, _ in wanted)
    plans = [[*found.looks, *found.steps], found.steps]
    tag, _, about = sentence.context.partition(":")
    held = after(tag, about)[1]
    done = [_acts(plan, held) for plan in plans]
    done += [_acts(plan, held, looks=False) for plan in ([] if answers else plans)]
    if len(wanted) <= _FEW:
        orders = [tuple(chain(*order)) for order in product(*(permutations(group) for group in groups))]
    else:
        orders = [_aligned(groups, acts) for acts in done]
    return any(_same(order, acts) for order in orders for acts in done)


def _left(reading: str, found: Understood) -> bool:
    """Was a thing that the flat has not looked for, as a condition asks, and then nothing done?"""
    absent = {args.split(",")[0] for _, args in re.findall(r"(fetch|put|take)\(([^)]*)\)", reading)} - {
        o.label for o in FLAT
    }
    said = {
        name
        for s in found.steps
        for name in re.findall(r"^I see no (.+?)(?: (?:on|in) the .+)?, so I leave it", s.text)
    }
    return bool(said) and said <= absent and all(s.action == "say" for s in found.steps)


_FEW = 4
"""Most acts whose orders are all tried (chosen: bounds the time)."""


def _wanted(group: str) -> list[tuple[str, str]]:
    """The acts of a reading that may be done in any order, tidying as what is to be moved."""
    acts = re.findall(r"(\w+)\(([^)]*)\)", group)
    return [act for name, args in acts for act in (_tidied(args) if name == "tidy" else [(name, args)])]


def _aligned(groups: list[list[tuple[str, str]]], acts: list[tuple[str, ...]]) -> tuple[tuple[str, str], ...]:
    """The wanted acts group by group, in the order of what was done as far as they can be found there."""
    groups, found = [list(group) for group in groups], []
    for act in acts:
        left = next(filter(None, groups), [])
        match = next((w for w in left if _same((w,), [act])), None)
        if match is not None:
            left.remove(match)
            found.append(match)
    return (*found, *chain(*groups))


def _tidied(surface: str) -> list[tuple[str, str]]:
    """Everything on a surface where the rules of the configuration say, worked out without the grammar."""
    moved = []
    for o in (o for o in FLAT if o.on == surface):
        rule = next(r for r in HOME.words.tidy if not r.kinds or o.kind in r.kinds)
        target = next(r for name in rule.to for r in HOME.receptacles if name in (r.name, *r.aliases, r.kind))
        if target.name != surface:
            moved.append(("put", f"{o.label}, {target.name}"))
    return moved or [("answer", "tidy")]


def _acts(steps: list[PlanStep], held: str = "", looks: bool = True) -> list[tuple[str, ...]]:
    """Steps as acts of the notation; without `looks`, going somewhere before a search is a part of the search."""
    found: list[tuple[str, ...]] = []
    text: dict[str, str] = {}
    for at, step in enumerate(steps):
        following = steps[at + 1].action if at + 1 < len(steps) else ""
        match step.action:
            case "find":
                text[step.object] = step.text
                found.append(("find", step.object, step.text))
            case "grasp" if step.hand_alone:
                found.append(("grip", "close"))
            case "release" if step.hand_alone:
                found.append(("grip", "open"))
            case "grasp":
                found = [a for a in found if a[:2] != ("find", step.object)]
                found.append(("take", step.object, text.get(step.object, "")))
                held = step.object
            case "place":
                found = [a for a in found if a[:2] not in (("take", held), ("find", step.near))]
                where = f"{step.target} near {step.near}" if step.near else step.target
                found.append(("put", step.object or held, where, text.get(held, "")))
            case "return":
                found.append(("return",))
            case "release":
                before = found.pop() if found and found[-1][0] in ("return", "goto") else ("",)
                found = [a for a in found if a[:2] != ("take", held)]
                found.append(_released(before, held or step.object, text.get(held, "")))
            case "navigate":
                if step.target == "around":
                    found.append(("look",))
                elif looks or following not in ("find", "place"):
                    found.append(("goto", step.target or step.object))
            case _:
                found += _said_or_kept(step)
    return found


def _released(before: tuple[str, ...], held: str, text: str) -> tuple[str, ...]:
    """Letting go after an act, as one with it."""
    match before[0]:
        case "return":
            return "fetch", held, text
        case "goto":
            return "put", held, before[1], text
    return ("drop",)


def _said_or_kept(step: PlanStep) -> list[tuple[str, ...]]:
    """A step that moves nothing."""
    match step.action:
        case "wait":
            return [("wait", f"{step.seconds:g}")] if step.seconds else []
        case "name":
            return [("place", step.text)]
        case "rule":
            return [("rule", step.object.removesuffix("s"), step.target)]
        case "forget":
            return [("norule" if step.target == "rule" else "forget", step.text)]
        case "say" | "teach":
            return [(step.action, step.text)]
    return []


def _same(wanted: tuple[tuple[str, str], ...], acts: list[tuple[str, ...]]) -> bool:
    acts = [a for a in acts if a[0] != "say"] if all(n not in ("say", "answer") for n, _ in wanted) else acts
    acts = _by_room(acts, {args for name, args in wanted if name == "goto"})
    said = " ".join(a[1] for a in acts if a[0] == "say").lower()
    if any(n == "answer" for n, _ in wanted):  # an answer may be several sentences
        acts = [a for a in acts if a[0] != "say"] + [("say", said)]
    if [n for n, _ in wanted if n == "look"] and any(a[0] == "say" for a in acts):
        acts = [a for a in acts if a[0] != "say"]
    return len(wanted) == len(acts) and all(_one(n, args, a) for (n, args), a in zip(wanted, acts, strict=True))


def _by_room(acts: list[tuple[str, ...]], rooms: set[str]) -> list[tuple[str, ...]]:
    """Going to one surface of a wanted room after the other is going to the room."""
    found: list[tuple[str, ...]] = []
    for act in acts:
        receptacle = HOME.receptacle(act[1]) if act[0] == "goto" else None
        room = HOME.room_at(*receptacle.center[:2]) if receptacle else None
        act = ("goto", room.name) if room is not None and room.name in rooms else act
        found += [] if found and act[0] == "goto" and found[-1] == act else [act]
    return found


def _one(name: str, args: str, act: tuple[str, ...]) -> bool:
    first, _, second = args.partition(", ")
    match name:
        case "answer":
            said = act[1].lower() if act[0] == "say" else ""
            return bool(said) and all(any(w.lower() in said for w in part.split("|")) for part in args.split(", "))
        case "say":
            return act[0] == "say" and _bare(act[1]) == _bare(first)
        case "put":
            return act[0] == "put" and _named(first, act[1], act[3]) and act[2] in second.split("/")
        case "fetch" | "take" | "find":
            return act[0] == name and _named(first, act[1], act[2])
        case "drop" | "return" | "look":
            return act[0] == name
        case "wait" | "goto" | "grip" | "teach" | "forget" | "place" | "norule":
            return act[:2] == (name, first.lower())
        case "rule":
            return act == (name, first.removesuffix("s"), second)
        case _:
            return False


def _bare(text: str) -> str:
    """Words that are said, in full."""
    return expand(normalise(text.lower().replace("\u2019", "'")))


def _named(options: str, label: str, words: str) -> bool:
    """Is the object, or the description handed on with it, one of the options?"""
    return bool({label, words} & set(options.split("/")))
