"""The fetch pipeline as a tree: hear, go, grab, return, release, and what happens when one of them fails."""

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from common import messages as m
from common import topics
from common.naming.likeness import LEAST
from services.brain.home.told import edit_told
from services.brain.language.intent import parse
from services.brain.mission.context import Context
from services.brain.mission.mission import gripper_holds
from services.brain.pipelines.shared import drive_home, report_failure
from services.brain.recoveries.regrasp import grab_failed
from services.brain.steps.begin import Listen, Ready, Wait
from services.brain.steps.find import reference_to
from services.brain.steps.home import tell_home
from services.brain.steps.identify import ask_identity, candidates, survey
from services.brain.steps.leaf import Call, Leaf, Settle
from services.brain.steps.motion import Grab, Navigate, Release
from services.brain.steps.verify import is_misplaced, verify_placement, with_care
from services.brain.tree.composites import Condition, Retry, Selector, Sequence


def fetch_tree(ctx: Context) -> Behaviour:
    """The system flow; ticked for ever, each round is one listening and at most one mission."""
    wait = Wait("wait", ctx, ends=lambda: ctx.now >= ctx.voice.listen_after)
    return Sequence(
        "fetch_pipeline",
        Ready("ready", ctx),
        wait,
        Listen("listen", ctx),
        Selector("mission", Sequence("do", ParseCommand("understand", ctx), carry_out(ctx)), report_failure(ctx)),
    )


def carry_out(ctx: Context) -> Behaviour:
    """From the parsed command to COMPLETED."""
    fetching = Sequence(
        "fetch",
        Condition("free_the_hand", put_down_at_home(ctx), lambda: holds_another(ctx)),
        Retry("until_it_is_right", ctx, deliver(ctx), ctx.config.put_right_attempts, again=lambda: is_misplaced(ctx)),
        Complete("complete", ctx),
        Settle("settle", ctx),
    )
    coming = Sequence(
        "come_back", drive_home(ctx), Settle("settle", ctx), Complete("complete", ctx), Settle("rest", ctx)
    )
    telling = Sequence(
        "tell",
        tell_home(ctx, lambda: told(ctx), "keep_and_say", "keep what was told"),
        Complete("complete", ctx),
        Settle("rest", ctx),
    )
    no = Status.FAILURE
    return Selector(
        "as_asked",
        Condition(
            "nothing_to_stop", Call("end", ctx, lambda: end_unneeded(ctx)), lambda: ctx.mission.task.kind == "stop", no
        ),
        Condition("keep_what_was_told", telling, lambda: ctx.mission.task.kind == "tell", no),
        Condition("return_only", coming, lambda: ctx.mission.task.kind == "return", no),
        Condition("fetch_it", fetching, lambda: ctx.mission.task.kind == "fetch", no),
    )


def deliver(ctx: Context) -> Behaviour:
    """Get it, bring it, put it down; where perception is alive, look whether it stands there."""
    look = Sequence("look", Settle("settle", ctx), verify_placement(ctx, ctx.io.household.delivery))
    return Sequence(
        "deliver",
        Condition("get_it", acquire(ctx), lambda: not ctx.gripper.holding and not ctx.mission.delivery.released),
        Condition("deliver_it", bring_home(ctx), lambda: not ctx.mission.delivery.released),
        Condition("check_it", look, lambda: ctx.io.peer("perception") is not None),
    )


def acquire(ctx: Context) -> Behaviour:
    """Drive up and grab; a failed grab drives up again."""
    find = Navigate(
        "reach_it",
        ctx,
        text=lambda: f"find {ctx.mission.task.item}",
        spoken=lambda: f"I could not reach the {ctx.mission.task.item}.",
        state="NAVIGATING",
    )
    grab = Grab("grab", ctx, lambda: ctx.mission.task.label, lambda: object_ref(ctx))
    question = ask_identity(ctx, lambda: ctx.mission.task.item, lambda: candidates(ctx, LEAST))
    asked = Condition("identify", question, lambda: survey(ctx, ctx.mission.task.item))
    once = Sequence("approach_and_grab", find, Settle("settle", ctx), asked, grab, Settle("settle", ctx))
    return Retry("acquire", ctx, once, ctx.config.grab_retries, again=lambda: grab_failed(ctx))


