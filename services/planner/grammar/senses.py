"""What a noun and a place can mean, and the words that name nothing. Pure."""

from importlib.resources import files

import msgspec

from common.floor_plan import Receptacle
from common.language.normalise import DETERMINERS, Words

ANY = frozenset({"thing", "object", "item", "stuff", "mess", "one"})
OBJECT = frozenset({"thing", "object", "item"})
POSITIONS = frozenset({"top", "bottom", "upper", "lower", "front", "rear", "outer", "inner"})
"""Where something is rather than how it looks."""
WHOLE = frozenset({"everything", "anything", "something", "all", "mess"})
TOYS = frozenset({"toy", "model", "play"})
"""Words before a noun that make of anything what can be carried."""
MASSES = frozenset({"stuff", "mess"})
SHORTEST_NAME = 3
"""Letters of the longest word of a name (chosen: shorter is a word misheard)."""
LONGEST_NAME = 4
"""Words of the longest name of a thing (chosen: more are a sentence that was not understood)."""
_SMALL = (
    "them theirs someone anyone anybody everyone everybody mine yours itself myself himself herself "
    "ourselves themselves "
    "all and anything are as at away back be been before behind below both but by can could did do "
    "does down each every"
    " everything everywhere for from front had has have he her here him how i if in instead into is it left me more"
    " near next no nobody none not nothing of off on once onto or other our out over right she "
    "should so some somebody"
    " something somewhere still than then there they to too under until up us was we were what when where whether"
    " which while who why will with without would yes you yourself again ago bit bring fetch get give go going help"
    " like make put take tell thanks please want need try yet now just only also else later soon tomorrow yesterday"
    " earlier recently whoever whichever whatever today tonight never ever always others"
    " about around through across along against during yourself self"
    " think believe guess suppose reckon hope know remember"
    " lot goes belongs gets lying standing closest might should must ought said says told asked teh"
)
LIVING = frozenset(
    {
        "cat", "dog", "baby", "kid", "kids", "child", "children", "person", "people", "man", "woman", "boy", "girl",
        "wife", "husband", "mother", "father", "mum", "mom", "dad", "grandma", "grandpa", "hamster", "rabbit", "bird",
        "fish", "pet", "daughter", "son", "sister", "brother", "nephew", "niece", "uncle", "aunt", "grandson",
        "granddaughter", "nurse", "doctor", "guest", "guests", "neighbour", "neighbor", "friend", "toddler", "puppy",
        "kitten",
    }
)  # fmt: skip
"""Who is never picked up."""
_FIGURES = TOYS | {
    "stuffed", "plush", "cuddly", "soft", "teddy", "china", "ceramic", "porcelain", "wooden", "rubber", "plastic",
    "glass", "knitted", "crocheted", "felt", "metal", "brass", "stone", "clay", "paper", "chocolate", "clockwork",
    "inflatable", "lego", "squeaky",
}  # fmt: skip
"""Words before such a noun that make it a thing: `the toy rabbit`."""
NO_NOUN = DETERMINERS | frozenset(_SMALL.split())
"""Words that are part of no thing's name."""
HERE = frozenset({"me", "us", "here", "home", "start", "over here", "back"})
ABSTRACT: frozenset[str] = frozenset((files(__package__) / "abstract_nouns.txt").read_text(encoding="utf-8").split())
"""Nouns of what cannot be carried: neither luck, which nobody could find, nor a piano."""


def is_alive(noun: Words) -> bool:
    """Is it somebody, or an animal, and no figure of one?"""
    return noun[-1] in LIVING and _FIGURES.isdisjoint(noun)


class Sense(msgspec.Struct, frozen=True):
    """What a noun can mean: objects of these kinds, or of these names; `every`: any object at all.

    `new`: nobody has listed or seen such a thing, and the words are all that is known of it.
    """

    kinds: frozenset[str] = frozenset()
    names: frozenset[str] = frozenset()
    every: bool = False
    prefer: str = ""
    new: bool = False


class Spot(msgspec.Struct, frozen=True):
    """A place to go to or to put things: exactly one of the receptacle, the room, a standing place, or the person."""

    name: str
    receptacle: Receptacle | None = None
    room: bool = False
    home: bool = False

    @property
    def spoken(self) -> str:
        """How people say where a thing is: `on the table`, `in the kitchen`."""
        return self.receptacle.spoken if self.receptacle is not None else f"in the {self.name}"


def singulars(phrase: str) -> list[tuple[str, bool]]:
    """What a noun may be the plural of, and whether it is; the noun itself first."""
    forms = [(phrase, False)]
    if phrase.endswith("s"):
        forms += [(phrase[:-1], True)]
    if phrase.endswith("es"):
        forms += [(phrase[:-2], True)]
    first, _, rest = phrase.partition(" of ")
    if rest and first.endswith("s"):
        forms += [(f"{first[:-1]} of {rest}", True)]
    return forms
