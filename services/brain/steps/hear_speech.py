"""What leaves that have speech listen have in common."""

from typing import Any

from common import messages as m
from common import topics
from common.topic import Topic
from services.brain.steps.leaf import SendGoal


class HearSpeech(SendGoal):
    """Has speech listen once."""

    def goal(self, goal_id: str) -> tuple[Topic[Any], m.Message]:
        return topics.SPEECH_GOAL, m.SpeechGoal(goal="listen", id=goal_id)

    def need_not_listen(self) -> None:
        """The words came another way."""
        if self.channel.outstanding:
            self.channel.abandon()
            self.ctx.send_only(self.channel, "cancel")

    def pause(self) -> None:
        """Speech has failed: it listens again after a pause."""
        self.ctx.voice.listen_after = self.ctx.now + self.ctx.config.speech_retry_delay
