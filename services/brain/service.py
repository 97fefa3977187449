"""The brain: receives, ticks the tree, shows state and tree."""

import msgspec
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from common import messages as m
from common import topics
from common.bus.port import Io
from common.language.meaning import asks_for
from common.language.normalise import normalise
from common.time.clock import unix_time
from services.brain.config import BrainConfig
from services.brain.journal.open import open_journal
from services.brain.journal.pictures import MissionQueries
from services.brain.mission.asides import Asides
from services.brain.mission.context import Context
from services.brain.mission.mission import Failure, gripper_holds
from services.brain.mission.remarks import Remarks
from services.brain.mission.statuses import receive_statuses
from services.brain.mission.voice import Offers
from services.brain.pipelines.fetch import fetch_tree
from services.brain.pipelines.vla import vla_tree
from services.brain.resume.resumption import Resumption, suspend
from services.brain.tree.path import tip
from services.brain.tree.snapshot import Seen, snapshot


class BrainService:
    """Orchestrates speech, navigation and manipulation into missions."""

    NAME = "brain"
    HZ = 20
    CONFIG = BrainConfig
    READS, WRITES = topics.subscribed(NAME), topics.published(NAME)

    def __init__(self, config: BrainConfig, io: Io) -> None:
        self._io = io
        self._journal = open_journal(config, io)
        self.context = Context(config, io, self._journal)
        self.tree = {"fetch": fetch_tree, "vla": vla_tree}[config.pipeline](self.context)
        self._seen = Seen()
        self._ticks = 0
        self._sim_stopped = False
        self._asides = Asides(self.context)
        self._remarks = Remarks(self._asides.speak)
        self._resumption = self._unfinished()
        self._offers = Offers(self.context.mission.command_id)
        io.serve(topics.BRAIN_MISSIONS, MissionQueries(self._journal, self.context.pictures).answer)

    def step(self, now: float) -> None:
        self.context.heartbeat.stalled = 0.0
        self._step(now)

    def stalled(self, seconds: float) -> None:
        """Robot time has stood still for `seconds` of wall time: a step at the same moment if the simulation is gone.

        With its token there it pauses or waits for a participant; with nobody there this process is cut off itself.
        """
        ctx, peer = self.context, self._io.peer
        if peer("sim") is None and any(peer(channel.peer) is not None for channel in ctx.peers.all):
            ctx.heartbeat.stalled = seconds
            self._step(ctx.now)

    def _step(self, now: float) -> None:
        ctx = self.context
        ctx.now = now
        for channel in ctx.peers.all:
            channel.watch(now)
        ctx.gripper.update(gripper_holds(self._io.latest(topics.JOINT_STATES)), now)
        receive_statuses(ctx, self._asides, self._remarks)
        self._receive_stops()
        ctx.home.step(ctx.robot_pose)
        ctx.sightings.step(now)
        self._receive_commands()
        self._asides.step()
        self._remarks.step(now)
        self._watch_heartbeat()
        if self._resumption is not None and self._resumption.step():
            if self._resumption.suspended:
                ctx.suspended = suspend(self._resumption.left, ctx.mission, ctx.gripper)
            self._resumption = None
        ticked = list[Behaviour]()
        if self._resumption is None:
            ticked.extend(self.tree.tick())
            for channel in ctx.peers.all:
                if channel.resuming:  # no leaf has gone on with it
                    channel.abandon()
            ctx.checkpoints.at = tip(self.tree)
            ctx.save()
        self._ticks += 1
        if self._seen.changed(self.tree, ticked):
            self._io.publish(topics.BRAIN_TREE, snapshot(self.tree, now, self._ticks))

    def close(self) -> None:
        """An orderly end; the journal says so."""
        if self._resumption is None:
            self.context.save(closed=True)
        self.context.sightings.save(self.context.now)
        self._journal.close()

    def _unfinished(self) -> Resumption | None:
        """The mission that the process before this one did not end; what it held in its hand in any case."""
        left = self._journal.checkpoint()
        if left is None:
            return None
        record = self._journal.mission(left.mission.id)
        if left.mission.active and (record is None or record.outcome is None):
            return Resumption(self.context, self.tree, left)
        self.context.gripper, self.context.suspended = left.gripper, left.suspended
        self.context.previous = left.mission if left.mission.handled else None
        return None

    # --- the robot's body
    def _watch_heartbeat(self) -> None:
        """Without joint states nothing goes on: a mission is suspended, what waits for a command returns to IDLE."""
        ctx = self.context
        if self._resumption is not None or ctx.heartbeat.fresh(ctx.now):
            return
        if ctx.mission.active:
            self._suspend()
        elif ctx.state not in ("IDLE", "COMPLETED", "ERROR"):
            self._interrupt("no joint_states")

    def _suspend(self) -> None:
        """Stop base and arm as far as anybody hears it, and take the mission up again when joint states return."""
        ctx = self.context
        left = ctx.frozen_checkpoint()
        self._io.log.error("joint_states lost: the mission is suspended", state=ctx.state, step=ctx.display.shown.step)
        ctx.stop_all()
        self.tree.stop(Status.INVALID)
        self._resumption = Resumption(
            ctx, self.tree, suspend(left, ctx.mission, ctx.gripper), why="joint_states lost: base and arm told to stop"
        )

    # --- people
    def _receive_stops(self) -> None:
        """Stop and resume with the brake of the robot."""
        ctx, io = self.context, self._io
        for status in io.take_all(topics.SIM_STATUS):
            stopped = status.state == "stopped"
            if stopped != self._sim_stopped and status.state != "paused":
                self._sim_stopped = stopped
                ctx.stopped = (ctx.stopped or status.detail) if stopped else None
        for stop in io.take_all(topics.ROBOT_STOP):
            ctx.stopped = stop.reason
        resumes = io.take_all(topics.ROBOT_RESUME)
        if resumes:
            ctx.stopped = None
        if ctx.stopped is not None and ctx.state != "IDLE":
            self._stop("stopped" + (f": {ctx.stopped}" if ctx.stopped else ""))
        elif ctx.stopped is None and any(r.go_on for r in resumes):
            self._go_on()

    def _stop(self, reason: str) -> None:
        """Interrupt, and keep what is needed to go on when somebody asks for it."""
        left = self.context.frozen_checkpoint() if self.context.mission.active else None
        self._interrupt(reason)
        if left is not None:
            self.context.suspended = suspend(left, self.context.mission, self.context.gripper)

    def _go_on(self) -> None:
        """Go on with the suspended mission, unless something else has begun meanwhile."""
        ctx, left = self.context, self.context.suspended
        ctx.suspended = None
        if left is None or ctx.mission.active or self._resumption is not None:
            self._io.log.info("no mission to go on with")
            return
        ctx.cancel_speech()
        self.tree.stop(Status.INVALID)
        if left.run and left.run == ctx.config.run:
            left.date = unix_time()  # as long as the robot is up it may stand as long as people like
        self._resumption = Resumption(ctx, self.tree, left)

    def _receive_commands(self) -> None:
        """Start, answer or interrupt a mission by what people said."""
        ctx = self.context
        for unclear in self._io.take_all(topics.SPEECH_UNCLEAR):
            self._asides.weigh(unclear)
        for command in self._io.take_all(topics.VOICE_COMMAND):
            words = normalise(command.text)
            asked = asks_for(words, "stop", "cancel", "come_back")
            open_for_it = ctx.state in m.OPEN_STATES
            if command.withdraws:
                self._withdraw(command.withdraws)
            elif command.unless_busy and not self._offers.accept(command, open_for_it and ctx.voice.command is None):
                self._io.log.info("offer not taken", text=command.text, state=ctx.state)
            elif not words:
                self._io.count_drop(topics.VOICE_COMMAND.key, "no words")
            elif command.question:
                self._receive_question(command)
            elif ctx.mission.active and asked:
                self._interrupt("asked to come back" if asked == "come_back" else f"called off: {words}")
                ctx.voice.command = command if asked == "come_back" else None
            elif asked in ("stop", "cancel"):
                ctx.voice.command = None
            elif ctx.state == "CONFIRMING":
                ctx.voice.reply = m.SpeechResult(text=command.text, confidence=command.confidence)
            elif open_for_it:
                ctx.voice.command = command
            elif ctx.mission.active and ctx.config.pipeline == "vla":
                self._interject(command)
            else:
                self._io.log.warning("command ignored", text=command.text, state=ctx.state)

    def _withdraw(self, command_id: str) -> None:
        """Somebody else carries the command out, or nobody: end its mission, forget it where it waits."""
        ctx = self.context
        self._offers.withdraw(command_id)
        mission, waiting = ctx.mission, ctx.voice.command
        mission.queued = [c for c in mission.queued if c.id != command_id]
        if waiting is not None and waiting.id == command_id:
            ctx.voice.command = None
        if ctx.suspended is not None and ctx.suspended.mission.command_id == command_id:
            ctx.suspended = None
        if mission.active and mission.command_id == command_id:
            self._interrupt("withdrawn: it was given to another robot")

    def _interject(self, command: m.VoiceCommand) -> None:
        """What is said to a robot at work: a question or a command for later goes beside, another command instead."""
        if (said := self._asides.hear(command)) is not None:
            self._interrupt(f"asked for something else: {said.text}")
            self._asides.replaced(said.text)
            self.context.voice.command = msgspec.structs.replace(command, text=said.text, alternatives=[])

    def _receive_question(self, command: m.VoiceCommand) -> None:
        """Put a client's question to the person, when nothing else is under way: it answers and stops nothing."""
        ctx = self.context
        if ctx.config.pipeline == "vla" and ctx.state in m.OPEN_STATES:
            ctx.voice.command = command
        else:
            self._io.log.warning("question ignored", text=command.text, state=ctx.state)

    def _interrupt(self, reason: str) -> None:
        """End the mission under way and everything that is done for it."""
        ctx = self.context
        if ctx.mission.active:
            ctx.stop_all()
            self.tree.stop(Status.INVALID)
            ctx.mission.failure = Failure(ctx.state, "CANCELLED", reason)
            ctx.mission.queued.clear()
            ctx.end_mission("cancelled", reason + ctx.gripper.note)
        else:
            ctx.cancel_speech()
            self.tree.stop(Status.INVALID)
        ctx.voice.listen_after = ctx.now + ctx.config.settle
        ctx.voice.command = None
