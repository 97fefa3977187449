"""Leaves that look for an object and drive up to it."""

import math
from typing import Any

import msgspec
from py_trees.common import Status

from common import messages as m
from common import topics
from common.kinds import kind_of
from common.language.normalise import indefinite
from common.naming.likeness import PLAIN, describes, likeness
from common.naming.names import normalise
from common.naming.place_named import is_at
from common.topic import Topic
from services.brain.mission.channel import Result
from services.brain.mission.context import Context
from services.brain.mission.mission import Failure
from services.brain.mission.search import ALL_SIDES
from services.brain.steps.leaf import Leaf, SendGoal
from services.brain.steps.motion import Navigate, drive_to
from services.brain.world.placement import TIPPED, kind_meant
from services.brain.world.standing_poses import FARTHEST, shows_another_side, standing_pose


class LocateObject(SendGoal):
    """Asks perception for an object from where the robot stands."""

    def __init__(self, node_id: str, ctx: Context, item: str) -> None:
        super().__init__(node_id, ctx, ctx.peers.perception, state="GROUNDING", timeout=ctx.config.perception_timeout)
        self._item = item

    def goal(self, goal_id: str) -> tuple[Topic[Any], m.Message]:
        search, item = self.ctx.mission.search, self._item
        query = search.chosen.get(item, item)
        return topics.OBJECT_QUERY, m.ObjectQuery(
            id=goal_id,
            query=query,
            meant=search.confirmed.get(item, "") or self._found_before(query),
            excluded=search.rejected,
        )

    def _found_before(self, query: str) -> str:
        """Id of what was found for the words once, has the same label still and fits them less plainly now: half hidden
        by the hand or its neighbours, an object looks like another."""
        ctx, found = self.ctx, self.ctx.mission.search.found.get(self._item)
        known = next((o for o in ctx.objects if found and o.id == found.id and o.label == found.label), None)
        fits = 0.0 if known is None else likeness(query, known, ctx.io.household)
        return found.id if found and 0.0 < fits < PLAIN and found.id not in ctx.mission.search.rejected else ""

    def step(self) -> str:
        return f"look for {self._item}"

    def spoken(self) -> str:
        return f"I could not find the {self._item}."

    def succeed(self, result: Result) -> Status:
        ctx, pose = self.ctx, result.message
        assert isinstance(pose, m.ObjectPose)
        search = ctx.mission.search
        search.options = pose.candidates
        search.perhaps = [p for p in pose.perhaps if p.id not in search.rejected]
        self._note_near_looks([*pose.unsure, *pose.unlikely])
        place = "" if pose.candidates else self.ctx.told_place(self._item)
        near = [n for n in pose.unsure if self._may_be_at(place, n)]
        later = [n for n in pose.unsure if n not in near]
        search.unsure, search.unlikely = self._left(near), self._left([*later, *pose.unlikely])
        if not pose.found:
            self.feedback_message = pose.detail or "not seen"
            code = "AMBIGUOUS" if pose.candidates else "NOT_FOUND"
            return self.fail_with(Failure("GROUNDING", code, pose.detail, self.spoken()))
        search.found[self._item] = pose
        x, y, z = pose.position
        evidence = f"{pose.label} at ({x:.2f}, {y:.2f}, {z:.2f}), confidence {pose.confidence:.2f}"
        ctx.note(f"found {self._item}", evidence, "saw")
        return Status.SUCCESS

    def _note_near_looks(self, labels: list[str]) -> None:
        """What the last pictures have shown of these from where the robot stands it need not come nearer for."""
        x, y, _ = self.ctx.robot_pose
        for o in self.ctx.objects:
            if o.label in labels and o.seen_at >= self.since and math.dist((x, y), o.position[:2]) <= FARTHEST:
                angle = math.atan2(y - o.position[1], x - o.position[0])
                if shows_another_side(angle, self.ctx.mission.search.directions(o)):
                    self.ctx.mission.search.looked_near(o, [angle])

    def _may_be_at(self, place: str, label: str) -> bool:
        """Whether the object of that label is at a place, "" for anywhere, or nothing is known of where it is."""
        known = self.ctx.known_object(label) if place else None
        return known is None or is_at(known, place, self.ctx.io.household)

    def _left(self, labels: list[str]) -> list[str]:
        """Those of the labels whose objects were not looked at from nearer from all sides."""
        known, search = {o.label: o for o in self.ctx.objects}, self.ctx.mission.search
        return [n for n in labels if n not in known or len(search.directions(known[n])) < ALL_SIDES]


class TurnOnTheSpot(SendGoal):
    """Turns the base by `angle` [rad] where it stands."""

    def __init__(self, node_id: str, ctx: Context, angle: float) -> None:
        timeout = ctx.config.navigation_timeout
        super().__init__(node_id, ctx, ctx.peers.navigation, state="NAVIGATING", timeout=timeout)
        self._angle = angle

    def goal(self, goal_id: str) -> tuple[Topic[Any], m.Message]:
        x, y, theta = self.ctx.robot_pose
        turned = math.remainder(theta + self._angle, 2 * math.pi)
        return drive_to(goal_id, (x, y, turned))

    def step(self) -> str:
        return "look around"

    def spoken(self) -> str:
        return "I could not turn around."


