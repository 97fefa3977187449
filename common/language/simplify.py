"""A clause without the adverbs and particles that change nothing, for wordings that fit only then. Pure."""

from common.language.normalise import Words

_ADVERBS = frozenset({
    "just", "very", "quite", "rather", "perhaps", "maybe", "please", "also", "too", "straight", "together",
    "somewhere", "anywhere", "instead",
})  # fmt: skip
_NO_ADVERBS = frozenset({"only", "family", "early"})
_PARTICLES = frozenset(
    {"back", "over", "out", "up", "down", "on", "along", "off", "away", "round", "across", "right", "through"}
)
_AFTER_PARTICLE = frozenset(
    {"to", "off", "from", "on", "onto", "in", "into", "at", "here", "there", "beside", "next", "near", "behind"}
)
_RECEIVERS = frozenset({"me", "us"})


def simplified(words: Words) -> Words:
    """Words without adverbs, and without particles before a preposition (`out to`) or after a receiver (`me over`).

    It is for a second try: `on` and `up` mean something where the sentence is understood as it stands.
    """
    if words[-2:] == ("as", "well"):
        words = words[:-2]
    kept: list[str] = []
    for word in reversed([w for w in words if not _is_adverb(w)]):
        if not (word in _PARTICLES and kept and kept[-1] in _AFTER_PARTICLE):
            kept.append(word)
    kept.reverse()
    receiver = [False, *(w in _RECEIVERS for w in kept[:-1])]
    return tuple(w for w, after in zip(kept, receiver, strict=False) if not (after and w in _PARTICLES))


def _is_adverb(word: str) -> bool:
    return word in _ADVERBS or (word.endswith("ly") and word not in _NO_ADVERBS)
