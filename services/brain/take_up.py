"""Carries out the taking up of a mission that a restart or a stop has cut short: look, decide, put the tree there."""

import msgspec
from py_trees.behaviour import Behaviour

from common import topics
from common.time.clock import unix_time
from services.brain.context import Context
from services.brain.journal import Checkpoint
from services.brain.mission import Failure, Hand, Mission, fingers_hold
from services.brain.resume import Decision, Seen, apply, decide, refusal
from services.brain.snapshot import Moved, path_by_name, put

LOOK = 0.6
PEER_PATIENCE = 3.0
SPARE_GOALS = 10


def cut_short(left: Checkpoint, ended: Mission, hand: Hand) -> Checkpoint:
    """What a stop leaves for later: the place and the mission as they were, the hand as it is, nothing under way."""
    mission = msgspec.structs.replace(left.mission, outcome=None, failure=None, goals=ended.goals)
    now = msgspec.structs.replace(hand, uncertain="", empty_since=None, put_down=dict(hand.put_down))
    return msgspec.structs.replace(left, mission=mission, hand=now, sent=[], resumes=0)


class Resumption:
    """Stands in for the tree until the mission has been taken up, or ended because it cannot be.

    `why` it has to be: for the timeline. Joint states that stay away longer than `heartbeat_patience` end it in ERROR.
    """

    def __init__(self, ctx: Context, root: Behaviour, left: Checkpoint, why: str = "brain restarted") -> None:
        self._ctx, self._root, self.left, self._why = ctx, root, left, why
        self._since: float | None = None
        self._waiting: float | None = None
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
        ctx.io.log.warning("mission to resume", mission=ctx.mission.id, command=ctx.mission.command, why=why)

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
            ctx.note(self._why, f"at {' > '.join(p.name for p in self.left.path) or 'the start'}")
        if joints is None or not ctx.heartbeat.fresh(ctx.now):
            return self._wait()
        self._waiting = None
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

    def _wait(self) -> bool:
        """For joint states, as long as patience lasts; what was seen before does not count any more."""
        ctx, patience = self._ctx, self._ctx.config.heartbeat_patience
        ctx.enter("IDLE", detail="resuming: waiting for joint_states")
        self._since = None
        self._felt.clear()
        if self._waiting is None or ctx.heartbeat.paused:
            self._waiting = ctx.now
        if max(ctx.now - self._waiting, ctx.heartbeat.stalled) <= patience:
            return False
        self._call_off()
        ctx.fail(
            Failure("HEARTBEAT", "NO_JOINT_STATES", f"none for {patience:.0f} s", "I have lost contact with my motors.")
        )
        self.put_off = True
        put(self._root, path_by_name(self._root, "mission", "report failure"))
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
