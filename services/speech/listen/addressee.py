"""Who is meant by an utterance, and what follows from what was understood. Pure."""

from dataclasses import dataclass
from typing import Literal

from common.language.wordings import Action
from services.speech.recognise.recogniser import Heard, Scope

Act = Literal["stop", "cancel", "answer", "command", "awake", "again", "nothing"]


@dataclass(frozen=True)
class Setting:
    """In which an utterance was made: did the robot itself `speak`, does the brain `listen`, was the wake word in it
    (`woken`) or shortly before (`window`), or is the robot `addressed` without one (push-to-talk)."""

    speaking: bool = False
    listening: bool = False
    woken: bool = False
    window: bool = False
    addressed: bool = False

    @property
    def meant(self) -> bool:
        """True when the robot should understand more than stop and cancel."""
        return not self.speaking and (self.listening or self.woken or self.window or self.addressed)


def scope(setting: Setting, over: bool) -> Scope:
    """What to listen for: while the robot speaks, in a mere pause, and among strangers only for stop and cancel."""
    if not over or not setting.meant:
        return "interrupt"
    return "woken" if setting.woken else "command"


def act(heard: Heard, interrupt: Action | None, asked: Scope, setting: Setting) -> Act:
    """What follows from an utterance in which `asked` was looked for; `interrupt` is stop or cancel if it was that.

    `again`: the robot was addressed but did not understand. A cancel that answers the brain's listening is the answer.
    """
    understood = heard.verdict == "accept"
    if understood and interrupt == "stop":
        return "stop"
    if understood and interrupt == "cancel":
        return "answer" if setting.listening else "cancel"
    if asked == "interrupt" or not setting.meant:
        return "nothing"
    if understood and not heard.text:
        return "awake"
    if setting.listening:
        return "answer"
    return "command" if heard.verdict in ("accept", "ask") and heard.text else "again"
