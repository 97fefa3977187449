"""Tidying rules from a person's words, as "red mugs go on the shelf": what they are about. Pure."""

from collections.abc import Sequence

from common.kinds import KINDS
from common.messages import TidyRule
from common.naming.names import normalise
from common.naming.words import Words

_ALL = {"all", "every", "each", "any", "our", "your", "these", "those"}


ONES = frozenset({"the", "this", "that", "it", "them", "these", "those", "a", "an", "all", "every", "both", "some"})
"""First words by which a person means the things that are there, not their kind."""


def is_generic(things: Sequence[str]) -> bool:
    """True for words that mean all of their kind (`mugs`, `my keys`), and not certain ones (`the mugs`)."""
    last = things[-1] if things else ""
    return bool(last) and things[0] not in ONES and last.endswith("s") and not last.endswith("ss")


def rule_about(things: str, to: str, words: Words) -> TidyRule:
    """The rule that `things` go to the receptacle `to`, by kind and colour where the words say so, else by name."""
    rest = [w for w in normalise(things).split() if w not in _ALL]
    colours: list[str] = []
    while len(rest) > 1 and (colour := words.colour(rest[0])):
        colours.append(colour)
        rest = rest[1:]
    noun = " ".join(rest)
    for form in _singulars(noun):
        kind = form if form in KINDS else words.kind(form)
        kinds = list(dict.fromkeys([*([kind] if kind else ()), *words.groups.get(form, ())]))
        if kinds:
            return TidyRule(things=normalise(things), to=[to], kinds=kinds, colours=colours)
    names = list(dict.fromkeys(" ".join([*colours, form]) for form in _singulars(noun)))
    return TidyRule(things=normalise(things), to=[to], names=names if noun else [])


def _singulars(noun: str) -> list[str]:
    """The noun as it is, and what it may be the plural of."""
    forms = [noun]
    if noun.endswith("ves"):
        forms.append(f"{noun[:-3]}f")
    if noun.endswith("es"):
        forms.append(noun[:-2])
    if noun.endswith("s") and not noun.endswith("ss"):
        forms.append(noun[:-1])
    return forms
