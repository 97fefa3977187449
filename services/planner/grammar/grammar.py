"""The embedded planner: a sentence and the believed world in, a plan or the reason against it out. Pure."""

from collections.abc import Sequence

from common.language.addressee import addressee
from common.language.discourse import commands
from common.language.lexicon import COMMANDING
from common.language.normalise import enumeration
from common.messages import SENSELESS, ActionPlan, PlanStep, RejectedPlan
from services.planner.choice_points import ChoicePoints, every
from services.planner.config import PlannerConfig
from services.planner.grammar.accounting import CONDITIONS, as_command, unaccounted
from services.planner.grammar.attempts import Attempts, Suggestion
from services.planner.grammar.guess import Guess, contradicted
from services.planner.grammar.sentences import MAX_CHARACTERS
from services.planner.grammar.vocabulary import Vocabulary
from services.planner.plan_builder import LookFirst, Refusal, same
from services.planner.semantic.forms import tokens
from services.planner.world import World

SOURCE = "grammar"


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
    literally = any(not r.steps for r in rejected)
    clauses = commands(command[:MAX_CHARACTERS], lambda words: bool(vocabulary.spot(words)))
    other = addressee(command[:MAX_CHARACTERS], lambda name: not (vocabulary.noun(name) or vocabulary.spot((name,))))

    def run(choices: ChoicePoints) -> ActionPlan:
        attempts = Attempts(command, world, vocabulary, config, choices, None if other else done)
        try:
            steps = attempts.steps(literally)
        except LookFirst as look:
            return ActionPlan(request_id=request_id, steps=look.steps, source=SOURCE, again=True)
        except Refusal as refusal:
            meant = refusal.meant if isinstance(refusal, Suggestion) else ""
            return ActionPlan(request_id=request_id, steps=[], source=SOURCE, detail=str(refusal), suggestion=meant)
        if len(steps) > config.max_steps:
            detail = f"that is too much at once: {len(steps)} steps"
            return ActionPlan(request_id=request_id, steps=[], source=SOURCE, detail=detail)
        if other and not literally and any(step.action != "say" for step in steps):
            detail, meant = f"you said that to {other}", as_command(steps, world)
            return ActionPlan(request_id=request_id, steps=[], source=SOURCE, detail=detail, suggestion=meant)
        detail = _ignored(clauses, steps, world, vocabulary)
        likely = attempts.likeliest() if config.guess and not rejected else None
        if likely and unaccounted(clauses, likely.steps, world, vocabulary):
            likely = None
        detail = detail or (_unlikely(clauses, steps, likely, world) if likely else "")
        if not detail:
            return ActionPlan(request_id=request_id, steps=steps, source=SOURCE)
        asked = likely.steps if likely and not likely.answers else steps
        meant = "" if literally else as_command(asked, world)
        if likely and asked is likely.steps and not literally:
            meant = meant or ", then ".join(likely.texts)
        if meant and attempts.is_said(meant):
            return ActionPlan(request_id=request_id, steps=asked, source=SOURCE)
        return ActionPlan(request_id=request_id, steps=[], source=SOURCE, detail=detail, suggestion=meant)

    if not rejected:
        return run(ChoicePoints())
    culprits = [c for r in rejected if (c := _culprit(r)) is not None]
    second: ActionPlan | None = None
    for candidate in every(run):
        if not candidate.steps or any(same(candidate.steps, r.steps) for r in rejected):
            continue
        if not any(c in candidate.steps for c in culprits):
            return candidate
        second = second or candidate
    return second or _spent(run(ChoicePoints()), rejected[-1])


def _ignored(clauses: Sequence[str], steps: list[PlanStep], world: World, vocabulary: Vocabulary) -> str:
    """What of the clauses a plan leaves aside, so that it is asked about first; "" where it is nothing."""
    ignored = unaccounted(clauses, steps, world, vocabulary)
    return f"{SENSELESS} what {enumeration(list(map(repr, ignored)))} has to do with it" if ignored else ""


def _unlikely(clauses: Sequence[str], steps: Sequence[PlanStep], likely: Guess, world: World) -> str:
    """Why a plan may not be what is meant, so that it is asked about first; "" for no reason."""
    if any(clause.split()[0] in CONDITIONS for clause in clauses):  # what else is to be done need not be
        return ""
    words = tokens(" ".join(clauses))
    if world.history.last is not None and COMMANDING.isdisjoint(words):  # the guess does not know what it goes on with
        return ""
    known = {thing.label for thing in (*world.objects, *world.specs)}
    return f"{SENSELESS} for certain what I should do" if contradicted(words, steps, likely, known) else ""


def _spent(first: ActionPlan, rejected: RejectedPlan) -> ActionPlan:
    """No other plan: the reason against the last one, or why there never was one."""
    reason = rejected.reason.strip().rstrip(".") or "that plan was rejected and I know no other"
    detail = reason if first.steps or not first.detail else first.detail
    return ActionPlan(request_id=first.request_id, steps=[], source=SOURCE, detail=detail)


def _culprit(rejected: RejectedPlan) -> PlanStep | None:
    """The step that the reason is about."""
    return rejected.steps[rejected.step - 1] if 0 < rejected.step <= len(rejected.steps) else None
