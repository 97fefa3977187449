"""Whether what the robot makes of a sentence is right, by the notation of tests/data/sentences.tsv."""

import re
from itertools import chain, permutations, product
from typing import Literal

from common.language.contractions import expand
from common.language.normalise import normalise
from common.messages import History, PlanStep
from evaluation.everyday.flat import FLAT, HOME
from evaluation.everyday.sentences import Sentence
from evaluation.everyday.understanding import BEFORE, Understood, after, planned

Verdict = Literal["right", "asked rightly", "asked back", "not understood", "wrong"]


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
    meant = planned(found.asks, *after(BEFORE.get(found.kind, tag), about))
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
