"""The VLA pipeline as a tree: listen, confirm, plan, then the plan's steps, each with its fallbacks, then report."""

from collections.abc import Iterator

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.composites import Sequence

from common.messages import PlanStep
from common.plan_rules import is_destination
from services.brain.asking import HearChoice, HearReply, Question, question, which
from services.brain.behaviours import Leaf, Say, Settle
from services.brain.check import checked
from services.brain.context import Context
from services.brain.decorators import Attempts, When
from services.brain.hand import Gripper, let_go, open_hand
from services.brain.put_down import put_and_check, put_right
from services.brain.robot import Drive, Grab, Ready
from services.brain.trees import drive_home, first_of, grab_failed, report_failure, sequence
from services.brain.vla_leaves import (
    Approach,
    Await,
    Enough,
    Evidence,
    Look,
    NotFound,
    Plan,
    TakeView,
    in_words,
    label_of,
    reference,
)

# Attempt 1 turns on the spot, the others go to where more can be seen.
VIEWS = (2, 5, 9)
LOOKS = 4


def vla_tree(ctx: Context) -> Behaviour:
    """Each round is one command; ticked for ever."""
    do = sequence(
        "do",
        When("confirm", confirm(ctx), lambda: needs_confirmation(ctx)),
        plan(ctx),
        When("look first", look_first(ctx), lambda: ctx.mission.again),
        RunPlan("execute", ctx),
        Evidence("complete", ctx, lambda: "; ".join(map(in_words, ctx.mission.plan))),
        Say("report success", ctx, lambda: success(ctx)),
        Settle("settle", ctx),
    )
    return sequence(
        "vla pipeline", Ready("ready", ctx), Await("listen", ctx), first_of("mission", do, report_failure(ctx))
    )


def success(ctx: Context) -> str:
    """What may be claimed at the end: no more than was seen."""
    things = " and the ".join(dict.fromkeys(ctx.mission.unchecked))
    return f"I put down the {things}, but I could not check where it is." if things else "Done."


def needs_confirmation(ctx: Context) -> bool:
    mission, config = ctx.mission, ctx.config
    return not mission.confirmed and (config.enable_confirmation or mission.confidence < config.confirm_below)


def confirm(ctx: Context) -> Behaviour:
    """Ask, hear yes, no or a correction; after no, ask for the command again."""
    ask = sequence(
        "ask",
        Question("question", ctx, lambda: question(ctx)),
        HearReply("hear reply", ctx),
    )
    rounds = 2 * ctx.config.max_retry_attempts - 1
    return Attempts("until confirmed", ctx, ask, rounds, again=lambda: not permanent(ctx))


def plan(ctx: Context) -> Behaviour:
    retries = ctx.config.max_retry_attempts - 1
    return Attempts("plan and validate", ctx, Plan("plan", ctx), retries, again=lambda: not permanent(ctx))


def look_first(ctx: Context) -> Behaviour:
    """A plan that only goes and looks is carried out, and the command planned anew with what was seen."""
    looked = sequence("look", RunPlan("go and look", ctx), plan(ctx), Enough("seen enough", ctx))
    return Attempts("look and plan", ctx, looked, LOOKS - 1, again=lambda: ctx.mission.again and not permanent(ctx))


def permanent(ctx: Context) -> bool:
    failure = ctx.mission.failure
    return failure is not None and (failure.permanent or failure.code == "NO_PLAN")


class RunPlan(Sequence):
    """The accepted plan as a sequence, built when it starts."""

    def __init__(self, name: str, ctx: Context) -> None:
        super().__init__(name=name, memory=True)
        self._ctx = ctx

    def unfold(self) -> None:
        """Build the children; a restarted brain does so to find its place among them."""
        self.remove_all_children()
        carried, at_home = "", False
        for step in self._ctx.mission.plan:
            carried = step.object if step.action == "grasp" else carried
            if step.action in ("return", "navigate", "grasp", "place"):
                at_home = step.action == "return"
            self.add_child(step_tree(self._ctx, step, carried, at_home))

    def tick(self) -> Iterator[Behaviour]:
        if self.status != Status.RUNNING:
            self.unfold()
        yield from super().tick()


def step_tree(ctx: Context, step: PlanStep, carried: str, at_home: bool = False) -> Behaviour:
    """One step with its own recovery; the next goal comes a settle later. `carried`: what was grasped last.

    `at_home`: the plan has brought it to where things are delivered.
    """
    name = in_words(step)
    match step.action:
        case "find":
            return find(ctx, step.object)
        case "navigate":
            where = step.target or step.object
            if is_destination(where, ctx.io.scene):
                return sequence(name, go_to(ctx, where), Settle("settle", ctx))
            unseen = When("find it", find(ctx, where), lambda: where not in ctx.mission.found)
            return sequence(name, unseen, approach(ctx, where))
        case "grasp" if step.hand_alone:
            return sequence(name, Gripper("close the hand", ctx, closed=True), Settle("settle", ctx))
        case "grasp":
            return grasp(ctx, step.object)
        case "place":
            there = When("go there", go_and_settle(ctx, step.target), lambda: ctx.mission.at != step.target)
            back = go_and_settle(ctx, step.target)
            return sequence(name, there, put_down(ctx, carried, back, f"place {step.target}", step.target))
        case "release" if step.hand_alone:
            return sequence(name, open_hand(ctx), Settle("settle", ctx))
        case "release" if not carried:
            look = checked(ctx, ctx.io.scene.delivery if at_home else "")
            known = When("look", look, lambda: ctx.io.scene.object(ctx.mission.put_down) is not None)
            return sequence(name, let_go(ctx), Settle("settle", ctx), known)
        case "release":
            home = sequence("back", drive_home(ctx), Settle("settle", ctx))
            target = ctx.io.scene.delivery if at_home else ""
            return sequence(name, put_down(ctx, carried, home, "release", target))
        case "say":
            return Say(name, ctx, lambda: step.text)
        case "wait":
            return Settle(name, ctx)
        case "return":
            return sequence(name, drive_home(ctx), Stand("at home", ctx, "home"), Settle("settle", ctx))