def bring_home(ctx: Context) -> Behaviour:
    """Drive home and let go."""
    return Sequence("bring_home", drive_home(ctx, carrying=True), Settle("settle", ctx), Release("release_it", ctx))


def put_down_at_home(ctx: Context) -> Behaviour:
    """Frees a hand that an earlier mission left full, before anything else is fetched."""
    down = bring_home(ctx)
    return Sequence("put_down_at_home", down, Settle("settle", ctx), Call("forget", ctx, lambda: forget_release(ctx)))


class ParseCommand(Leaf):
    """The command as an intent, and whether the hand is really empty."""

    def update(self) -> Status:
        ctx = self.ctx
        ctx.gripper.resolve_uncertainty(gripper_holds(ctx.io.latest(topics.JOINT_STATES)))
        if edit_told(ctx.mission.command, ctx.io.household) is not None:
            ctx.mission.task.kind = self.feedback_message = "tell"
            ctx.note("understood: tell", ctx.mission.command, "planned")
            return Status.SUCCESS
        intent = parse(ctx.mission.command, ctx.io.household)
        ctx.note(f"understood: {intent.kind}", intent.item or intent.reason, "planned")
        if intent.kind == "none":
            return ctx.fail("UNDERSTANDING", "NOT_UNDERSTOOD", spoken=intent.reason)
        ctx.mission.task.kind = "stop" if intent.kind == "cancel" else intent.kind
        ctx.mission.task.item, ctx.mission.task.label = intent.item, intent.label
        if intent.label and ctx.gripper.holding == intent.label:
            ctx.mission.delivery.grabbed = True
            ctx.note("already in the hand", intent.label)
        self.feedback_message = f"{intent.kind} {intent.item}".strip()
        return Status.SUCCESS


class Complete(Leaf):
    """COMPLETED, only on the evidence that the kind of mission needs."""

    def update(self) -> Status:
        ctx, task, done = self.ctx, self.ctx.mission.task, self.ctx.mission.delivery
        if task.kind == "fetch" and not (done.grabbed and done.released and not ctx.gripper.holding):
            return ctx.fail("COMPLETED", "NO_EVIDENCE", spoken=f"I am not sure that I brought the {task.item}.")
        if not with_care(ctx):
            return Status.FAILURE
        did = {"fetch": "", "tell": "kept what was told"}.get(task.kind, "back at the start")
        ctx.end_mission("delivered", did)
        ctx.show_state("COMPLETED", detail=f"{task.item} delivered" if task.item else did)
        return Status.SUCCESS


def told(ctx: Context) -> m.HouseholdEdit:
    """What the command tells of the home."""
    return edit_told(ctx.mission.command, ctx.io.household) or m.HouseholdEdit()


def end_unneeded(ctx: Context) -> None:
    """End a mission that asked to stop when nothing was going on."""
    ctx.end_mission("cancelled", "there was nothing to stop")


def holds_another(ctx: Context) -> bool:
    """The hand holds something else than what is asked for."""
    return bool(ctx.gripper.holding) and ctx.gripper.holding != ctx.mission.task.label


def forget_release(ctx: Context) -> None:
    """What was put down was not what is asked for."""
    ctx.mission.delivery.released = False


def object_ref(ctx: Context) -> m.ObjectRef | None:
    """Which object to grab, as last reported; none if the robot itself has moved it since."""
    task = ctx.mission.task
    meant = ctx.mission.search.confirmed.get(task.item)
    known = ctx.known_object(task.label)
    if meant is not None:
        known = next((o for o in ctx.objects if o.id == meant), None)
    if known is None or known.seen_at <= ctx.gripper.put_down.get(known.label, -1.0):
        return None
    return reference_to(known)
