"""Carries out the taking up of a mission that a restart or a stop has cut short: look, decide, put the tree there."""

import msgspec
from py_trees.behaviour import Behaviour

from common import topics
from common.clock import unix_time
from services.brain.context import Context
from services.brain.journal import Checkpoint
from services.brain.mission import Failure, Hand, Mission, fingers_hold
from services.brain.resume import Decision, Seen, apply, decide, refusal
from services.brain.snapshot import Moved, put

LOOK = 0.6
PEER_PATIENCE = 3.0
SPARE_GOALS = 10


def cut_short(left: Checkpoint, ended: Mission, hand: Hand) -> Checkpoint:
    """What a stop leaves for later: the place and the mission as they were, the hand as it is, nothing under way."""
    mission = msgspec.structs.replace(left.mission, outcome=None, failure=None, goals=ended.goals)
    now = msgspec.structs.replace(hand, uncertain="", empty_since=None, put_down=dict(hand.put_down))
    return msgspec.structs.replace(left, mission=mission, hand=now, sent=[], resumes=0)


class Resumption:
    """Stands in for the tree until the mission has been taken up, or ended because it cannot be."""

    def __init__(self, ctx: Context, root: Behaviour, left: Checkpoint) -> None:
        self._ctx, self._root, self.left = ctx, root, left
        self._since: float | None = None
        self._told = self.put_off = False
        self._felt: set[bool | None] = set()
        ctx.mission, ctx.hand = left.mission, left.hand
        ctx.mission.goals += SPARE_GOALS
        ctx.journal.resume(ctx.mission)
        for sent in left.sent:
            for channel in ctx.channels:
                if channel.peer == sent.peer:
                    channel.take_up(sent)
        self._refused = refusal(left, ctx.config, unix_time())
        ctx.io.log.warning("mission found", mission=ctx.mission.id, command=ctx.mission.command)

    def step(self) -> bool:
        """True once the tree may be ticked."""
        ctx = self._ctx
        if not ctx.mission.active:
            return True
        if self._refused is not None:
            self._end(self._refused)
            return True
        joints = ctx.io.latest(topics.JOINT_STATES)
        if not self._told:
            self._told = True
            ctx.note("brain restarted", f"at {' > '.join(p.name for p in self.left.path) or 'the start'}")
        if joints is None:
            ctx.enter("IDLE", detail="resuming: waiting for joint_states")
            return False
        ctx.enter("IDLE", detail="resuming: looking at the world")
        self._since = ctx.now if self._since is None else self._since
        self._felt.add(fingers_hold(joints))
        looked = ctx.now - self._since
        strangers = any(not ctx.io.peer(sent.peer) for sent in self.left.sent)
        if looked < LOOK or (strangers and looked < PEER_PATIENCE):
            return False
        if ctx.stopped is not None:
            self.put_off = True
            self._end(Failure("RESTART", "CANCELLED", "the robot was stopped before it could go on"))
        else:
            self._go_on()
        return True

    def _go_on(self) -> None:
        ctx, left = self._ctx, self.left
        here = ctx.io.latest(topics.POSE)
        arm = ctx.manipulation
        seen = Seen(
            fingers=next(iter(self._felt)) if len(self._felt) == 1 else None,
            base=(here.x, here.y, here.theta) if here else None,
            t=ctx.now,
            arm_answered=arm.outstanding and arm.answer is not None and not arm.restarted,
        )
        decision = decide(left, seen)
        apply(decision, ctx.mission, ctx.hand)
        if decision.change:
            self._call_off()
        try:
            ctx.placed(put(self._root, decision.path), left.resumes + 1)
        except Moved as moved:
            self._end(Failure("RESTART", "CANNOT_RESUME", str(moved)))
            return
        ctx.note("resumed", _account(decision, seen, ctx.hand), "saw")
        ctx.io.log.info("resumed", mission=ctx.mission.id, path=" > ".join(p.name for p in decision.path),
                        change=decision.change)  # fmt: skip
        ctx.save()

    def _call_off(self) -> None:
        """What was under way does not fit the world any more."""
        ctx = self._ctx
        for channel, topic in ((ctx.navigation, topics.NAVIGATION_GOAL), (ctx.manipulation, topics.MANIPULATION_GOAL)):
            if channel.outstanding:
                ctx.tell(channel, topic, "stop")
        for channel in ctx.channels:
            channel.abandon()

    def _end(self, failure: Failure) -> None:
        ctx = self._ctx
        ctx.mission.failure = failure
        self._call_off()
        held = ctx.hand.holding or ctx.hand.uncertain
        reason = failure.reason + (f"; holding the {held}" if held else "")
        ctx.finish("cancelled" if failure.code == "CANCELLED" else "failed", reason)


def _account(decision: Decision, seen: Seen, hand: Hand) -> str:
    """What was seen, in words for the timeline."""
    fingers = {True: "the fingers hold something", False: "the fingers are empty", None: "the fingers say nothing"}
    where = "" if seen.base is None else f", base at ({seen.base[0]:.2f}, {seen.base[1]:.2f})"
    change = {
        "": "goes on where it was",
        "lost": f"the {decision.label} is not in the hand any more",
        "holding": f"the {decision.label} is in the hand already",
        "moved": "the base is not where it was",
        "new world": "the simulation began anew",
    }[decision.change]
    return f"{fingers[seen.fingers]}{where}; {change}"
