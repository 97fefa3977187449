"""Choice between the grammar's sentence and the free transcription as what was said. Pure."""

from collections.abc import Collection, Container
from dataclasses import replace

from common.language.contractions import expand
from common.language.lexicon import COMMANDING
from common.language.meaning import asks_for
from common.language.mood import forbids, is_asked
from common.language.normalise import normalise
from common.language.spoken import BETWEEN, Understanding, perhaps, turns, understood
from services.speech.config import SpeechConfig
from services.speech.recognise.recogniser import Recognition
from services.speech.recognise.scoring import meant
from services.speech.recognise.sounding import NEAR, VERY_NEAR, resounded
from services.speech.recognise.wake_text import clauses, without_wake

UNLISTED = 0.5
"""Most confidence in words that are on no list. Chosen: below that from which the brain does not ask."""
LEAST = 0.2
"""Confidence from which a sentence of the grammar is asked about. Chosen on five voices in noise and echoes: below it
one question of nine was right, above it two of five."""
FAINT = 0.4
"""Certainty of the free transcription below which a sentence of the grammar that it does not confirm is asked about.
Chosen on five voices in noise: below it two of five sentences that were accepted were wrong, above it none of 80."""
CLOSED = frozenset({"the", "a", "an", "my", "your", "our", "their", "its", "and", "or"})
"""Words after which something must come in a question, too."""
OPEN = CLOSED | {"to", "from", "into", "onto", "of", "with", "between", "beside", "behind", "under"}
"""Words after which something must come, other than those that also end a sentence ("turn it on", "give me that").

A question may end with others of them: "what is it made of".
"""
PLAIN = 0.6
"""Certainty of a transcription from which its words count as heard (chosen: half-way between `FAINT` and what the brain
takes without a question)."""
MOST = 4
"""Most alternatives to what was heard (chosen: of 150 everyday sentences in noise the right one was never further down,
and each costs the planner a tenth of a second)."""
COSTS: dict[Understanding, float] = {"listed": 0.0, "unlisted": 1.5, "": 3.0}
"""How much rarer than a sentence of known words is said to the robot what has others, or is nothing it understands: a
natural logarithm. Chosen on five voices in noise, where 1 to 3 and twice that came to the same."""


def freely(found: Recognition, names: Collection[str], config: SpeechConfig) -> Recognition:
    """A recognition without the wake word, with the free transcription in place of the grammar's sentence where that
    tells more: what the planner would understand.

    In place of a sentence that was accepted it counts where it is more certain, or makes something else of it ("who put
    the mug there" is no "put the mug there"), and is asked about, as is a sentence where hardly anything was heard. Of
    things that are not among the `names` only a certain transcription tells, or a plain one where the grammar has
    nothing instead; of what may ask for something in wordings that nobody knows, a certain one. What sounds like
    something that would be understood is asked about; one of many sentences that fit as badly is not, nor how a
    sentence that breaks off might go on.
    """
    found = replace(found, text=without_wake(found.text, config.wake))
    free = _plain(found.free, config)
    if found.verdict == "accept":
        heard = without_wake(normalise(found.free), config.wake)
        if not found.text or expand(heard) == expand(found.text) or asks_for(found.text, "stop", "cancel", "yes", "no"):
            return found
        if _breaks_off(free, found):
            return replace(found, verdict="reject")
        surer = found.certainty > found.confidence and understood(free, names) == "listed"
        if surer or turns(heard, found.text):
            return replace(found, text=free, confidence=min(found.confidence, UNLISTED))
        return replace(found, confidence=min(found.confidence, UNLISTED)) if found.certainty < FAINT else found
    if not free:
        return found  # nothing but the wake word
    if _breaks_off(free, found):
        return replace(found, verdict="reject")
    grade = understood(free, names)
    if grade == "listed":
        return replace(found, text=free, verdict="accept", confidence=_assured(found))
    if near := _misheard(free, names, VERY_NEAR if grade else NEAR):
        return replace(found, text=near, verdict="accept", confidence=min(found.certainty, UNLISTED))
    instead = found.verdict == "ask" and found.confidence >= LEAST
    if grade == "unlisted" and found.certainty >= (config.certain if instead else PLAIN):
        return replace(found, text=free, verdict="accept", confidence=min(found.certainty, UNLISTED))
    if found.verdict == "reject" and found.certainty >= config.certain and perhaps(free, names):
        return replace(found, text=free, verdict="accept", confidence=UNLISTED)
    if found.text and found.confidence < LEAST:
        return replace(found, verdict="reject")
    return found


def without_itself(found: Recognition) -> Recognition:
    """A recognition with those alternatives alone that mean something else than its text, at most `MOST`."""
    others = [a for a in found.alternatives if meant(a.text) != meant(found.text)]
    return replace(found, alternatives=tuple(others[:MOST]))


def as_heard(found: Recognition, config: SpeechConfig) -> Recognition | None:
    """An utterance that is no command by its transcription, for the brain to judge; None if it was hardly heard."""
    text = _plain(found.free, config)
    if found.verdict == "silence" or found.certainty < config.certain or not text:
        return None
    return without_itself(replace(found, text=text, confidence=0.0))


def cost(text: str, names: Container[str], config: SpeechConfig) -> float:
    """Prior cost of a transcription, the negative logarithm of its probability before anything is heard."""
    return COSTS[understood(_plain(text, config), names)]


def _plain(text: str, config: SpeechConfig) -> str:
    """A transcription in normalised words with their commas, without the wake word."""
    return without_wake(clauses(text), config.wake).strip(" ,")


def _breaks_off(free: str, found: Recognition) -> bool:
    """True when the beginning of a sentence was heard more plainly than the whole one that the grammar has for it."""
    words = tuple(free.replace(",", "").split())
    needs_more = CLOSED if words and is_asked(words) else OPEN
    return needs_more.issuperset(words[-1:] or [""]) and found.certainty >= max(PLAIN, found.confidence)


def _assured(found: Recognition) -> float:
    """Confidence in a transcription of known words: by its own words, or where nothing else sounds like it."""
    return max(found.certainty, found.share) if found.certainty >= PLAIN else found.certainty


def _misheard(free: str, names: Collection[str], near: float) -> str:
    """What sounds like the text and would be understood, of listed words alone; "" for none, and for what forbids."""
    if forbids(free):
        return ""
    words = resounded(free.replace(",", "").split(), BETWEEN.union(names), COMMANDING.union(names), near)
    text = " ".join(words or ())
    return text if understood(text, names) == "listed" else ""
