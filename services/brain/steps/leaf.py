"""Leaves that every tree uses, on the robot's clock. Every wait has an end."""

from collections.abc import Callable
from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from common import messages as m
from common import topics
from common.topic import Topic
from services.brain.mission.channel import Channel, Result
from services.brain.mission.context import Context
from services.brain.mission.mission import Failure
from services.brain.tree.composites import shown

MAX_RESENDS = 5
"""Restarts of a peer during one goal that are made up for (chosen: a crash loop has more)."""
SPEECH_START, SPEECH_PER_CHARACTER = 1.0, 0.07
"""s before speech begins and s per character of it (chosen: some 14 characters a second, ordinary speech)."""


class Leaf(Behaviour):
    """A leaf that knows the context and when it began."""

    def __init__(self, node_id: str, ctx: Context, name: str = "") -> None:
        super().__init__(shown(node_id, name))
        self.node_id, self.ctx = node_id, ctx
        self.since = 0.0

    def initialise(self) -> None:
        self.since = self.ctx.now
        self.feedback_message = ""

    @property
    def elapsed(self) -> float:
        """Seconds of robot time since the leaf began."""
        return self.ctx.now - self.since


class Settle(Leaf):
    """Lets physics come to rest before the next goal, or waits for longer when `seconds` say so."""

    def __init__(self, node_id: str, ctx: Context, name: str = "", seconds: float = 0.0) -> None:
        super().__init__(node_id, ctx, name)
        self._seconds = seconds

    def update(self) -> Status:
        enough = max(self._seconds, self.ctx.config.settle)
        return Status.SUCCESS if self.elapsed >= enough else Status.RUNNING


class Call(Leaf):
    """Calls a function once; SUCCESS unless it returns False."""

    def __init__(self, node_id: str, ctx: Context, act: Callable[[], bool | None]) -> None:
        super().__init__(node_id, ctx)
        self._act = act

    def update(self) -> Status:
        return Status.FAILURE if self._act() is False else Status.SUCCESS