def find(ctx: Context, thing: str) -> Behaviour:
    """Look from here, ask when several match, else search: turn, then other viewpoints."""
    tries = ctx.config.max_retry_attempts
    attempts = []
    for attempt in range(1, tries + 1):
        label = f"attempt {attempt}"
        views = VIEWS[min(attempt, len(VIEWS)) - 1]
        look = sequence(
            f"view of {label}",
            TakeView(label, ctx, attempt > 1),
            Settle("settle", ctx),
            first_of("look or ask", Look("look", ctx, thing), clarify(ctx, thing)),
        )
        attempts.append(Attempts(label, ctx, look, views - 1, again=lambda: more_to_see(ctx)))
    return first_of(
        f"perception: {thing}",
        Look("primary detection", ctx, thing),
        clarify(ctx, thing),
        When("search", first_of("search", *attempts), lambda: not permanent(ctx), Status.FAILURE),
        When("not found", NotFound("not found", ctx, thing, tries), lambda: not permanent(ctx), Status.FAILURE),
    )


def more_to_see(ctx: Context) -> bool:
    failure = ctx.mission.failure
    return not permanent(ctx) and (failure is None or failure.code != "NOTHING_NEW")


def clarify(ctx: Context, thing: str) -> Behaviour:
    """Ask which of several things was meant, and look for that one."""
    ask = sequence(
        "ask which",
        Question("which", ctx, lambda: which(ctx)),
        HearChoice("hear choice", ctx, thing),
        Look("look for the one meant", ctx, thing),
    )
    rounds = Attempts("clarify", ctx, ask, ctx.config.max_retry_attempts - 1, again=lambda: not permanent(ctx))
    return When("several match", rounds, lambda: len(ctx.mission.options) > 1, Status.FAILURE)


def approach(ctx: Context, thing: str) -> Behaviour:
    """Drive to where the arm reaches the thing."""
    drive = Approach(ctx, thing)
    return sequence(f"approach {thing}", drive, Stand("there", ctx, thing), Settle("settle", ctx))


def grasp(ctx: Context, thing: str) -> Behaviour:
    """Approach if needed and grab; after a failed grab look again, drive up again, grab again."""
    near = When("near it", approach(ctx, thing), lambda: ctx.mission.at != thing)
    grab = Grab("grab", ctx, lambda: label_of(ctx, thing), lambda: reference(ctx, thing))
    first = sequence(f"grasp {thing}", near, grab, Settle("settle", ctx))
    again = sequence(
        "look and grab again",
        find(ctx, thing),
        approach(ctx, thing),
        Grab("grab", ctx, lambda: label_of(ctx, thing), lambda: reference(ctx, thing)),
        Settle("settle", ctx),
    )
    retries = max(0, ctx.config.grab_retries - 1)
    regrasp = Attempts("regrasp", ctx, again, retries, again=lambda: grab_failed(ctx))
    if not ctx.config.grab_retries:
        return first
    return first_of(f"grasp: {thing}", first, When("grab failed", regrasp, lambda: grab_failed(ctx), Status.FAILURE))


def put_down(ctx: Context, thing: str, back: Behaviour, goal: str, target: str) -> Behaviour:
    """Carry out the `goal` that opens the hand and look; what is lost or amiss is brought `back` again."""
    if not thing:
        return put_and_check(ctx, "put down", goal, target)
    return put_right(ctx, thing, find(ctx, thing), grasp(ctx, thing), back, goal, target)


def go_to(ctx: Context, where: str) -> Behaviour:
    drive = Drive(
        "go",
        ctx,
        text=lambda: f"goto {where}",
        spoken=lambda: f"I could not get to the {where}.",
        state="NAVIGATING",
        place=where,
    )
    return sequence(f"go to {where}", drive, Stand("there", ctx, where))


def go_and_settle(ctx: Context, where: str) -> Behaviour:
    return sequence("go and settle", go_to(ctx, where), Settle("settle", ctx))


class Stand(Leaf):
    """Remembers where the robot stands."""

    def __init__(self, name: str, ctx: Context, where: str) -> None:
        super().__init__(name, ctx)
        self._where = where

    def update(self) -> Status:
        self.ctx.mission.at = self._where
        return Status.SUCCESS
