"""The steps of a plan as subtrees, each with its recoveries."""

from collections.abc import Iterator
from functools import partial
from math import pi

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from common.messages import AROUND, PlanStep
from common.plan_rules import is_destination
from services.brain.mission.context import Context
from services.brain.pipelines.shared import drive_home
from services.brain.recoveries.put_back import HoldsWhatWasMeant
from services.brain.recoveries.recovery import Subtree, Task, with_recoveries
from services.brain.recoveries.table import AFTER_GRASPING, AFTER_LOOKING, AFTER_PUTTING_DOWN
from services.brain.steps.find import Approach, LocateObject, TurnOnTheSpot, WithinReach, label_of, object_ref
from services.brain.steps.gripper import MoveGripper, open_hand, set_down_or_open
from services.brain.steps.home import edit_of, tell_home
from services.brain.steps.identify import StillMeant
from services.brain.steps.leaf import Leaf, Say, Settle
from services.brain.steps.motion import Grab, Navigate
from services.brain.steps.teach import forget, teach
from services.brain.steps.verify import AlreadyInPlace, release_and_verify, verify_placement
from services.brain.tree.composites import Condition, Selector, Sequence
from services.brain.tree.path import PLAN_STEP

Node = Sequence | Selector | Leaf
"""What a step of a plan may be."""


TURNS = 4
"""Views of a look around (chosen: a quarter turn is about what the head camera sees at once)."""


class RunPlan(Sequence):
    """The accepted plan as a sequence, built when it starts."""

    def __init__(self, node_id: str, ctx: Context) -> None:
        super().__init__(node_id)
        self._ctx = ctx

    def unfold(self) -> None:
        """Build the children; a restarted brain does so to find its place among them."""
        self.remove_all_children()
        carried, at_home = "", False
        for step in self._ctx.mission.planning.steps:
            carried = step.object if step.action == "grasp" else carried
            if step.action in ("return", "navigate", "grasp", "place"):
                at_home = step.action == "return"
            child = step_tree(self._ctx, step, carried, at_home)
            child.node_id = PLAN_STEP  # whatever it does, the journal knows it by its place in the plan
            self.add_child(child)

    def tick(self) -> Iterator[Behaviour]:
        if self.status != Status.RUNNING:
            self.unfold()
        yield from super().tick()


def step_tree(ctx: Context, step: PlanStep, carried: str, at_home: bool = False) -> Node:
    """One step with its own recovery; the next goal comes a settle later. `carried`: what was grasped last.

    `at_home`: the plan has brought it to where objects are delivered.
    """
    name = step.words
    match step.action:
        case "find":
            return find(ctx, step.object)
        case "navigate" if step.target == AROUND:
            return look_around(ctx)
        case "navigate":
            return navigate(ctx, step.target or step.object, name)
        case "grasp" | "release" if step.hand_alone:
            hand = MoveGripper("close_the_hand", ctx, closed=True) if step.action == "grasp" else open_hand(ctx)
            return Sequence(PLAN_STEP, hand, Settle("settle", ctx), name=name)
        case "grasp":
            return grasp(ctx, step.object)
        case "place":
            stand = step.near or step.target
            there = Condition("go_there", stand_before(ctx, step), lambda: ctx.mission.at != stand)
            back, goal = partial(stand_before, ctx, step), f"place {step.target}"
            down = put_down(ctx, carried, back, goal, step.target, step.near)
            return Sequence(PLAN_STEP, there, down, name=name)
        case "release":
            return release(ctx, carried, at_home, name)
        case "say":
            return Say(PLAN_STEP, ctx, lambda: step.text, name=name)
        case "wait":
            return Settle(PLAN_STEP, ctx, name=name, seconds=step.seconds)
        case "teach":
            return teach(ctx, step, PLAN_STEP, name)
        case "forget" if not step.target:
            return forget(ctx, step, PLAN_STEP, name)
        case "name" | "rule" | "forget":
            return tell_home(ctx, lambda: edit_of(step, ctx), PLAN_STEP, name)
        case "return":
            at_start = RememberPlace("at_home", ctx, "home")
            return Sequence(PLAN_STEP, drive_home(ctx, bool(carried)), at_start, Settle("settle", ctx), name=name)


def navigate(ctx: Context, where: str, name: str) -> Sequence:
    """Drive to a place, or up to an object that is looked for first."""
    if is_destination(where, ctx.io.household):
        return Sequence(PLAN_STEP, go_to(ctx, where), Settle("settle", ctx), name=name)
    unseen = Condition("find_it", find(ctx, where), lambda: where not in ctx.mission.search.found)
    return Sequence(PLAN_STEP, unseen, approach(ctx, where), name=name)


def look_around(ctx: Context) -> Sequence:
    """Turn once around on the spot, and rest at each heading for the camera."""
    angle = 2 * pi / TURNS
    views = [
        Sequence("view", TurnOnTheSpot("turn", ctx, angle), Settle("settle", ctx), name=f"view {n}")
        for n in range(1, TURNS + 1)
    ]
    return Sequence(PLAN_STEP, *views, name="look around")


