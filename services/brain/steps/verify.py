"""After putting down: look, and claim only what was seen."""

import math
from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from common import messages as m
from common import topics
from common.kinds import kind_of
from common.topic import Topic
from services.brain.mission.channel import Result
from services.brain.mission.context import Context
from services.brain.mission.mission import Failure
from services.brain.steps.find import object_in_map
from services.brain.steps.leaf import Leaf, SendGoal, Settle
from services.brain.steps.motion import Release, drive_to
from services.brain.tree.composites import Condition, Retry, Sequence
from services.brain.world.neighbours import knocked_over
from services.brain.world.placement import Finding, Rest, judge_absence, judge_placement

MISPLACED_CODES = ("NOT_SEEN", "MISPLACED", "TOPPLED")
"""Codes of a look that shows an object not where, or not as, it belongs."""
LOOKS = 2
"""Pictures in a row that must show a fault before it is believed; each costs a settle and a second or two."""
SAME_SPOT = 0.07
"""Distance [m] within which a thing stands where another was believed to be taken from. Chosen: fingers that close on
something else push it aside by some cm."""
ASIDE = 0.4
"""rad by which the base turns before the second look for an object that is not to be seen: the folded arm hides some
0.2 rad of the head camera's picture, and turns with the base."""


class VerifyPlacement(SendGoal):
    """Asks perception where the object is that was put down last, in a picture taken from now on.

    By its id, whatever it looks like from here, and by its label where nothing is known by that.
    Perception that cannot be asked is no failure as long as nobody has seen its process: the mission then claims no
    more than the hand felt. One that was alive and does not answer is `UNCHECKED`.
    """

    def __init__(self, node_id: str, ctx: Context, target: str, near: str = "") -> None:
        super().__init__(node_id, ctx, ctx.peers.perception, state="RELEASING", timeout=ctx.config.check_timeout)
        self._target, self._near = target, near

    def update(self) -> Status:
        ctx = self.ctx
        strange = self._sent_at is None and not self.channel.known and not ctx.io.has_subscribers(topics.OBJECT_QUERY)
        if strange or not ctx.mission.delivery.put_down:
            return self._unchecked("nobody answers object queries")
        return super().update()

    def step(self) -> str:
        return f"check {self.ctx.mission.delivery.put_down}"

    def goal(self, goal_id: str) -> tuple[Topic[Any], m.Message]:
        ctx, label = self.ctx, self.ctx.mission.delivery.put_down
        meant = next((one.id for one in ctx.mission.search.found.values() if one.label == label), "")
        return topics.OBJECT_QUERY, m.ObjectQuery(id=goal_id, query=label, since=ctx.now, meant=meant)

    def succeed(self, result: Result) -> Status:
        ctx, pose = self.ctx, result.message
        assert isinstance(pose, m.ObjectPose)
        label = ctx.mission.delivery.put_down
        if pose.found and pose.seen_at <= ctx.gripper.put_down.get(label, math.inf):
            return self._unchecked("what was seen is older than the release")
        if pose.found:
            finding = _judged(ctx, pose, self._target, self._near)
        else:
            finding = judge_absence(label, self._target, ctx.io.household)
        return record_finding(ctx, finding, pose.picture)

    def fail_with(self, failure: Failure) -> Status:
        if failure.stage != "RELEASING" or failure.code in ("STOPPED", "CANCELLED"):
            return super().fail_with(failure)
        if not self.channel.known:
            return self._unchecked(failure.detail)
        spoken = f"I put down the {self.ctx.mission.delivery.put_down}, but I could not check where it is."
        return super().fail_with(Failure(failure.stage, "UNCHECKED", f"{failure.code}: {failure.detail}", spoken))

    def _unchecked(self, why: str) -> Status:
        """Put down as far as the hand felt; the mission says that nobody looked."""
        ctx = self.ctx
        ctx.mission.delivery.unchecked = [*ctx.mission.delivery.unchecked, ctx.mission.delivery.put_down or "object"]
        ctx.note(f"not checked: {ctx.mission.delivery.put_down or 'object'}", why)
        self.feedback_message = why
        return Status.SUCCESS


class TurnAside(SendGoal):
    """Turns the base on the spot, so that the arm hides another part of the surface before it from the camera.

    SUCCESS whatever navigation says: the look that follows tells what is to be seen from there.
    """

    def __init__(self, node_id: str, ctx: Context) -> None:
        super().__init__(node_id, ctx, ctx.peers.navigation, state="RELEASING", timeout=ctx.config.check_timeout)

    def update(self) -> Status:
        if self._sent_at is None and not self.ctx.io.has_subscribers(topics.NAV_GOAL):
            return Status.SUCCESS
        return super().update()

    def goal(self, goal_id: str) -> tuple[Topic[Any], m.Message]:
        self.ctx.mission.at = ""
        x, y, theta = self.ctx.robot_pose
        return drive_to(goal_id, (x, y, theta + ASIDE))

    def fail_with(self, failure: Failure) -> Status:
        self.feedback_message = f"not turned: {failure.code}"
        return Status.SUCCESS


class AlreadyInPlace(Leaf):
    """SUCCESS when the object, as it was found, is already where it belongs; what two pictures have shown lying
    does not stand up by itself."""

    def __init__(self, node_id: str, ctx: Context, item: str, target: str, near: str = "") -> None:
        super().__init__(node_id, ctx)
        self._item, self._target, self._near = item, target, near

    def update(self) -> Status:
        ctx, pose = self.ctx, self.ctx.mission.search.found.get(self._item)
        label = ctx.mission.delivery.put_down
        if pose is None or pose.label != label or pose.seen_at <= ctx.gripper.put_down.get(label, math.inf):
            return Status.FAILURE
        if ctx.mission.failed_with("TOPPLED"):
            return Status.FAILURE
        finding = _judged(ctx, pose, self._target, self._near)
        if finding.fault:
            return Status.FAILURE
        return record_finding(ctx, finding, b"")


