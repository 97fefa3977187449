"""The command that a correction comes to: what it names takes the place of what was heard there. Pure."""

import re
from collections.abc import Sequence

from common.household import Household
from common.language.contrasts import contrasted, with_qualities
from common.language.exchange import PREPOSITIONS, noun_phrases, replaced, with_thing
from common.language.lexicon import COMMANDING, HANDLING
from common.language.meaning import is_question
from common.language.normalise import DETERMINERS, Words, infinitive, normalise
from common.language.politeness import without_politeness
from common.language.quantities import NUMBERS
from common.plan_rules import is_destination
from services.brain.language.dialogue import is_reply, pieces, rejected

_CONTRAST = re.compile(r"^(?P<right>(?!not\b).+?),? (?:and |but )?not (?P<wrong>.+)$")
_GRADED = re.compile(
    r"^i am telling you$|^(?:the )?(?:(?:right|wrong|correct) \w+|\w+(?: \w+)? (?:(?:is|was|are) )?"
    r"(?:yes|no|(?:al)?right|correct|fine|wrong)|other way (?:a)?round)$"
)
"""A part that says which part of what was heard is right or wrong."""
_AROUND = re.compile(
    r"^(?:(?:it|that) (?:was|is|should (?:be|have been)|has to be) (?=(?:the|on|in)\b)|except )"
    r"| (?:it was|(?:is|was) what i \w+|would be (?:right|better|fine)|will do|is it|then|though|if you please|"
    r"i (?:mean|think|believe|am telling you)|mate|love|dear)$"
)
"""Words around what is meant that name nothing."""
LONGEST_NAME = 3
"""Most words of an answer that is a name alone and no sentence of its own (chosen)."""


def corrected(command: str, correction: str, household: Household) -> str:
    """The command with the thing or place exchanged that the correction names; a whole new command replaces it.

    "" after a correction without a word.
    """
    said = normalise(command)
    parts = [_AROUND.sub("", without_politeness(part)) for part in pieces(correction)]
    if not parts or _is_command(parts[0], household):
        return with_thing(correction, said.split()) if correction else ""
    meant, wrong = _meant(parts)
    if said.startswith("say ") and wrong in said and len(meant) == 1:
        return f"say {meant[0]}" if said.endswith(meant[0].split()[-1]) else said.replace(wrong, meant[0])
    for part in [p for p in meant if not set(p.split()) <= set(said.split())] or meant:  # "the counter? the table"
        exchanged = _exchanged(said, part, wrong, household)
        if exchanged is None:
            return correction
        said = exchanged
    return said if meant else correction


def answered(suggestion: str, answer: str, household: Household) -> str:
    """The command that an answer to a suggested one comes to: with another thing or place, or a command of its own.

    A name alone, `spatula`, is of what the suggestion is to be done with.
    """
    words = normalise(answer).split()
    names = len(words) <= LONGEST_NAME and not _is_command(answer, household) and not is_question(answer)
    begins = words[:1] and words[0] in DETERMINERS | PREPOSITIONS
    return corrected(suggestion, answer, household) if words and (begins or names) else answer


def _meant(parts: Sequence[str]) -> tuple[list[str], str]:
    """The parts that name what is meant, each once, and what was not meant.

    `block, blue block, not ball` is the blue block for the ball.
    """
    found, wrong = list[str](), ""
    for part in parts:
        if denied := rejected(part):
            wrong = denied
        elif part.startswith("not "):  # not the red one the blue one
            found.append(contrasted(part))
        elif contrast := _CONTRAST.match(part):
            found, wrong = [*found, contrast["right"]], contrast["wrong"]
        elif not (_GRADED.match(part) or is_reply(part) or len(part) == 1):
            found.append(part)
    sets = [set(part.split()) - DETERMINERS for part in found]
    kept = [
        part
        for n, part in enumerate(found)
        if not any(sets[n] < other or (sets[n] == other and n > k) for k, other in enumerate(sets) if k != n)
    ]
    return kept, wrong


def _exchanged(said: str, part: str, wrong: str, household: Household) -> str | None:
    """The command with one part in the place of what stands there; None where it has no such place."""

    def is_place(words: Words) -> bool:
        return is_destination(" ".join(words), household)

    words, bare = said.split(), tuple(w for w in part.split() if w not in DETERMINERS)
    if bare and all(w in NUMBERS or w.isdigit() for w in bare):
        at = [n for n, w in enumerate(words) if w in NUMBERS or w.isdigit()]
        return " ".join((*words[: at[0]], *bare, *words[at[-1] + 1 :])) if at else None
    if not bare or (len(bare) > LONGEST_NAME and part.split()[0] not in DETERMINERS | PREPOSITIONS):
        return None
    if f" {' '.join(bare)} " in f" {said} ":
        return said  # "the plunger", after "go to the bathroom and bring me the plunger"
    thing = " ".join(words[slice(*spans[0])]) if (spans := noun_phrases(words)) else ""
    goes = is_place(tuple(w for w in bare if w not in PREPOSITIONS))
    if (
        goes
        and thing
        and words[0] in HANDLING
        and (words[1:2] in (["me"], ["us"]) or len(words) == 1 + len(thing.split()))
    ):
        to = part if part.split()[0] in PREPOSITIONS else f"on the {' '.join(bare)}"
        return f"put {thing} {to}"
    if part.split()[0] in PREPOSITIONS:
        return replaced(said, part, is_place)
    if set(bare) <= household.words.colours.keys():
        part = f"the {' '.join(bare)} one"
    elif part.split()[0] not in DETERMINERS:
        alike = " ".join((*thing.split()[1:-1], *bare))
        part = f"the {alike if len(bare) == 1 and household.thing(alike) else with_qualities(said, wrong, part)}"
    return replaced(said, part, is_place)


def _is_command(text: str, household: Household) -> bool:
    words = without_politeness(text).split()
    named = is_destination(" ".join(words), household)  # the recycling bin
    return len(words) > 1 and not named and infinitive(words[0], COMMANDING) in COMMANDING
