"""The fetch pipeline as a tree: hear, go, grab, return, release, and what happens when one of them fails."""

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.composites import Selector, Sequence

from common import messages as m
from common import topics
from services.brain.behaviours import Do, Leaf, Say, Settle
from services.brain.check import astray, checked
from services.brain.context import Context
from services.brain.decorators import Attempts, When
from services.brain.intent import parse
from services.brain.mission import Failure, fingers_hold
from services.brain.robot import Drive, Grab, Listen, Ready, Release, Wait


def sequence(name: str, *children: Behaviour) -> Sequence:
    return Sequence(name=name, memory=True, children=list(children))


def first_of(name: str, *children: Behaviour) -> Selector:
    return Selector(name=name, memory=True, children=list(children))


def fetch_tree(ctx: Context) -> Behaviour:
    """The system flow; ticked for ever, each round is one listening and at most one mission."""
    wait = Wait("wait", ctx, ends=lambda: ctx.now >= ctx.listen_after)
    return sequence(
        "fetch pipeline",
        Ready("ready", ctx),
        wait,
        Listen("listen", ctx),
        first_of("mission", sequence("do", Understand("understand", ctx), carry_out(ctx)), report_failure(ctx)),
    )


def carry_out(ctx: Context) -> Behaviour:
    """From the parsed command to COMPLETED."""
    fetching = sequence(
        "fetch",
        When("free the hand", put_down_at_home(ctx), lambda: holds_another(ctx)),
        Attempts("until it is right", ctx, deliver(ctx), ctx.config.put_right_attempts, again=lambda: astray(ctx)),
        Complete("complete", ctx),
        Settle("settle", ctx),
    )
    coming = sequence(
        "come back", drive_home(ctx), Settle("settle", ctx), Complete("complete", ctx), Settle("rest", ctx)
    )
    no = Status.FAILURE
    return first_of(
        "as asked",
        When("nothing to stop", Do("end", ctx, lambda: end_unneeded(ctx)), lambda: ctx.mission.kind == "stop", no),
        When("return only", coming, lambda: ctx.mission.kind == "return", no),
        When("fetch it", fetching, lambda: ctx.mission.kind == "fetch", no),
    )


def deliver(ctx: Context) -> Behaviour:
    """Get it, bring it, put it down; where perception is alive, look whether it stands there."""
    look = sequence("look", Settle("settle", ctx), checked(ctx, ctx.io.scene.delivery))
    return sequence(
        "deliver",
        When("get it", acquire(ctx), lambda: not ctx.hand.holding and not ctx.mission.released),
        When("deliver it", bring_home(ctx), lambda: not ctx.mission.released),
        When("check it", look, lambda: ctx.io.peer("perception") is not None),
    )


def acquire(ctx: Context) -> Behaviour:
    """Drive up and grab; a failed grab drives up again."""
    find = Drive(
        "reach it",
        ctx,
        text=lambda: f"find {ctx.mission.item}",
        spoken=lambda: f"I could not reach the {ctx.mission.item}.",
        state="NAVIGATING",
    )
    grab = Grab("grab it", ctx, lambda: ctx.mission.label, lambda: object_ref(ctx))
    once = sequence("approach and grab", find, Settle("settle", ctx), grab, Settle("settle", ctx))
    return Attempts("acquire", ctx, once, ctx.config.grab_retries, again=lambda: grab_failed(ctx))


def bring_home(ctx: Context) -> Behaviour:
    return sequence("bring home", drive_home(ctx), Settle("settle", ctx), Release("release it", ctx))


def put_down_at_home(ctx: Context) -> Behaviour:
    """Frees a hand that an earlier mission left full, before anything else is fetched."""
    down = bring_home(ctx)
    return sequence("put down at home", down, Settle("settle", ctx), Do("forget", ctx, lambda: forget_release(ctx)))


def drive_home(ctx: Context) -> Behaviour:
    return Drive(
        "return",
        ctx,
        text=lambda: "return_to_start",
        spoken=lambda: "I could not come back" + (f" with the {ctx.hand.holding}." if ctx.hand.holding else "."),
        state="RETURNING",
        place=ctx.io.scene.home.name,
    )


