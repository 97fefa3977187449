"""What people say to the brain and what it says to them, between the step that receives and the leaf that acts."""

from common import messages as m


class Voice:
    """The newest unanswered command and the newest answer to a question: never more than one of each.

    `listen_after` [s of robot time]: not before is the robot to listen again. `speaking`: what speech does.
    """

    def __init__(self) -> None:
        self.command: m.VoiceCommand | None = None
        self.reply: m.SpeechResult | None = None
        self.listen_after = 0.0
        self.speaking: m.SpeechStatus | None = None

    def take_command(self) -> m.VoiceCommand | None:
        """The waiting command, once."""
        command, self.command = self.command, None
        return command

    def take_reply(self) -> m.SpeechResult | None:
        """The waiting answer, once."""
        reply, self.reply = self.reply, None
        return reply
