"""What the leaves of both trees share: time, bus, mission, gripper, peers, and what is shown to the world."""

import re
from itertools import pairwise

from py_trees.common import Status

from common import messages as m
from common import topics
from common.bus.port import Io
from common.geometry import Array, Mask, Pose2
from common.language.contractions import expand
from common.language.meaning import is_question
from common.language.normalise import normalise as spelled
from common.language.place_told import with_whereabouts
from common.naming.names import normalise
from common.naming.place_named import FLOOR, place_named, take_place
from common.plan_rules import known_world
from common.viewpoints import Viewpoints, viewpoints_of
from common.whereabouts import likelihood, points_at
from services.brain.config import BrainConfig
from services.brain.home.keeper import HouseholdKeeper
from services.brain.home.sighting_log import SightingLog
from services.brain.journal.checkpoints import Checkpoints
from services.brain.journal.open import open_pictures
from services.brain.journal.records import Checkpoint, Entry, Journal, Kind, last_outcome, outcome_of
from services.brain.mission.channel import Channel
from services.brain.mission.display import Display
from services.brain.mission.heartbeat import Heartbeat
from services.brain.mission.mission import Failure, GripperState, Heard, Mission, Outcome
from services.brain.mission.peers import Peers
from services.brain.mission.voice import Voice
from services.brain.tree.path import plan_step
from services.brain.world.floor_views import floor_views


