"""What the brain does with the gripper itself, by `gripper_command`: the empty hand, and letting go without an arm.

Everything else that the gripper does belongs to a movement of the arm: manipulation sends the command on the brain's
behalf.
"""

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from common import messages as m
from common import topics
from common.robot.grip import OPEN_PLAY, OPENING, Grip, grip_of
from services.brain.language.dialogue import Reply
from services.brain.mission.context import Context
from services.brain.mission.mission import Failure, gripper_holds
from services.brain.steps.ask import AskQuestion, HearAnswer
from services.brain.steps.leaf import Leaf
from services.brain.steps.motion import Release
from services.brain.tree.composites import Condition, Selector, Sequence

AGAIN = 0.2
"""The command is repeated this often [s]: one that is lost costs nothing."""
PATIENCE = 3.0
"""Time for the fingers to get there [s]: twice what they need from end to end."""
REST, STILL = 0.4, 2e-4
"""Fingers whose width changed by less than STILL [m] for REST [s] stand; both as manipulation waits for a grasp."""
SOMETHING = "object"
"""The name of what a person puts between the closing fingers."""


class MoveGripper(Leaf):
    """Opens or closes the hand; SUCCESS when joint_states that came after the command show it, STUCK when none does."""

    def __init__(self, node_id: str, ctx: Context, closed: bool) -> None:
        super().__init__(node_id, ctx)
        self._closed = closed
        self._told_at = self._still_since = 0.0
        self._width = -1.0
        self._full = False

    def initialise(self) -> None:
        super().initialise()
        self._told_at, self._still_since, self._width = -AGAIN, self.since, -1.0
        self._full = in_hand(self.ctx)

    def update(self) -> Status:
        ctx = self.ctx
        ctx.show_state("GRABBING" if self._closed else "RELEASING", self.name)
        if self.elapsed - self._told_at >= AGAIN:
            self._told_at = self.elapsed
            ctx.io.publish(topics.GRIPPER_COMMAND, m.GripperCommand(position=float(self._closed)))
        grip = grip_of(ctx.io.latest(topics.JOINT_STATES))
        if grip is not None and ctx.io.age(topics.JOINT_STATES, ctx.now) < self.elapsed and self._there(grip):
            return self._done(*grip)
        if self.elapsed < PATIENCE:
            return Status.RUNNING
        where = "joint_states tell of no gripper" if grip is None else f"the fingers are {grip[0] * 1000:.0f} mm apart"
        verb = "close" if self._closed else "open"
        return ctx.fail(ctx.state, "STUCK", f"{where} after {PATIENCE:.0f} s", f"I could not {verb} my hand.")

    def _there(self, grip: Grip) -> bool:
        width = grip.width
        if abs(width - self._width) > STILL:
            self._width, self._still_since = width, self.ctx.now
        if not self._closed:
            return width >= OPENING - OPEN_PLAY
        stands = self.ctx.now - self._still_since >= REST
        return grip.empty or (stands and grip.holds())

    def _done(self, width: float, force: float) -> Status:
        ctx = self.ctx
        if self._closed and not Grip(width, force).empty:
            ctx.gripper.mark_grasped(SOMETHING)
        else:
            ctx.mission.delivery.released = ctx.mission.delivery.released or self._full
            ctx.gripper.mark_released(ctx.now)
        ctx.note("gripper: " + ("closed" if self._closed else "open"), f"{width * 1000:.1f} mm, {force:.0f} N", "did")
        return Status.SUCCESS


class HearPermission(HearAnswer):
    """SUCCESS on a yes; whatever else is heard leaves the failure that the question was about."""

    def spoken(self) -> str:
        return ""

    def heard(self, kind: Reply, rest: str, text: str) -> Status:
        self.ctx.note(f"reply: {kind}", text, "heard")
        return Status.SUCCESS if kind == "yes" else Status.FAILURE

    def fail_with(self, failure: Failure) -> Status:
        before = self.ctx.mission.failure
        status = super().fail_with(failure)
        self.ctx.mission.failure = before
        return status


def open_hand(ctx: Context) -> Behaviour:
    """An empty hand opens; one that holds something sets it down first, as a release does."""
    full = Condition("something_is_in_it", set_down_or_open(ctx), lambda: in_hand(ctx), Status.FAILURE)
    empty = Condition(
        "it_is_empty", MoveGripper("open_the_hand", ctx, closed=False), lambda: not in_hand(ctx), Status.FAILURE
    )
    return Selector("open", full, empty)


def set_down_or_open(ctx: Context) -> Behaviour:
    """Set down what is held; when nobody moves the arm any more, open the hand on a person's yes."""
    ask = Sequence(
        "without_the_arm",
        AskQuestion("shall_i", ctx, lambda: drop_question(ctx)),
        HearPermission("hear_yes", ctx),
        MoveGripper("let_go", ctx, closed=False),
    )
    return Selector(
        "let_go_of_it",
        Release("put_down", ctx),
        Condition("the_arm_is_gone", ask, lambda: manipulation_gone(ctx), Status.FAILURE),
    )


def drop_question(ctx: Context) -> str:
    """The question before something is dropped."""
    return f"My arm does not answer. Shall I open my hand and let the {ctx.gripper.holding or SOMETHING} drop?"


def in_hand(ctx: Context) -> bool:
    """Something is believed or felt to be in the hand."""
    return bool(ctx.gripper.holding) or gripper_holds(ctx.io.latest(topics.JOINT_STATES)) is True


def manipulation_gone(ctx: Context) -> bool:
    """The hand is full and nobody moves the arm any more."""
    return ctx.mission.failed_with("NO_PEER") and in_hand(ctx)