def report_failure(ctx: Context) -> Behaviour:
    """ERROR with a published and a spoken reason; never fails and never hangs. What a person called off is no error."""
    return sequence(
        "report failure",
        Do("error", ctx, lambda: enter_error(ctx)),
        Say("say why", ctx, lambda: spoken_reason(ctx)),
    )


class Understand(Leaf):
    """The command as an intent, and whether the hand is really empty."""

    def update(self) -> Status:
        ctx = self.ctx
        ctx.hand.look(fingers_hold(ctx.io.latest(topics.JOINT_STATES)))
        intent = parse(ctx.mission.command, ctx.io.scene)
        ctx.note(f"understood: {intent.kind}", intent.item or intent.reason, "planned")
        if intent.kind == "none":
            ctx.fail(Failure("UNDERSTANDING", "NOT_UNDERSTOOD", spoken=intent.reason))
            return Status.FAILURE
        ctx.mission.kind = "stop" if intent.kind == "cancel" else intent.kind
        ctx.mission.item, ctx.mission.label = intent.item, intent.label
        if intent.label and ctx.hand.holding == intent.label:
            ctx.mission.grabbed = True
            ctx.note("already in the hand", intent.label)
        self.feedback_message = f"{intent.kind} {intent.item}".strip()
        return Status.SUCCESS


class Complete(Leaf):
    """COMPLETED, only on the evidence that the kind of mission needs."""

    def update(self) -> Status:
        ctx, mission = self.ctx, self.ctx.mission
        if mission.kind == "fetch" and not (mission.grabbed and mission.released and not ctx.hand.holding):
            ctx.fail(Failure("COMPLETED", "NO_EVIDENCE", spoken=f"I am not sure that I brought the {mission.item}."))
            return Status.FAILURE
        ctx.finish("delivered", "" if mission.kind == "fetch" else "back at the start")
        ctx.enter("COMPLETED", detail=f"{mission.item} delivered" if mission.item else "back at the start")
        return Status.SUCCESS


def end_unneeded(ctx: Context) -> None:
    ctx.finish("cancelled", "there was nothing to stop")


def holds_another(ctx: Context) -> bool:
    return bool(ctx.hand.holding) and ctx.hand.holding != ctx.mission.label


def forget_release(ctx: Context) -> None:
    ctx.mission.released = False


def grab_failed(ctx: Context) -> bool:
    failure = ctx.mission.failure
    return failure is not None and failure.stage == "GRABBING" and not failure.permanent


def object_ref(ctx: Context) -> m.ObjectRef | None:
    """Which object to grab, as last reported; none if the robot itself has moved it since."""
    known = ctx.known_object(ctx.mission.label)
    if known is None or known.seen_at <= ctx.hand.put_down.get(known.label, -1.0):
        return None
    return m.ObjectRef(
        label=known.label, position=known.position, orientation=known.orientation, size=known.size, kind=known.kind,
        tilt=known.tilt,
    )  # fmt: skip


def enter_error(ctx: Context) -> None:
    mission = ctx.mission
    failure = mission.failure or Failure(ctx.state, "INTERNAL", spoken="Something went wrong.")
    mission.failure = failure
    reason = failure.reason
    if ctx.hand.holding or ctx.hand.uncertain:
        sure = "still" if ctx.hand.holding else "perhaps"
        reason += f"; {sure} holding the {ctx.hand.holding or ctx.hand.uncertain}"
    if failure.stage == "CONFIRMING" and failure.code == "CANCELLED":
        ctx.finish("cancelled", reason)
    else:
        ctx.finish("failed", reason)
        ctx.enter("ERROR", step=failure.stage, detail=reason)
    ctx.listen_after = ctx.now + ctx.config.settle


def spoken_reason(ctx: Context) -> str:
    failure = ctx.mission.failure
    text = failure.spoken if failure else ""
    return f"{text} I am still holding the {ctx.hand.holding}." if ctx.hand.holding else text