class ReportNotFound(Leaf):
    """Ends a search without result with the reason that counts, whatever failed last."""

    def __init__(self, node_id: str, ctx: Context, item: str, tries: int) -> None:
        super().__init__(node_id, ctx)
        self._item, self._tries = item, tries

    def update(self) -> Status:
        return self.ctx.fail("GROUNDING", "NOT_FOUND", f"not seen in {self._tries} search attempts", self._spoken())

    def _spoken(self) -> str:
        if label_of(self.ctx, self._item) in self.ctx.mission.delivery.lost:
            # The arm is carried above the base, which neither camera shows on the way.
            lost = f"I lost the {self._item} on the way and do not see it."
            return f"{lost} Please look whether it lies on my own base."
        told = f"I could not find the {self._item}."
        if known_by_name(self.ctx, self._item):
            return told
        return f"{told} I do not know what it looks like: tell me its colour and kind, or show it to me and name it."


class Approach(Navigate):
    """`nav_goal`: a standing pose before an object that was found, and the object for who knows a better stance."""

    def __init__(self, ctx: Context, item: str) -> None:
        super().__init__(
            "approach",
            ctx,
            text=lambda: f"find {label_of(ctx, item)}",
            spoken=lambda: f"I could not reach the {item}.",
            state="NAVIGATING",
        )
        self._item = item

    def step(self) -> str:
        return f"approach {label_of(self.ctx, self._item)}"

    def goal(self, goal_id: str) -> tuple[Topic[Any], m.Message]:
        ctx, ref = self.ctx, object_in_map(self.ctx, self._item)
        if ref is None or ref.frame != "map":
            return super().goal(goal_id)  # nobody has said where in the map it is: navigation looks for it
        if told := ctx.mission.search.stances.get(ref.label):
            # Whoever moves the arm has computed where: no other stance will do.
            return drive_to(goal_id, told)
        pose = standing_pose(ctx.io.household, (ref.position[0], ref.position[1]), ctx.robot_pose)
        return drive_to(goal_id, pose, ref)

    def fail_with(self, failure: Failure) -> Status:
        if self.ctx.mission.search.stances.pop(label_of(self.ctx, self._item), None):
            # What cannot be driven to is a stance less for the hand, which may tell another.
            failure = msgspec.structs.replace(failure, stage="GRABBING")
        return super().fail_with(failure)


class WithinReach(Leaf):
    """FAILURE before anything is tried when what was found stands higher than the arm takes its kind from."""

    def __init__(self, node_id: str, ctx: Context, item: str) -> None:
        super().__init__(node_id, ctx)
        self._item = item

    def update(self) -> Status:
        ctx, ref = self.ctx, object_ref(self.ctx, self._item)
        if ref is None or ref.frame != "map" or ref.tilt > TIPPED:
            return Status.SUCCESS
        surface = ctx.io.household.receptacle(ctx.origin_of(ref.label))
        height = surface.center[2] if surface is not None else ref.position[2] - ref.size[2] / 2
        kind = kind_of(ref.kind)
        if height <= kind.highest:
            return Status.SUCCESS
        detail = f"it stands at {height:.2f} m, {indefinite(kind.name)} is taken from {kind.highest:.2f} m at the most"
        return ctx.fail("GRABBING", "OUT_OF_REACH", detail, f"The {self._item} stands too high for me.")


def known_by_name(ctx: Context, item: str, head: str = "") -> bool:
    """The words for an object were taught, or say what it looks like; so does its `head`, if that is given."""
    names = ctx.io.latest(topics.HOUSEHOLD_NAMES)
    taught = {normalise(one.name) for one in names.names} if names else set()
    return normalise(item) in taught or describes(head or item, ctx.io.household)


def label_of(ctx: Context, item: str) -> str:
    """The name of an object as perception has it."""
    pose = ctx.mission.search.found.get(item)
    return (pose.label if pose else "") or item


def object_ref(ctx: Context, item: str) -> m.ObjectRef | None:
    """What perception said about the item, for manipulation; what nobody listed is of the kind that was asked for."""
    pose = ctx.mission.search.found.get(item)
    if pose is None:
        return None
    fields = {k: getattr(pose, k) for k in ("label", "position", "orientation", "size", "frame", "tilt")}
    listed = ctx.io.household.thing(pose.label)
    kind = listed.kind if listed else kind_meant(item, ctx.io.household)
    return msgspec.convert({**fields, "kind": kind}, m.ObjectRef)


def object_in_map(ctx: Context, label: str) -> m.ObjectRef | None:
    """Where an object is: as it was found in this mission, else as perception last surveyed it; None if neither."""
    ref, known = object_ref(ctx, label), ctx.known_object(label) if label else None
    if ref is not None or known is None:
        return ref
    return reference_to(known)


def reference_to(known: m.WorldObject) -> m.ObjectRef:
    """A surveyed object, as goals name one."""
    return m.ObjectRef(
        label=known.label, position=known.position, orientation=known.orientation, size=known.size, kind=known.kind,
        tilt=known.tilt,
    )  # fmt: skip
