"""Words that name no single object: kinds, colours, places, relations. What else is in a query may be a name or a
print."""

from collections.abc import Callable, Iterable

from common.household import Household
from common.kinds import KINDS
from common.messages import WorldObject
from common.naming.names import normalise

COLOURS = (
    "red", "orange", "yellow", "green", "blue", "purple", "pink", "brown", "black", "white", "grey", "gray", "beige",
    "turquoise", "violet",
)  # fmt: skip
RELATIONS = (
    "on in at of from by near next beside behind front under left right middle top bottom inside and or with that which"
    " is are one other another first second third last nearest closest farthest big bigger biggest small smaller"
    " smallest large little tall short thing things object objects something anything box can bottle jar carton packet"
    " package bag tin pack tube cup mug bowl plate book toy tool labelled labeled called says marked"
)
"""Words between and around nouns, and those for containers that a print is on."""

PACKED = frozenset({"bottle", "can", "jar", "box", "carton", "block", "book"})
"""Kinds that have print more often than not."""
BARE = frozenset({"apple", "orange", "banana", "lemon", "fruit", "ball", "bowl", "plate"})
"""Kinds on which nothing is printed."""


def common_words(household: Household) -> frozenset[str]:
    """Every word that needs no reading, normalised: those of listed things and other words for kinds are among them."""
    listed = [n for o in household.things for n in (o.name, *o.aliases)]
    words = household.words
    others = [word for names in words.kinds.values() for word in names]
    return plain_words(household) | _split((*others, *words.groups, *listed))


def plain_words(household: Household) -> frozenset[str]:
    """Those that are hardly ever a name on a package: "tea" is another word for a mug, and may be one."""
    colours = [w for word, others in household.words.colours.items() for w in (word, *others)]
    words = household.words
    # "Cream" may be one, and what is in a pack.
    between = words.shades.keys() - words.looks.keys()
    return _split((*KINDS, *words.kinds, *COLOURS, RELATIONS, *colours, *between, *words.qualities, *_spots(household)))


def _split(phrases: Iterable[str]) -> frozenset[str]:
    return frozenset(word for phrase in phrases for word in normalise(phrase).split())


def printable(o: WorldObject) -> bool:
    """It is of a kind that may have print on it."""
    return o.kind not in BARE


def unlike_said(o: WorldObject, said: Iterable[str], has_print: Callable[[str], bool]) -> bool:
    """A colour or a fruit was `said` that is neither the object's nor printed on it: "apple juice" is no orange juice,
    and "green tea" is green or says so."""
    own = {o.colour, *o.colours, o.kind, *o.kinds}
    return any(w not in own and not has_print(w) for w in said if w in COLOURS or w in BARE)


def taken(name: str, household: Household) -> str:
    """What a name stands for already, so that it cannot be taught; "" when it is free."""
    words = normalise(name)
    if words in map(normalise, _spots(household)):
        return "a place"
    if words in KINDS or words in household.words.groups or household.words.kind(words):
        return f"every {words}"
    if words in {normalise(n) for o in household.things for n in (o.name, *o.aliases)}:
        return "another thing"
    return ""


def _spots(household: Household) -> list[str]:
    """Names of rooms, of what things are put on, and of standing places."""
    named = [(r.name, r.aliases) for r in household.receptacles] + [(r.name, r.aliases) for r in household.rooms]
    named += [(p.name, p.aliases) for p in (household.home, *household.places)]
    return [n for name, aliases in named for n in (name, *aliases)]