def find(ctx: Context, item: str) -> Selector:
    """Look from here, ask when several match, else search: turn, then other viewpoints."""
    look = LocateObject("primary_detection", ctx, item)
    return with_recoveries("perception", ctx, look, AFTER_LOOKING, Task(item), name=f"perception: {item}")


def approach(ctx: Context, item: str) -> Behaviour:
    """Drive to where the arm reaches the object."""
    there = RememberPlace("there", ctx, item)
    return Sequence("approach_and_settle", Approach(ctx, item), there, Settle("settle", ctx), name=f"approach {item}")


def grab(ctx: Context, item: str) -> Grab:
    """Close the hand around an object that was found."""
    return Grab("grab", ctx, lambda: label_of(ctx, item), lambda: object_ref(ctx, item), item)


def grasp(ctx: Context, item: str) -> Node:
    """Approach if needed and grab; after a failed grab its recoveries."""
    near = Condition("near_it", approach(ctx, item), lambda: ctx.mission.at != item)
    reached = WithinReach("within_reach", ctx, item)
    first = Sequence("grasp_once", reached, near, *_grab_if_meant(ctx, item), name=f"grasp {item}")
    if not ctx.config.grab_retries:
        return first
    task = Task(
        item,
        find=lambda: find(ctx, item),
        approach=lambda: approach(ctx, item),
        grab=lambda: Sequence("grab_if_meant", *_grab_if_meant(ctx, item)),
    )
    return with_recoveries("grasp", ctx, first, AFTER_GRASPING, task, name=f"grasp: {item}")


def _grab_if_meant(ctx: Context, item: str) -> tuple[Node, ...]:
    """The steps of one grab: of the object that is still meant, with a check that no other is in the hand."""
    still, check = StillMeant("still_meant", ctx, item), HoldsWhatWasMeant(ctx, item)
    return still, grab(ctx, item), Settle("settle", ctx), check


def release(ctx: Context, carried: str, at_home: bool, name: str) -> Sequence:
    """Let go of what was grasped, and look; of what somebody else put into the hand, look only if it is known."""
    target = ctx.io.household.delivery if at_home else ""
    if carried:
        down = put_down(ctx, carried, lambda: home_and_settle(ctx), "release", target)
        return Sequence(PLAN_STEP, down, name=name)
    look = verify_placement(ctx, target)
    known = Condition("look", look, lambda: ctx.io.household.thing(ctx.mission.delivery.put_down) is not None)
    return Sequence(PLAN_STEP, set_down_or_open(ctx), Settle("settle", ctx), known, name=name)


def stand_before(ctx: Context, step: PlanStep) -> Behaviour:
    """Drive to where a `place` step can be carried out: before the object next to which, or before the receptacle."""
    return approach(ctx, step.near) if step.near else go_and_settle(ctx, step.target)


def put_down(ctx: Context, item: str, back: Subtree, goal: str, target: str, near: str = "") -> Behaviour:
    """Carry out the `goal` that opens the hand and look; what is lost or misplaced is brought `back` again."""
    first = release_and_verify(ctx, "put_down", goal, target, near)
    if not item:
        return first
    task = Task(
        item,
        find=lambda: find(ctx, item),
        grasp=lambda: grasp(ctx, item),
        carry_back=back,
        put_down=lambda: release_and_verify(ctx, "put_down_at_last", goal, target, near),
        in_place=lambda: AlreadyInPlace("in_place_already", ctx, item, target, near),
    )
    return with_recoveries("put_down_item", ctx, first, AFTER_PUTTING_DOWN, task, name=f"put down {item}")


def go_to(ctx: Context, where: str) -> Behaviour:
    """Drive to a place, room or receptacle."""
    drive = Navigate(
        "go",
        ctx,
        text=lambda: f"goto {where}",
        spoken=lambda: f"I could not get to the {where}.",
        state="NAVIGATING",
        place=where,
    )
    return Sequence("go_to", drive, RememberPlace("there", ctx, where), name=f"go to {where}")


def go_and_settle(ctx: Context, where: str) -> Behaviour:
    """Drive to a place and come to rest."""
    return Sequence("go_and_settle", go_to(ctx, where), Settle("settle", ctx))


def home_and_settle(ctx: Context) -> Behaviour:
    """Bring what is carried home and come to rest."""
    return Sequence("back", drive_home(ctx, carrying=True), Settle("settle", ctx))


class RememberPlace(Leaf):
    """Remembers where the robot stands."""

    def __init__(self, node_id: str, ctx: Context, where: str) -> None:
        super().__init__(node_id, ctx)
        self._where = where

    def update(self) -> Status:
        self.ctx.mission.at = self._where
        return Status.SUCCESS
