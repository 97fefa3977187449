"""What people say to the brain and what it says to them, between the step that receives and the leaf that acts."""

from collections import deque

from common import messages as m

KEPT = 64
"""Ids that are remembered [count]; chosen: far more than are under way in a fleet at once."""


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


# --- commands that are offered to one of several robots: which of them this one has heard, and which were withdrawn
class Offers:
    """An offer is taken up once, by a robot that is free, and not after its withdrawal, whichever comes first."""

    def __init__(self, under_way: str = "") -> None:
        self._settled: deque[str] = deque([under_way] if under_way else [], KEPT)

    def accept(self, command: m.VoiceCommand, free: bool) -> bool:
        """True when the command is to be carried out; what is refused now stays refused."""
        if command.id in self._settled:
            return False
        if command.id:
            self._settled.append(command.id)
        return free

    def withdraw(self, command_id: str) -> None:
        """A command of this id that comes later is not heard."""
        if command_id not in self._settled:
            self._settled.append(command_id)


def refused(verb: str, reason: str) -> str:
    """`I cannot do that: my hand is full.`; a reason that speaks of the robot itself is the whole sentence."""
    return f"{reason}." if reason.startswith("I ") else f"I cannot {verb} that: {reason}."