class SendGoal(Leaf):
    """Sends one goal to one peer and waits for its final word.

    Sent once a peer subscribes. Sent again with the next attempt after `failed` (at most `retries` times, a settle
    later) and after the peer's process was replaced. Subclasses say what to send and what the answer means.
    """

    def __init__(
        self,
        node_id: str,
        ctx: Context,
        channel: Channel,
        *,
        state: m.BrainStateName,
        timeout: float,
        retries: int = 0,
        name: str = "",
    ) -> None:
        super().__init__(node_id, ctx, name)
        self.channel, self.state = channel, state
        self._timeout, self._retries = timeout, retries
        self._sent_at: float | None = None
        self._again_at: float | None = None
        self._tries = self._resends = 0

    # --- for subclasses
    def goal(self, goal_id: str) -> tuple[Topic[Any], m.Message]:
        raise NotImplementedError

    def step(self) -> str:
        """The step as shown on `brain/state`."""
        return self.name

    def spoken(self) -> str:
        """What to say when this fails for good."""
        return f"I could not {self.name}."

    def succeed(self, result: Result) -> Status:
        return Status.SUCCESS

    def try_again(self, code: str) -> bool:
        """After a failure with `code`: the goal is sent once more."""
        return self._tries < self._retries

    def unfinished(self) -> None:
        """The goal was cut short or timed out: its effect on the world is unknown."""

    def fail_with(self, failure: Failure) -> Status:
        self.ctx.record_failure(failure)
        return Status.FAILURE

    # --- lifecycle
    def initialise(self) -> None:
        super().initialise()
        self._sent_at = self._again_at = None
        self._tries = self._resends = 0

    def update(self) -> Status:
        ctx, channel = self.ctx, self.channel
        ctx.checkpoints.at = self
        if self._again_at is not None:
            if ctx.now < self._again_at:
                return Status.RUNNING
            self._again_at, self._sent_at = None, ctx.now
            channel.retry()
            return Status.RUNNING
        if self._sent_at is None:
            return self._resume_goal() if channel.resuming else self._send()
        result = channel.result
        if result is not None and result.status == "ok":
            channel.abandon()
            if isinstance(result.message, m.NavigationStatus | m.NavigationFeedback | m.ManipulationStatus):
                ctx.note(f"{channel.peer}: {result.message.status}", result.detail, "did")
            return self.succeed(result)
        if result is not None and result.status == "failed":
            return self._failed(result.code or "FAILED", result.detail)
        if channel.restarted:
            return self._resend()
        if channel.gone(ctx.now) > ctx.config.peer_timeout:
            return self._failed("NO_PEER", f"{channel.peer} is gone")
        if ctx.now - self._sent_at > self._timeout:
            self.unfinished()
            return self._failed("TIMEOUT", f"no answer in {self._timeout:.0f} s")
        if result is not None:
            self.feedback_message = result.detail
        return Status.RUNNING

    def terminate(self, new_status: Status) -> None:
        if new_status == Status.INVALID and self.status == Status.RUNNING:
            if self._sent_at is not None:
                self.unfinished()
            self.channel.abandon()

    def _send(self) -> Status:
        ctx = self.ctx
        ctx.show_state(self.state, self.step())
        topic, message = self.goal(f"{ctx.mission.id}.{ctx.mission.goals + 1}")
        if not ctx.io.has_subscribers(topic):
            if max(self.elapsed, self.channel.gone(ctx.now)) > ctx.config.peer_timeout:
                return self._failed("NO_PEER", f"{self.channel.peer} does not answer")
            self.feedback_message = f"waiting for {self.channel.peer}"
            return Status.RUNNING
        ctx.mission.next_goal()
        self.channel.send_goal(topic, message)
        self._sent_at = ctx.now
        self.feedback_message = ""
        return Status.RUNNING

    def _resume_goal(self) -> Status:
        """Go on with the goal that this brain had sent before it was restarted."""
        ctx, channel = self.ctx, self.channel
        channel.resuming = False
        self._sent_at = ctx.now
        ctx.show_state(self.state, self.step())
        if channel.result is None and not channel.restarted:
            channel.resend()
        return Status.RUNNING

    def _resend(self) -> Status:
        self._resends += 1
        if self._resends > MAX_RESENDS:
            return self._failed("NO_PEER", f"{self.channel.peer} keeps restarting")
        self.ctx.note(f"{self.channel.peer} restarted", f"attempt {self.channel.attempt + 1}")
        self.channel.retry()
        self._sent_at = self.ctx.now
        return Status.RUNNING

    def _failed(self, code: str, detail: str) -> Status:
        again = self.try_again(code)
        self.channel.abandon()
        failure = Failure(stage=self.state, code=code, detail=detail, spoken=self.spoken())
        if again and not failure.permanent:
            self._tries += 1
            self._again_at = self.ctx.now + self.ctx.config.settle
            self.feedback_message = f"retry {self._tries} after {code}"
            self.ctx.note(f"{self.step()}: {self.feedback_message}", detail)
            return Status.RUNNING
        self.feedback_message = code
        return self.fail_with(failure)


class Say(Leaf):
    """Speaks without depending on speech: ends when speech has spoken, or after as long as the words take."""

    def __init__(self, node_id: str, ctx: Context, text: Callable[[], str], name: str = "") -> None:
        super().__init__(node_id, ctx, name)
        self._text = text
        self._goal_id = ""
        self._heard = False
        self._estimate = 0.0

    def initialise(self) -> None:
        super().initialise()
        ctx, text = self.ctx, " ".join(self._text().split())
        self._heard, self._goal_id = False, ""
        if text and ctx.io.has_subscribers(topics.SPEECH_GOAL):
            self._goal_id = ctx.say(text)
        self._estimate = min(SPEECH_START + SPEECH_PER_CHARACTER * len(text), ctx.config.say_timeout)
        self.feedback_message = text

    def update(self) -> Status:
        if not self._goal_id:
            return Status.SUCCESS
        status = self.ctx.voice.speaking
        speaking = status is not None and status.goal_id == self._goal_id and status.state == "speaking"
        if self._heard and not speaking:
            return Status.SUCCESS
        self._heard = self._heard or speaking
        limit = self.ctx.config.say_timeout if self._heard else self._estimate
        return Status.SUCCESS if self.elapsed >= limit else Status.RUNNING
