"""A command as the robot speaks of it: asked to `bring me my mug`, it will `bring you your mug`. Pure."""

from common.language.clauses import without_fillers
from common.language.contractions import expand
from common.language.lexicon import COMMANDING
from common.language.meaning import is_question
from common.language.normalise import infinitive, normalise
from common.language.politeness import without_politeness

_TURNED = {
    "me": "you", "us": "you", "i": "you", "we": "you", "my": "your", "our": "your", "mine": "yours", "ours": "yours",
    "myself": "yourself", "ourselves": "yourselves", "am": "are", "your": "my", "yours": "mine", "yourself": "myself",
}  # fmt: skip


def indirect(command: str) -> str:
    """What goes behind "I will" or "you asked me to"; "" where that is not to be had by turning words alone."""
    words = without_politeness(without_fillers(expand(normalise(command, ",")))).split()
    verb = infinitive(words[0], COMMANDING) if words else ""
    if verb not in COMMANDING or "you" in words or is_question(command):
        return ""
    ends = [(word.rstrip(","), word[len(word.rstrip(",")) :]) for word in words[1:]]
    return " ".join([verb, *(f"{_TURNED.get(bare, bare)}{comma}" for bare, comma in ends)])