def _judged(ctx: Context, pose: m.ObjectPose, target: str, near: str) -> Finding:
    """Judge by the words that it was asked for with: what is called a banana may have been meant as the bottle."""
    mission, label, household = ctx.mission, ctx.mission.delivery.put_down, ctx.io.household
    asked = (item for item, one in mission.search.found.items() if one.label == label)
    rest = next((rest for item in asked if (rest := mission.delivery.rests.get(item))), Rest())
    seen = next((o for o in ctx.objects if o.id == pose.id and o.id), None) or ctx.known_object(label)
    alike = any(kind_of(k).ends_alike for k in (seen.kind, *seen.kinds[:1])) if seen else False
    shape, top, unlike = seen.shape if seen else "", seen.top if seen else "", mission.delivery.unlike == label
    return judge_placement(pose, label, target, household, object_in_map(ctx, near), rest, alike, top, shape, unlike)


def record_finding(ctx: Context, finding: Finding, picture: bytes) -> Status:
    """Write down what was seen; what is not where it belongs counts as not released."""
    mission, label = ctx.mission, ctx.mission.delivery.put_down
    name = ctx.pictures.keep(mission.id, picture)
    ctx.note(f"looked at the {label}", finding.evidence, "saw", picture=name)
    if not finding.fault:
        mission.delivery.released, mission.failure = True, None
        mission.delivery.checked = [*mission.delivery.checked, finding.evidence]
        return Status.SUCCESS
    mission.delivery.released = False
    mission.delivery.unlike = label if finding.unlike else mission.delivery.unlike
    taken = next((found.position for found in mission.search.found.values() if found.label == label), None)
    if finding.fault == "NOT_SEEN" and taken is not None:
        mission.delivery.absent[label] = taken, ctx.gripper.put_down.get(label, ctx.now)
    if (failure := mission.failure) is not None and (failure.code, finding.fault) == ("TOPPLED", "UNTOLD"):
        # What cannot be told does not unsay what was seen.
        return ctx.fail(failure.stage, failure.code, failure.detail, failure.spoken)
    spoken = f"I did not put down the {label} well: {finding.words}."
    if finding.fault == "UNTOLD":
        spoken = f"I put down the {label}, but {finding.words}."
    return ctx.fail("RELEASING", finding.fault, finding.evidence, spoken)


def with_care(ctx: Context) -> bool:
    """True unless something fell near the arm at work, or was taken for what was asked for: the failure is recorded."""
    mission = ctx.mission
    found = mission.search.found.values()
    handled = {one.label for one in found} | {one.id for one in found if one.id}
    handled |= {mission.delivery.put_down, mission.task.label}
    if fallen := knocked_over(mission.delivery.around, ctx.objects, handled):
        return _careless(ctx, "KNOCKED_OVER", " and ".join(fallen))
    if taken := _mistaken(ctx):
        return _careless(ctx, "TOOK_ANOTHER", f"I took something else for the {taken} first and put it down")
    return True


def _mistaken(ctx: Context) -> str:
    """The label of an object that was found again where it was taken from, after what was put down in its name was not
    to be seen: that was something else; "" if there is none.
    """
    poses = ctx.mission.search.found.values()
    for label, (spot, when) in ctx.mission.delivery.absent.items():
        if any(pose.seen_at > when and math.dist(pose.position[:2], spot[:2]) < SAME_SPOT for pose in poses):
            return label
    return ""


def _careless(ctx: Context, code: str, what: str) -> bool:
    spoken = f"I did what you asked for, but not with care: {what}. I am sorry."
    ctx.record_failure(Failure("COMPLETED", code, "; ".join([*ctx.mission.delivery.checked, what]), spoken))
    return False


def verify_placement(ctx: Context, target: str, near: str = "") -> Behaviour:
    """Look once physics has settled; a fault is believed when another picture shows it too.

    What is not to be seen, or not well enough to tell how it stands, is looked at from a little aside.
    """
    aside = Sequence("aside", TurnAside("turn_aside", ctx), Settle("come_to_rest", ctx))
    moved = Condition(
        "hidden_by_the_arm", aside, lambda: looks.used > 0 and ctx.mission.failed_with("NOT_SEEN", "UNTOLD")
    )
    look = Sequence("look", moved, VerifyPlacement("check", ctx, target, near))
    looks = Retry("look_at_it", ctx, look, LOOKS - 1, again=lambda: ctx.mission.failed_with(*MISPLACED_CODES, "UNTOLD"))
    return looks


def release_and_verify(ctx: Context, node_id: str, goal: str, target: str, near: str = "") -> Behaviour:
    """Carry out the `goal` that opens the hand, let physics settle, look.

    `target`: the receptacle where the object belongs, `near`: the object next to which; "" anywhere.
    """
    release = Release(node_id, ctx, lambda: goal, lambda: object_in_map(ctx, near))
    look = verify_placement(ctx, target, near)
    return Sequence(f"{node_id}_and_look", release, Settle("settle", ctx), look)


def is_misplaced(ctx: Context) -> bool:
    """The last look showed the object not where, or not as, it belongs."""
    return ctx.mission.failed_with(*MISPLACED_CODES)
