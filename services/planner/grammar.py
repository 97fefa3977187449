"""The embedded planner: a sentence and the believed world in, a plan or the reason against it out. Pure."""

from collections.abc import Sequence

from common.language.meaning import VERBS
from common.language.normalise import DETERMINERS, Words, clauses, infinitive, without_politeness
from common.language.noun_phrase import PLURAL_PRONOUNS, PRONOUNS
from common.language.simplify import simplified
from common.messages import ActionPlan, PlanStep, RejectedPlan
from services.planner import answers
from services.planner.choice_points import ChoicePoints, every
from services.planner.config import PlannerConfig
from services.planner.plan_builder import LookFirst, PlanBuilder, Refusal, same
from services.planner.rules import apply_first
from services.planner.vocabulary import Vocabulary
from services.planner.world import World

SOURCE = "grammar"
MAX_CHARACTERS = 2000
"""Longest text that is read (chosen: a minute of speech has a thousand characters)."""
MAX_WORDS = 60
"""Longest clause (chosen: the readings of a pattern grow with the square of its words)."""
MAX_EFFORT = 120
"""Most clauses tried for one text (chosen: bounds the time for long lists)."""
_THING_STARTS = DETERMINERS | PRONOUNS | PLURAL_PRONOUNS | {"all", "every", "two", "three"}


class _Failure(Exception):
    """`at`: how many words were understood before it."""

    def __init__(self, at: int, reason: str) -> None:
        super().__init__(reason)
        self.at, self.reason = at, reason


def plan(
    command: str,
    world: World,
    config: PlannerConfig,
    rejected: Sequence[RejectedPlan] = (),
    done: list[PlanStep] | None = None,
    request_id: str = "",
) -> ActionPlan:
    """The preferred plan that differs from every rejected one; without steps when there is none, with the reason."""
    vocabulary = Vocabulary(world, config)

    def run(choices: ChoicePoints) -> ActionPlan:
        builder = PlanBuilder(world.copy(), vocabulary, config, choices, done)
        try:
            steps = _steps(command, builder)
        except LookFirst as look:
            return ActionPlan(request_id=request_id, steps=look.steps, source=SOURCE, again=True)
        except Refusal as refusal:
            return ActionPlan(request_id=request_id, steps=[], source=SOURCE, detail=str(refusal))
        if len(steps) > config.max_steps:
            detail = f"that is too much at once: {len(steps)} steps"
            return ActionPlan(request_id=request_id, steps=[], source=SOURCE, detail=detail)
        return ActionPlan(request_id=request_id, steps=steps, source=SOURCE)

    if not rejected:
        return run(ChoicePoints())
    culprits = [c for r in rejected if (c := _culprit(r)) is not None]
    other: ActionPlan | None = None
    for candidate in every(run):
        if not candidate.steps or any(same(candidate.steps, r.steps) for r in rejected):
            continue
        if not any(c in candidate.steps for c in culprits):
            return candidate
        other = other or candidate
    return other or _spent(run(ChoicePoints()), rejected[-1])


def _spent(first: ActionPlan, rejected: RejectedPlan) -> ActionPlan:
    """No other plan: the reason against the last one, or why there never was one."""
    reason = rejected.reason.strip().rstrip(".") or "that plan was rejected and I know no other"
    detail = reason if first.steps or not first.detail else first.detail
    return ActionPlan(request_id=first.request_id, steps=[], source=SOURCE, detail=detail)


def _culprit(rejected: RejectedPlan) -> PlanStep | None:
    """The step that the reason is about."""
    return rejected.steps[rejected.step - 1] if 0 < rejected.step <= len(rejected.steps) else None


def _steps(command: str, builder: PlanBuilder) -> list[PlanStep]:
    sentences = clauses(command[:MAX_CHARACTERS])
    if not sentences:
        raise Refusal("I did not hear a command")
    if len(command) > MAX_CHARACTERS or any(len(s.split()) > MAX_WORDS for s in sentences):
        raise Refusal("that is too long a sentence for me")
    for number, sentence in enumerate(sentences):
        words = tuple(sentence.split())
        _whole(words, builder, alone=len(sentences) == 1, started=number > 0)
    if builder.collecting:
        raise Refusal("I can hold only one thing at a time")
    if not builder.steps:
        raise Refusal("there is nothing to do")
    if all(step.action == "find" for step in builder.steps):
        answers.found(builder)
    return builder.steps


def _whole(words: Words, builder: PlanBuilder, alone: bool, started: bool) -> None:
    """One part of the sentence: one command, or several joined by "and"."""
    try:
        _joined(words, builder, "" if not started else "bring", 0, alone)
    except _Failure as failure:
        raise Refusal(failure.reason) from None


def _joined(words: Words, builder: PlanBuilder, verb: str, at: int, alone: bool) -> None:
    """Carry out `words` as the longest command that works, followed by the rest; changes `builder` only on success."""
    cuts = [len(words), *(i for i in range(len(words) - 1, 0, -1) if words[i] == "and")]
    worst: _Failure | None = None
    for cut in cuts:
        head, rest = words[:cut], words[cut + 1 :]
        trial = builder.fork()
        try:
            _command(head, trial, verb, at, alone and not rest)
            if rest:
                _joined(rest, trial, head[0], at + cut, False)
        except _Failure as failure:
            worst = failure if worst is None or failure.at >= worst.at else worst
            continue
        builder.adopt(trial)
        return
    assert worst is not None
    raise worst


def _command(words: Words, builder: PlanBuilder, verb: str, at: int, alone: bool) -> None:
    """The first form that fits the words and can be done; else the reason of the first that fits."""
    if not words:
        raise _Failure(at, "I did not hear a command")
    words = tuple(without_politeness(" ".join(words)).split()) or words
    builder.effort[0] += 1
    if builder.effort[0] > MAX_EFFORT:
        raise Refusal("that is too long a sentence for me")
    words = (infinitive(words[0], VERBS), *words[1:])
    reason = _apply(words, builder, verb, alone)
    if (
        reason is not None
        and (simple := simplified(words)) not in ((), words)
        and _apply(simple, builder, verb, alone) is None
    ):
        return
    if reason is None:
        return
    said = " ".join(words)
    raise _Failure(at if reason else at - 1, reason or f"I do not understand {said!r}")


def _apply(words: Words, builder: PlanBuilder, verb: str, alone: bool) -> str | None:
    """As `apply_first`, for a clause that may be a name alone or lack the `verb` of the one before it."""
    reason = apply_first(words, builder, "command", "reply")
    if reason == "" and alone:
        return apply_first(words, builder, "name")
    if reason == "" and verb and _is_thing(words, builder):
        # "put the mug on the table and the can on the counter": the verb is said once.
        return apply_first((verb, *words), builder, "command", "reply")
    return reason


def _is_thing(words: Words, builder: PlanBuilder) -> bool:
    """Do the words begin like a thing's name?"""
    return words[0] in _THING_STARTS or any(builder.vocabulary.noun(w) for w in words[:3])
