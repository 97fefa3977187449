"""Recognition of utterances with a pause in them, after which somebody goes on. Pure."""

from dataclasses import replace

from common.messages import Transcription
from services.speech.recognise.free_text import without_itself
from services.speech.recognise.recogniser import Recognition

SURE = 0.8
"""Confidence below which a command is asked about, as the brain does, and so may wait for what follows."""
AS_LIKELY = 0.5
"""Score of what was understood before somebody went on (chosen: nobody knows who it was)."""


def rank(found: Recognition) -> int:
    """How well a command was understood: 2 if it is done at once, 1 if it is asked about, 0 if it is none."""
    if found.verdict not in ("accept", "ask") or not found.text or found.mistaken:
        return 0
    return 2 if found.verdict == "accept" and found.confidence >= SURE else 1


def whole(first: Recognition, found: Recognition) -> Recognition:
    """The recognition of an utterance with a pause: `first` is of the part before it, `found` of the whole.

    Where that is doubtful it is asked about, with the first part as an alternative: others may have talked. The first
    part stands where all of it is no command.
    """
    if not rank(found):
        return first
    if rank(found) >= rank(first):
        return found
    part = Transcription(text=first.text, score=AS_LIKELY)
    return without_itself(replace(found, alternatives=(part, *found.alternatives)))
