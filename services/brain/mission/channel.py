"""Goals under way: which status counts as their result, and when a goal has to be sent again."""

from collections import deque
from collections.abc import Callable
from typing import Any, Literal

import msgspec

from common import messages as m
from common.bus.port import Io
from common.topic import Topic
from common.topics import BY_KEY

GoalStatus = Literal["busy", "ok", "failed"]
RECENT = 32
"""Goals remembered per peer (chosen: many times what can be under way), to tell late statuses from strangers'."""


class Result(msgspec.Struct, frozen=True):
    """How the goal under way stands according to its peer; `message` is what the peer sent."""

    status: GoalStatus
    code: str = ""
    detail: str = ""
    message: m.Message | None = None


class SentGoal(msgspec.Struct, frozen=True):
    """A goal under way as the journal keeps it: who received it, on which key, and that process's epoch."""

    peer: str
    key: str
    message: dict[str, Any]
    epoch: str = ""


class Channel:
    """One goal at a time to one peer process.

    A status counts when it names the outstanding goal and attempt. A peer of bare texts names none: its statuses count
    for whatever is outstanding. Nothing counts that arrived before the goal was sent. `words`: where the peer takes
    goals in words, as `stop` is one.
    """

    def __init__(self, io: Io, peer: str, words: Topic[Any] | None = None) -> None:
        self._io, self.peer, self.words = io, peer, words
        self.before_send: Callable[[], None] = lambda: None
        self.resuming = False
        self.goal_id = ""
        self.attempt = 0
        self.result: Result | None = None
        self._topic: Topic[Any] | None = None
        self._message: Any = None
        self._epoch = self._known = ""
        self._gone_since: float | None = None
        self._recent: deque[str] = deque(maxlen=RECENT)

    @property
    def outstanding(self) -> bool:
        """A goal was sent and has neither ended nor been abandoned."""
        return bool(self.goal_id)

    def send_goal(self, topic: Topic[Any], message: Any) -> None:
        """Send a new goal, whose `id` must be fresh, and await its result."""
        self.goal_id, self.attempt, self.result = message.id, getattr(message, "attempt", 0), None
        self._recent.append(message.id)
        self._topic, self._message = topic, message
        present = self._io.peer(self.peer)
        self._epoch = self._known if present is None else present
        self.before_send()
        self._io.publish(topic, message)

    def send_only(self, topic: Topic[Any], message: Any) -> None:
        """Send a goal whose result nobody awaits."""
        self._recent.append(message.id)
        self._io.publish(topic, message)

    def retry(self) -> None:
        """Send the same goal with the next attempt number."""
        if self._topic is None:
            raise RuntimeError(f"no goal to {self.peer} was sent yet")
        if self.attempt:
            self._message = msgspec.structs.replace(self._message, attempt=self.attempt + 1)
        self.send_goal(self._topic, self._message)

    def resend(self) -> None:
        """Send the same goal and attempt once more: whoever has it already answers with how it stands."""
        if self._topic is None:
            raise RuntimeError(f"no goal to {self.peer} was sent yet")
        self._io.publish(self._topic, self._message)

    def abandon(self) -> None:
        """Await no result any more."""
        self.goal_id, self.result, self.resuming = "", None, False

    # --- across a restart of the brain
    def outstanding_goal(self) -> SentGoal | None:
        """The goal under way, for the journal."""
        if not self.outstanding or self._topic is None:
            return None
        return SentGoal(self.peer, self._topic.key, msgspec.to_builtins(self._message), self._epoch)

    def resume_goal(self, sent: SentGoal) -> None:
        """Await the result of a goal that an earlier process sent; the leaf that sent it goes on with it.

        Raises:
            msgspec.ValidationError, KeyError: the goal is of a kind that is not known any more.
        """
        topic = BY_KEY[sent.key]
        message = msgspec.convert(sent.message, topic.type)
        self.goal_id, self.attempt, self.result = message.id, getattr(message, "attempt", 0), None
        self._recent.append(message.id)
        self._topic, self._message, self.resuming = topic, message, True
        self._epoch, self._known = sent.epoch, self._known or sent.epoch

    def handle_status(self, goal_id: str, attempt: int, result: Result) -> bool:
        """Take a status if it counts; the first final one stands. An attempt of 0 is one the peer did not state."""
        ours = not goal_id or (goal_id == self.goal_id and (not attempt or not self.attempt or attempt == self.attempt))
        if not self.outstanding or not ours:
            if goal_id and goal_id not in self._recent:
                self._io.count_drop(f"{self.peer} answers", f"answer to a goal that is not ours: {goal_id[:40]!r}")
            return False
        if self.result is None or self.result.status == "busy":
            self.result = result
        return True

    # --- the peer's process
    @property
    def known(self) -> bool:
        """A process of this peer has been seen alive, now or earlier."""
        return bool(self._known)

    def watch(self, now: float) -> None:
        """Note the peer's epoch and since when it is gone; once a step."""
        present = self._io.peer(self.peer)
        if present:
            self._known = present
            self._epoch = self._epoch or present
        if present is None and self._known:
            self._gone_since = now if self._gone_since is None else self._gone_since
        else:
            self._gone_since = None

    @property
    def restarted(self) -> bool:
        """The process that received the goal is not the one that is alive now."""
        return self.outstanding and bool(self._epoch) and self._known != self._epoch

    def gone(self, now: float) -> float:
        """Seconds since a peer that once lived is gone; 0 while alive or never seen."""
        return 0.0 if self._gone_since is None else now - self._gone_since
