"""Commands that are offered to one of several robots: which of them this one has heard, and which were withdrawn."""

from collections import deque

from common import messages as m

KEPT = 64
"""Ids that are remembered [count]; chosen: far more than are under way in a fleet at once."""


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
