"""What the leaves of both trees share: time, bus, mission, hand, channels, and the state shown to the world."""

from typing import Any

import msgspec
from py_trees.behaviour import Behaviour

from common import messages as m
from common import topics
from common.bus.port import Io
from common.geometry import Pose2
from common.time.clock import unix_time
from common.topics import Topic
from common.viewpoints import Viewpoints, viewpoints_of
from services.brain.config import BrainConfig
from services.brain.journal.records import Checkpoint, Entry, Journal, Kind, PathNode
from services.brain.journal.sqlite import open_pictures
from services.brain.mission.channel import Channel
from services.brain.mission.heartbeat import Heartbeat
from services.brain.mission.mission import SYSTEM_STATE, Failure, GripperState, Mission, Outcome
from services.brain.tree.path import path_to

SAVE_AGAIN = 1.0


class Context:
    """One per brain; `now` is set before every tick of the tree."""

    def __init__(self, config: BrainConfig, io: Io, journal: Journal) -> None:
        self.config, self.io, self.journal = config, io, journal
        self.pictures = open_pictures(config, io)
        self.now = 0.0
        self.heartbeat = Heartbeat(io)
        self.speech = Channel(io, "speech")
        self.navigation = Channel(io, "navigation")
        self.manipulation = Channel(io, "manipulation")
        self.planner = Channel(io, "planner")
        self.perception = Channel(io, "perception")
        self.channels = (self.speech, self.navigation, self.manipulation, self.planner, self.perception)
        for channel in self.channels:
            channel.before_send = self.save
        self.mission = Mission(id=self._fresh_id())
        self.gripper = GripperState()
        self.at: Behaviour | None = None
        self.resumes = 0
        self.suspended: Checkpoint | None = None
        self._path: list[PathNode] = []
        self._saved = self._refused = b""
        self._again_at = 0.0
        self.stopped: str | None = None
        self.command: m.VoiceCommand | None = None
        self.reply: m.SpeechResult | None = None
        self.listen_after = 0.0
        self.speaking: m.SpeechStatus | None = None
        self.last = _outcome(journal)
        self.shown = m.BrainState(state="IDLE", pipeline=config.pipeline, detail="starting", last=self.last)
        self._publish_state()

    # --- the world's view
    @property
    def state(self) -> m.BrainStateName:
        return self.shown.state

    def show_state(self, state: m.BrainStateName, step: str = "", detail: str = "", cause: str = "") -> None:
        """Show a state; a change is published at once and noted in the journal."""
        mission, before = self.mission, self.shown
        running = mission.active or state in ("COMPLETED", "ERROR")
        self.shown = m.BrainState(
            state=state,
            t=self.now,
            mission_id=mission.id if running else "",
            command=mission.command if running else "",
            step=step,
            detail=detail,
            started=mission.started if running else 0.0,
            pipeline=self.config.pipeline,
            last=self._last_outcome(),
        )
        if _same(before, self.shown):
            self.shown = before
            return
        self._publish_state()
        was, is_now = SYSTEM_STATE[before.state], SYSTEM_STATE[state]
        if was != is_now:
            self.io.log.info(f"State: {was} -> {is_now}")
        if before.state != state or before.step != step:
            self.note(cause or step or state, detail, "state")
            self.io.log.info(
                "state", mission=self.shown.mission_id, state=state, step=step, detail=detail, was=before.state
            )

    def _last_outcome(self) -> m.MissionOutcome | None:
        if self.last is None or self.last.resumable == (self.suspended is not None):
            return self.last
        self.last = msgspec.structs.replace(self.last, resumable=self.suspended is not None)
        return self.last

    def _publish_state(self) -> None:
        self.io.publish(topics.BRAIN_STATE, self.shown)
        status = m.SystemStatus(
            state=SYSTEM_STATE[self.shown.state],
            mission_id=self.shown.mission_id,
            detail=self.shown.detail or self.shown.step,
        )
        self.io.publish(topics.SYSTEM_STATUS, status)

    def note(self, cause: str, evidence: str = "", kind: Kind = "note", picture: str = "") -> None:
        self.journal.note(self.mission.id, Entry(self.now, self.shown.state, cause, evidence, kind, picture))

    @property
    def viewpoints(self) -> Viewpoints:
        """Where the robot's head camera may look from."""
        return viewpoints_of(self.io.scene, self.io.latest(topics.ROBOT_DESCRIPTION))

    @property
    def robot_pose(self) -> Pose2:
        """The robot's pose in the map as navigation believes it; the origin before it has said so."""
        pose = self.io.latest(topics.POSE)
        return (pose.x, pose.y, pose.theta) if pose else (0.0, 0.0, 0.0)

    # --- the journal
    def save(self, closed: bool = False) -> None:
        """Put on disk how the mission stands, if that has changed; before anything of it is said to others."""
        if not self.mission.command:
            return
        state = self.standing(closed)
        body = msgspec.json.encode(state)
        if body == self._saved or (body == self._refused and self.now < self._again_at and not closed):
            return
        self._located(state)
        if self.journal.save(state):
            self._saved = body
        else:
            self._refused, self._again_at = body, self.now + SAVE_AGAIN

    def standing(self, closed: bool = False) -> Checkpoint:
        """How the mission stands."""
        path = path_to(self.at) if self.at is not None else []
        if path != self._path:
            self._path, self.resumes = path, 0
        return Checkpoint(
            mission=self.mission,
            gripper=msgspec.structs.replace(self.gripper, empty_since=None),
            path=path,
            sent=[sent for channel in self.channels if (sent := channel.outstanding_goal())],
            run=self.config.run,
            closed=closed,
            resumes=self.resumes,
            suspended=self.suspended,
        )

    def _located(self, state: Checkpoint) -> None:
        here = self.io.latest(topics.POSE)
        state.t, state.base = self.now, (here.x, here.y, here.theta) if here else None

    def bookmark(self) -> Checkpoint:
        """A copy of how the mission stands that nothing changes any more."""
        state = self.standing()
        self._located(state)
        state.date = unix_time()
        return msgspec.json.decode(msgspec.json.encode(state), type=Checkpoint)

    def placed(self, at: Behaviour, resumes: int) -> None:
        """A mission has been taken up again at this node."""
        self.at, self._path, self.resumes = at, path_to(at), resumes

    def _fresh_id(self) -> str:
        """Never one that another process of this brain has used; in lockstep `new_id` begins anew with each."""
        boot = self.journal.boot
        return self.io.new_id(f"mission-{boot}" if self.io.lockstep and boot > 1 else "mission")

    # --- the mission
    def renew_mission(self) -> None:
        """A fresh mission once the last one has ended."""
        if self.mission.outcome is not None:
            self.save()
            self.mission, self.resumes = Mission(id=self._fresh_id()), 0

    def start_mission(self, text: str, confidence: float, source: str, confirmed: bool = False) -> None:
        """The mission begins with this command."""
        mission = self.mission
        self.reply = None
        mission.confirmed = confirmed
        mission.command, mission.confidence, mission.started = text, confidence, self.now
        self.suspended = None
        self.journal.begin(mission)
        self.note(f"{source}: {text}", f"confidence {confidence:.2f}", "heard")
        self.save()

    def record_failure(self, failure: Failure) -> None:
        self.mission.failure = failure
        self.note(failure.stage.lower(), failure.reason, "failed")
        self.io.log.warning("step failed", stage=failure.stage, code=failure.code, detail=failure.detail)

    def end_mission(self, outcome: Outcome, reason: str) -> None:
        """The mission's outcome; shown with the next state."""
        mission = self.mission
        mission.outcome = outcome
        failure = mission.ended_by
        self.last = m.MissionOutcome(
            id=mission.id,
            command=mission.command,
            outcome=outcome,
            reason=reason,
            t=self.now,
            stage=failure.stage,
            code=failure.code,
            spoken=failure.spoken,
        )
        self.note(outcome, reason, "did" if outcome == "delivered" else "note")
        self.journal.end(mission, outcome, reason, self.now)
        self.save()
        self.io.log.info("mission ended", outcome=outcome, reason=reason)

    def send_only(self, channel: Channel, topic: Topic[Any], text: str) -> str:
        """Send a goal nobody waits for; returns its id."""
        goal_id = self.mission.next_goal()
        channel.send_only(topic, topic.type(goal=text, id=goal_id))
        return goal_id

    def stop_all(self) -> None:
        """Tell every peer of an ended mission to stop what it does for it."""
        if self.speech.outstanding:
            self.send_only(self.speech, topics.SPEECH_GOAL, "cancel")
        self.send_only(self.navigation, topics.NAVIGATION_GOAL, "stop")
        self.send_only(self.manipulation, topics.MANIPULATION_GOAL, "stop")

    def known_object(self, label: str) -> m.WorldObject | None:
        """The object of that name as last surveyed."""
        world = self.io.latest(topics.WORLD_OBJECTS)
        return next((o for o in world.objects if o.label == label), None) if world else None


def _same(a: m.BrainState, b: m.BrainState) -> bool:
    return msgspec.structs.replace(a, t=0.0) == msgspec.structs.replace(b, t=0.0)


def _outcome(journal: Journal) -> m.MissionOutcome | None:
    """How the last mission ended, also one of an earlier process."""
    last = journal.last()
    if last is None or last.outcome is None:
        return None
    return m.MissionOutcome(
        id=last.id,
        command=last.command,
        outcome=last.outcome,
        reason=last.reason,
        t=last.ended,
        stage=last.stage,
        code=last.code,
        spoken=last.spoken,
    )
