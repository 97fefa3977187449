"""Speech: what is to be heard and said, what was, and sound."""

from typing import Literal

from common.messages.base import Message

SpeechStateName = Literal["idle", "listening", "transcribing", "speaking"]
NOT_UNDERSTOOD = "Sorry, I did not understand that. Please say it again."
"""What the robot says to somebody of whose words neither speech nor the planner makes anything."""


class SpeechGoal(Message):
    """`listen`, `say <text>` or `cancel`."""

    goal: str
    id: str = ""
    attempt: int = 1


class SpeechResult(Message):
    """What was heard; `text` is `ERROR` after silence, noise or speech that is no command."""

    text: str
    goal_id: str = ""
    confidence: float = 1.0
    attempt: int = 0
    code: str = ""
    detail: str = ""


class SpeechStatus(Message):
    """What speech does; `detail` of `speaking` is the sentence, `code` says why an utterance was not understood."""

    state: SpeechStateName
    goal_id: str = ""
    attempt: int = 0
    detail: str = ""
    code: str = ""


class TypedText(Message):
    """Text typed by a person; counts as heard with confidence 1."""

    text: str
    id: str = ""


class AudioChunk(Message):
    """Mono int16 little-endian samples that start at robot time `t`; `end` marks the last chunk.

    `addressed`: the speaker means the robot (push-to-talk), so that no wake word is needed.
    """

    t: float
    data: bytes
    rate: int = 16000
    seq: int = 0
    end: bool = False
    addressed: bool = False


class Transcription(Message):
    """Words that may have been said; `score` 0..1: how probable they are among all that sound like it."""

    text: str
    score: float = 0.0


class VoiceCommand(Message):
    """A command in words; `confirmed`: the sender vouches for them (typed text), so nobody asks "Did you say ...?".

    `question`: `text` is no command but a question that the robot puts to the person; the answer is the outcome's
    `reason`. An `id` that was heard before is not heard again. `unless_busy`: taken up at once or not at all, neither
    queued nor in the place of another. `withdraws`: the id of a command that is not to be carried out, whether it is
    under way, waits, or is still to come; `text` then says nothing. `alternatives`: what else may have been said, the
    likeliest first.
    """

    text: str
    confidence: float = 1.0
    id: str = ""
    confirmed: bool = False
    question: bool = False
    unless_busy: bool = False
    withdraws: str = ""
    alternatives: list[Transcription] = []
