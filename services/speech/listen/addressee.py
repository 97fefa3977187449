"""Addressee detection: whether an utterance is meant for the robot, and what follows from it. Pure."""

from dataclasses import dataclass
from typing import Literal

from common.language.wording import Action
from services.speech.recognise.recogniser import Recognition, Scope

Consequence = Literal["stop", "cancel", "answer", "command", "awake", "mistaken", "again", "nothing"]


@dataclass(frozen=True)
class UtteranceContext:
    """The circumstances of an utterance: was the robot itself `speaking`, the brain `listening`, the wake word in it
    (`woken`) or shortly before (`window`), or the robot `addressed` without one (push-to-talk)."""

    speaking: bool = False
    listening: bool = False
    woken: bool = False
    window: bool = False
    addressed: bool = False

    @property
    def meant(self) -> bool:
        """True when the robot should understand more than stop and cancel."""
        return not self.speaking and (self.listening or self.woken or self.window or self.addressed)


def scope(context: UtteranceContext, over: bool) -> Scope:
    """The grammar to recognise an utterance with.

    While the robot speaks, in a mere pause (not `over`) and among strangers it is stop and cancel only.
    """
    if not (over and context.meant):
        return "interrupt"
    return "command" if context.listening or context.window or context.addressed else "woken"


def consequence(
    recognition: Recognition, interrupt: Action | None, asked: Scope, context: UtteranceContext
) -> Consequence:
    """What follows from an utterance recognised with the grammar `asked`; `interrupt`: stop or cancel if it is one.

    `again`: the robot was addressed but did not understand; `mistaken`: it only seemed to be addressed. A cancel that
    answers the brain's listening is the answer. To a robot that was addressed a stop that was perhaps heard among all
    that can be said is one: it costs less than a stop that is not obeyed.
    """
    understood = recognition.verdict == "accept"
    perhaps = recognition.verdict == "ask" and context.meant and asked != "interrupt" and not recognition.mistaken
    if interrupt == "stop" and (understood or perhaps):
        return "stop"
    if understood and interrupt == "cancel":
        return "answer" if context.listening else "cancel"
    if asked == "interrupt" or not context.meant:
        return "nothing"
    if asked == "woken" and recognition.mistaken:
        return "mistaken"
    if understood and not recognition.text:
        return "awake"
    if context.listening:
        return "answer"
    if recognition.verdict == "ask" and not recognition.text:
        return "awake"  # the detector heard the wake word, and nothing that the grammar knows sounds more like it
    return "command" if recognition.verdict in ("accept", "ask") and recognition.text else "again"
