"""Leaves before a mission: until the robot is ready, somebody says something, or has been heard."""

from collections.abc import Callable

from py_trees.common import Status

from common import messages as m
from common import topics
from services.brain.mission.channel import Result
from services.brain.mission.context import Context
from services.brain.mission.mission import Failure
from services.brain.steps.hear_speech import HearSpeech
from services.brain.steps.leaf import Leaf


class Ready(Leaf):
    """IDLE until fresh joint states flow, speech is there, and the robot is not stopped."""

    def update(self) -> Status:
        ctx = self.ctx
        if ctx.stopped is not None:
            missing = (
                f"stopped ({ctx.stopped}); waiting for robot/resume" if ctx.stopped else "waiting for robot/resume"
            )
        elif not ctx.heartbeat.fresh(ctx.now):
            missing = "waiting for joint_states"
        elif not ctx.mission.active and not ctx.io.has_subscribers(topics.SPEECH_GOAL):
            missing = "waiting for speech"
        else:
            return Status.SUCCESS
        ctx.show_state("IDLE", detail=missing)
        self.feedback_message = missing
        return Status.RUNNING


class Wait(Leaf):
    """WAITING: for the pause before listening to end, or for a command from anybody."""

    def __init__(self, node_id: str, ctx: Context, ends: Callable[[], bool]) -> None:
        super().__init__(node_id, ctx)
        self._ends = ends

    def update(self) -> Status:
        ctx = self.ctx
        ctx.renew_mission()
        if not ctx.mission.active:
            ctx.show_state("WAITING")
        take_command(ctx)
        return Status.SUCCESS if ctx.mission.active or self._ends() else Status.RUNNING


class Listen(HearSpeech):
    """Hears a command; silence and `ERROR` cost the pause before the next listening, not a mission."""

    def __init__(self, node_id: str, ctx: Context) -> None:
        limit = ctx.config.listen_timeout + ctx.config.listen_grace
        super().__init__(node_id, ctx, ctx.peers.speech, state="LISTENING", timeout=limit)

    def update(self) -> Status:
        ctx = self.ctx
        if not ctx.mission.active and take_command(ctx):
            self.need_not_listen()
        return Status.SUCCESS if ctx.mission.active else super().update()

    def step(self) -> str:
        return "listen"

    def succeed(self, result: Result) -> Status:
        ctx, heard = self.ctx, result.message
        assert isinstance(heard, m.SpeechResult)
        ctx.start_mission(m.VoiceCommand(text=heard.text, confidence=heard.confidence), "heard")
        return Status.SUCCESS

    def fail_with(self, failure: Failure) -> Status:
        self.pause()
        self.ctx.io.log.info("nothing heard", code=failure.code, detail=failure.detail)
        return Status.FAILURE


def take_command(ctx: Context) -> bool:
    """Begin the mission of a waiting `voice_command`, if there is one."""
    command, source = ctx.voice.take_command(), "voice_command"
    if command is None and ctx.mission.queued:
        command, source = ctx.mission.queued.pop(0), "queued"
    if command is None:
        return False
    ctx.start_mission(command, source)
    return True
