"""The VLA pipeline as a tree: listen, confirm, plan, then the plan's steps, each with its recoveries, then report."""

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from services.brain.mission.context import Context
from services.brain.pipelines.plan_steps import RunPlan
from services.brain.pipelines.shared import report_failure
from services.brain.steps.ask import AskQuestion, HearConfirmation, HearMeaning, HearPerson, meaning, question
from services.brain.steps.begin import Ready
from services.brain.steps.leaf import Say, Settle
from services.brain.steps.plan import (
    AwaitCommand,
    ChooseTranscription,
    CompleteWithEvidence,
    PlanIsComplete,
    RequestPlan,
)
from services.brain.tree.composites import Condition, Retry, Selector, Sequence

LOOKS = 4
"""Times that a plan may only go and look (chosen: a planner that asks for more will never plan)."""


def vla_tree(ctx: Context) -> Behaviour:
    """Each round is one command; ticked for ever."""
    do = Sequence(
        "do",
        confirm(ctx),
        plan(ctx),
        Condition("look_first", look_first(ctx), lambda: ctx.mission.planning.look_again),
        RunPlan("execute", ctx),
        CompleteWithEvidence("complete", ctx, lambda: "; ".join(step.words for step in ctx.mission.planning.steps)),
        Say("report_success", ctx, lambda: success(ctx)),
        Settle("settle", ctx),
    )
    return Sequence(
        "vla_pipeline",
        Ready("ready", ctx),
        AwaitCommand("listen", ctx),
        Selector("mission", ask_person(ctx), do, report_failure(ctx)),
    )


def ask_person(ctx: Context) -> Behaviour:
    """A client's question: say it, hear the answer; FAILURE for what is a command."""
    ask = Sequence(
        "ask_person",
        AskQuestion("put_question", ctx, lambda: ctx.mission.command),
        HearPerson("hear_person", ctx),
        Settle("settle_answer", ctx),
    )
    asked = Selector("question_answered", ask, report_failure(ctx))
    return Condition("if_question", asked, lambda: ctx.mission.heard.question, otherwise=Status.FAILURE)


def success(ctx: Context) -> str:
    """What may be claimed at the end: no more than was seen; an answer needs no "done"."""
    if all(step.action == "say" for step in ctx.mission.planning.steps):
        return ""
    items = " and the ".join(dict.fromkeys(ctx.mission.delivery.unchecked))
    return f"I put down the {items}, but I could not check where it is." if items else "Done."


def needs_confirmation(ctx: Context) -> bool:
    """Nobody vouches for the words, and people want to be asked or the words are uncertain."""
    mission, config = ctx.mission, ctx.config
    return not mission.heard.confirmed and (
        config.enable_confirmation or mission.heard.confidence < config.confirm_below
    )


def confirm(ctx: Context) -> Behaviour:
    """Choose what was heard, and if need be ask, hear yes, no or a correction; after no, ask for the command again."""
    choose = Condition("which_heard", ChooseTranscription("choose", ctx), lambda: bool(ctx.mission.heard.alternatives))
    ask = Sequence(
        "ask",
        AskQuestion("question", ctx, lambda: question(ctx)),
        HearConfirmation("hear_reply", ctx),
    )
    rounds = 2 * ctx.config.max_retry_attempts - 1
    confirmed = Retry("until_confirmed", ctx, ask, rounds, again=lambda: not ctx.mission.failed_for_good)
    return Sequence("confirm", choose, Condition("if_doubtful", confirmed, lambda: needs_confirmation(ctx)))


def plan(ctx: Context) -> Behaviour:
    """Ask for a plan until one can be carried out; of a command that is only guessed the person is asked first."""
    guessed = Sequence(
        "ask_what_was_meant",
        AskQuestion("meaning", ctx, lambda: meaning(ctx)),
        HearMeaning("hear_meaning", ctx),
        _plan_until_valid(ctx),
    )
    asked = Condition("guess", guessed, lambda: bool(ctx.mission.planning.suggestion), otherwise=Status.FAILURE)
    return Selector("plan_and_validate", _plan_until_valid(ctx), asked)


def _plan_until_valid(ctx: Context) -> Behaviour:
    retries = ctx.config.max_retry_attempts - 1
    request = RequestPlan("plan", ctx)
    return Retry("plan_until_valid", ctx, request, retries, again=lambda: not ctx.mission.failed_for_good)


def look_first(ctx: Context) -> Behaviour:
    """A plan that only goes and looks is carried out, and the command planned anew with what was seen."""
    looked = Sequence("look", RunPlan("go_and_look", ctx), plan(ctx), PlanIsComplete("seen_enough", ctx))
    return Retry("look_and_plan", ctx, looked, LOOKS - 1, again=lambda: sees_more(ctx))


def sees_more(ctx: Context) -> bool:
    """The plan still only goes and looks, and nothing forbids to go on."""
    return ctx.mission.planning.look_again and not ctx.mission.failed_for_good
