"""Resumption of a suspended mission: look at the world, decide by the policy, start the tree there."""

import msgspec
from py_trees.behaviour import Behaviour

from common import topics
from common.time.clock import unix_time
from services.brain.journal.records import Checkpoint, PathNode
from services.brain.mission.context import Context
from services.brain.mission.mission import Failure, GripperState, Mission, gripper_holds
from services.brain.resume.policy import Decision, Observation, apply, decide, refusal, resumes_since_progress
from services.brain.tree.path import MISSION, REPORT_FAILURE, PathNotFound, start_at

LOOK = 0.6
"""s of looking before deciding (chosen: some statuses of every peer, and no pause that people notice)."""
PEER_PATIENCE = 3.0
"""s to wait for a peer that had a goal and is not there (chosen: a supervised service is started again within it)."""
SPARE_GOALS = 10
"""Goal numbers skipped: what the process before this one may have sent after its last checkpoint."""


def suspend(left: Checkpoint, ended: Mission, gripper: GripperState) -> Checkpoint:
    """The checkpoint of a suspended mission: place and mission as they were, the gripper as it is, no goals."""
    mission = msgspec.structs.replace(left.mission, outcome=None, failure=None, goals=ended.goals)
    now = msgspec.structs.replace(gripper, grasp_uncertain="", empty_since=None, put_down=dict(gripper.put_down))
    return msgspec.structs.replace(left, mission=mission, gripper=now, sent=[], resumes=0)


class Resumption:
    """Stands in for the tree until the mission has been resumed, or ended because it cannot be.

    `why` it has to be: for the timeline. Joint states that stay away longer than `heartbeat_patience` end it in ERROR.
    """

    def __init__(self, ctx: Context, root: Behaviour, left: Checkpoint, why: str = "brain restarted") -> None:
        self._ctx, self._root, self.left, self._why = ctx, root, left, why
        self._since: float | None = None
        self._waiting: float | None = None
        self._noted = self.suspended = False
        self._readings: set[bool | None] = set()
        ctx.mission, ctx.gripper = left.mission, left.gripper
        ctx.mission.goals += SPARE_GOALS
        ctx.journal.resume(ctx.mission)
        for sent in left.sent:
            for channel in ctx.peers.all:
                if channel.peer == sent.peer:
                    channel.resume_goal(sent)
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
        if not self._noted:
            self._noted = True
            ctx.note(self._why, f"at {' > '.join(str(p) for p in self.left.path) or 'the start'}")
        if joints is None or not ctx.heartbeat.fresh(ctx.now):
            return self._wait()
        self._waiting = None
        ctx.show_state("IDLE", detail="resuming: looking at the world")
        self._since = ctx.now if self._since is None else self._since
        self._readings.add(gripper_holds(joints))
        looked = ctx.now - self._since
        strangers = any(not ctx.io.peer(sent.peer) for sent in self.left.sent)
        if looked < LOOK or (strangers and looked < PEER_PATIENCE):
            return False
        if ctx.stopped is not None:
            self.suspended = True
            self._end(Failure("RESTART", "CANCELLED", "the robot was stopped before it could go on"))
        else:
            self._go_on()
        return True

    def _wait(self) -> bool:
        """For joint states, as long as patience lasts; what was seen before does not count any more."""
        ctx, patience = self._ctx, self._ctx.config.heartbeat_patience
        ctx.show_state("IDLE", detail="resuming: waiting for joint_states")
        self._since = None
        self._readings.clear()
        if self._waiting is None or ctx.heartbeat.paused:
            self._waiting = ctx.now
        if max(ctx.now - self._waiting, ctx.heartbeat.stalled) <= patience:
            return False
        self._call_off()
        ctx.record_failure(
            Failure("HEARTBEAT", "NO_JOINT_STATES", f"none for {patience:.0f} s", "I have lost contact with my motors.")
        )
        self.suspended = True
        start_at(self._root, [PathNode(MISSION), PathNode(REPORT_FAILURE)])
        return True

    def _go_on(self) -> None:
        """Start the tree where the policy says, with what was seen."""
        ctx, left = self._ctx, self.left
        here = ctx.io.latest(topics.POSE)
        arm = ctx.peers.manipulation
        seen = Observation(
            fingers=next(iter(self._readings)) if len(self._readings) == 1 else None,
            base=(here.x, here.y, here.theta) if here else None,
            t=ctx.now,
            arm_answered=arm.outstanding and arm.result is not None and not arm.restarted,
        )
        decision = decide(left, seen)
        apply(decision, ctx.mission, ctx.gripper)
        if decision.change:
            self._call_off()
        try:
            ctx.checkpoints.resumed_at(start_at(self._root, decision.path), resumes_since_progress(left, seen))
        except PathNotFound as missing:
            self._end(Failure("RESTART", "CANNOT_RESUME", str(missing)))
            return
        ctx.note("resumed", _account(decision, seen), "saw")
        ctx.io.log.info("resumed", mission=ctx.mission.id, path=" > ".join(str(p) for p in decision.path),
                        change=decision.change)  # fmt: skip
        ctx.save()

    def _call_off(self) -> None:
        """What was under way does not fit the world any more."""
        ctx = self._ctx
        for channel in (ctx.peers.navigation, ctx.peers.manipulation):
            if channel.outstanding:
                ctx.send_only(channel, "stop")
        for channel in ctx.peers.all:
            channel.abandon()

    def _end(self, failure: Failure) -> None:
        ctx = self._ctx
        ctx.mission.failure = failure
        self._call_off()
        reason = failure.reason + ctx.gripper.note
        ctx.end_mission("cancelled" if failure.code == "CANCELLED" else "failed", reason)


def _account(decision: Decision, seen: Observation) -> str:
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