class Context:
    """One per brain; `now` [s of robot time] is set before every tick of the tree.

    `previous`: the last mission that was about objects, for commands that refer to it.
    `stopped`: why the robot is stopped, None when it is not. `suspended`: the mission that a stop has interrupted.
    """

    def __init__(self, config: BrainConfig, io: Io, journal: Journal) -> None:
        self.config, self.io, self.journal = config, io, journal
        self.pictures = open_pictures(config, io)
        self.heartbeat = Heartbeat(io)
        self.voice = Voice()
        self.peers = Peers(io, before_send=self.save)
        self.checkpoints = Checkpoints(journal, io, self.peers, config.run)
        self.now = 0.0
        self.mission = Mission(id=self._fresh_id())
        self.gripper = GripperState()
        self.previous: Mission | None = None
        self.suspended: Checkpoint | None = None
        self._said = self._said_before = ""
        self.stopped: str | None = None
        self.home, self.sightings = HouseholdKeeper(io), SightingLog(io)
        self.display = Display(io, config.pipeline, last_outcome(journal))

    # --- what the world is told
    @property
    def state(self) -> m.BrainStateName:
        """The state as shown on `brain/state`."""
        return self.display.shown.state

    def show_state(self, state: m.BrainStateName, step: str = "", detail: str = "") -> None:
        """Show a state; a change is published at once and noted in the journal."""
        number, resumable = plan_step(self.checkpoints.at), self.suspended is not None
        before = self.display.show(self.mission, self.now, state, step, detail, number, resumable)
        if before is not None and (before.state != state or before.step != step):
            self.note(step or state, detail, "state")
            shown = self.display.shown
            self.io.log.info("state", mission=shown.mission_id, state=state, step=step, detail=detail, was=before.state)

    def note(self, cause: str, evidence: str = "", kind: Kind = "note", picture: str = "") -> None:
        """Add an entry to the mission's timeline."""
        self.journal.note(self.mission.id, Entry(self.now, self.state, cause, evidence, kind, picture))

    # --- what the world tells
    @property
    def viewpoints(self) -> Viewpoints:
        """Where the robot's head camera may look from."""
        return viewpoints_of(self.io.household, self.io.latest(topics.ROBOT_DESCRIPTION))

    @property
    def robot_pose(self) -> Pose2:
        """Pose (x, y, theta) [m, rad] in map as navigation estimates it; the origin before the first estimate."""
        pose = self.io.latest(topics.POSE)
        return (pose.x, pose.y, pose.theta) if pose else (0.0, 0.0, 0.0)

    def likelihood(self, item: str) -> Array:
        """How likely an item is at each of the viewpoints' points (p,), by what was seen over the days."""
        return likelihood(item, self.io.household, self.sightings.rows, self.sightings.date, self.viewpoints)

    def told_place(self, item: str) -> str:
        """Where the person said that the item is, as `take_place` has it, be it in a sentence of its own; "" for
        nowhere."""
        home, mission = self.io.household, self.mission
        place, _ = take_place(normalise(mission.search.chosen.get(item, item)), home)
        gone = (
            a.target
            for a, b in pairwise(mission.planning.steps)
            if a.action == "navigate" and b.action == "find" and b.object == item
        )
        if place := place or place_named(normalise(next(gone, "")), home):
            return place
        words = dict.fromkeys((mission.command, mission.heard.words))
        told = ". ".join(with_whereabouts(expand(spelled(text, ",.;?!"))) for text in words)
        said = (take_place(normalise(part), home) for part in re.split(r"[.,;?!]", told))
        beside = (at for at, thing in said if f" {thing}".endswith(f" {normalise(item)}"))
        return next((at for at in beside if at != mission.destination(item)), "")

    def told_points(self, item: str) -> Mask:
        """Which of the viewpoints' points (p,) are where the person said that the item is."""
        return points_at(self.told_place(item), self.io.household, self.viewpoints)

    def told_floor(self, item: str) -> Viewpoints | None:
        """Views of the floor where the person said that the item lies there, or is in a room."""
        place, rooms = self.told_place(item), self.io.household.rooms
        there = tuple(r for r in rooms if place in (FLOOR, r.name, f"{r.name} {FLOOR}"))
        return floor_views(self.viewpoints, there) if there else None

    @property
    def objects(self) -> list[m.WorldObject]:
        """The objects of perception's last `world/objects`; [] before the first."""
        world = self.io.latest(topics.WORLD_OBJECTS)
        return world.objects if world else []

    def known_object(self, label: str) -> m.WorldObject | None:
        """The object of that name as last surveyed."""
        return next((o for o in self.objects if o.label == label), None)

    def known_world(self) -> m.KnownWorld:
        """What the planner is told and plans are checked against."""
        seen, taught = self.objects, self.io.latest(topics.HOUSEHOLD_NAMES)
        named = {name for o in seen for name in o.names}
        # What was taught and is not in sight is an object all the same.
        hidden = [one.name for one in taught.names if one.name not in named] if taught else []
        return known_world(self.io.household, [*(o.label for o in seen), *hidden], self.gripper.holding)

    def origin_of(self, label: str) -> str:
        """The receptacle on which an object that was found in this mission stood, "" if nobody knows."""
        found = next((p for p in self.mission.search.found.values() if p.label == label and p.on), None)
        known = self.known_object(label)
        return found.on if found is not None else known.on if known is not None else ""

    def history(self, at_work: bool = False) -> m.History:
        """What commands may refer to; `at_work`: the mission under way is a part of it, not the one that asks."""
        ended = [r for r in self.journal.missions() if r.outcome is not None and not is_question(r.command)]
        return m.History(
            doing=self.mission.command if at_work else "",
            step=self.display.shown.step if at_work else "",
            last=outcome_of(ended[-1]) if ended else None,
            objects=self.mission.handled if at_work else self.previous.handled if self.previous else [],
            taken_from=self.gripper.taken_from,
            said=self._said if at_work else self._said_before,
        )

    # --- the journal
    def save(self, closed: bool = False) -> None:
        """Put on disk how the mission stands, if that has changed; before anything of it is said to others."""
        if self.mission.command:
            self.checkpoints.save(self.mission, self.gripper, self.suspended, self.now, closed)

    def frozen_checkpoint(self) -> Checkpoint:
        """A copy of how the mission stands that nothing changes any more."""
        return self.checkpoints.frozen(self.mission, self.gripper, self.suspended, self.now)

    def _fresh_id(self) -> str:
        """Never one that another process of this brain has used; in lockstep `new_id` begins anew with each."""
        boot = self.journal.boot
        return self.io.new_id(f"mission-{boot}" if self.io.lockstep and boot > 1 else "mission")

    # --- the mission
    def renew_mission(self) -> None:
        """A fresh mission once the last one has ended."""
        if self.mission.outcome is not None:
            self.save()
            before = self.mission
            self.previous = before if before.handled else self.previous
            self.mission, self.checkpoints.resumes = Mission(id=self._fresh_id(), queued=before.queued), 0

    def start_mission(self, command: m.VoiceCommand, source: str) -> None:
        """The mission begins with this command; `source`: who brought it, for the timeline."""
        mission = self.mission
        self.voice.reply = None
        self._said_before = self._said
        mission.heard = Heard(
            confidence=command.confidence,
            confirmed=command.confirmed,
            question=command.question,
            alternatives=[] if command.confirmed else command.alternatives,
            words=command.text.strip(),
        )
        mission.command, mission.started = command.text.strip(), self.now
        mission.command_id = command.id
        self.suspended = None
        self.journal.begin(mission)
        self.note(f"{source}: {mission.command}", f"confidence {command.confidence:.2f}", "heard")
        self.save()

    def record_failure(self, failure: Failure) -> None:
        """Keep why a step failed: recoveries and the report at the end read it."""
        self.mission.failure = failure
        self.note(failure.stage.lower(), failure.reason, "failed")
        self.io.log.warning("step failed", stage=failure.stage, code=failure.code, detail=failure.detail)

    def fail(self, stage: str, code: str, detail: str = "", spoken: str = "") -> Status:
        """Keep why a step fails, and let it."""
        self.record_failure(Failure(stage, code, detail, spoken))
        return Status.FAILURE

    def end_mission(self, outcome: Outcome, reason: str) -> None:
        """End the mission; shown with the next state."""
        self.mission.outcome = outcome
        self.display.ended(self.mission, outcome, reason, self.now)
        self.note(outcome, reason, "did" if outcome == "delivered" else "note")
        self.journal.end(self.mission, outcome, reason, self.now)
        self.save()
        self.io.log.info("mission ended", outcome=outcome, reason=reason)

    # --- goals that nobody waits for
    def send_only(self, channel: Channel, text: str) -> str:
        """Send a goal in words whose result nobody awaits; returns its id."""
        goal_id = self.mission.next_goal()
        assert channel.words is not None
        channel.send_only(channel.words, channel.words.type(goal=text, id=goal_id))
        return goal_id

    def say(self, text: str) -> str:
        """Have something said that nobody waits for; returns the goal's id."""
        self._said = text
        return self.send_only(self.peers.speech, f"say {text}")

    def stop_all(self) -> None:
        """Tell every peer of an ended mission to stop what it does for it."""
        self.cancel_speech()
        self.send_only(self.peers.navigation, "stop")
        self.send_only(self.peers.manipulation, "stop")

    def cancel_speech(self) -> None:
        """Tell speech to stop listening, if it was asked to."""
        if self.peers.speech.outstanding:
            self.send_only(self.peers.speech, "cancel")
