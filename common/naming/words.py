"""What people call things: kinds, colours, groups of kinds, and the rules by which things go somewhere.

The shipped words are in `config/words.toml`; a household may add its own.
"""

from pathlib import Path

import msgspec

from common.config import DEFAULT_DIR
from common.floor_plan import Strict
from common.kinds import KINDS

NAME = "words.toml"
"""The file in the configuration's directory."""


class Destination(Strict, frozen=True):
    """Where objects of some kinds or colours go: the first of `to` (a name, alias or kind) that the household has.

    Empty `kinds` or `colours` mean all; `names` are things by name, and a rule with names is about those alone.
    """

    to: tuple[str, ...]
    kinds: tuple[str, ...] = ()
    colours: tuple[str, ...] = ()
    names: tuple[str, ...] = ()


class Words(Strict, frozen=True):
    """`kinds` and `colours`: the word that the robot uses, and other words for the same.

    `groups`: words that stand for several kinds. `mass`: those of them that mean everything of the kind ("rubbish").
    `shades`: words for colours between those, each with the colours that one may take it for ("beige").
    `qualities`: words that say how a thing is and that nobody can tell by its kind and colour ("striped", "favourite").
    `looks`: words for things that nobody can tell by looks alone ("soap"), each with the kinds and colours it may have.
    `needs`: what helps somebody who is "thirsty". `tidy` and `throw`: where things go that are put away or thrown away;
    the first rule that fits counts.
    """

    kinds: dict[str, tuple[str, ...]] = {}
    colours: dict[str, tuple[str, ...]] = {}
    groups: dict[str, tuple[str, ...]] = {}
    mass: tuple[str, ...] = ()
    needs: dict[str, str] = {}
    shades: dict[str, tuple[str, ...]] = {}
    qualities: tuple[str, ...] = ()
    looks: dict[str, tuple[str, ...]] = {}
    tidy: tuple[Destination, ...] = ()
    throw: tuple[Destination, ...] = ()

    def __hash__(self) -> int:
        return hash(msgspec.json.encode(self, order="sorted"))

    def fault(self) -> str:
        """What makes the words impossible, in words; "" when nothing does."""
        named = [*self.kinds, *(kind for group in self.groups.values() for kind in group)]
        named += [kind for rule in (*self.tidy, *self.throw) for kind in rule.kinds]
        named += [word for look in self.looks.values() for word in look if word not in self.colours]
        if unknown := next((kind for kind in named if kind not in KINDS), ""):
            return f"words: no kind is called {unknown!r}; known kinds: {', '.join(KINDS)}"
        between = [colour for colours in self.shades.values() for colour in colours]
        unknown = next((colour for colour in between if colour not in self.colours), "")
        return f"words: no colour is called {unknown!r}; known: {', '.join(self.colours)}" if unknown else ""

    def kind(self, word: str) -> str:
        """The kind that a word names, "" for none."""
        return _named(self.kinds, word)

    def colour(self, word: str) -> str:
        """The colour that a word names, "" for none."""
        return _named(self.colours, word)

    def added(self, more: "Words") -> "Words":
        """These words and a household's own, whose entries take precedence; lists of rules replace these if given."""
        return Words(
            kinds={**self.kinds, **more.kinds},
            colours={**self.colours, **more.colours},
            groups={**self.groups, **more.groups},
            mass=(*self.mass, *more.mass),
            shades={**self.shades, **more.shades},
            qualities=(*self.qualities, *more.qualities),
            looks={**self.looks, **more.looks},
            needs={**self.needs, **more.needs},
            tidy=more.tidy or self.tidy,
            throw=more.throw or self.throw,
        )


def _named(table: dict[str, tuple[str, ...]], word: str) -> str:
    if word in table:
        return word
    return next((name for name, others in table.items() if word in others), "")


def words_path(directory: Path) -> Path:
    """The words of a configuration directory, the shipped ones where it has none."""
    path = directory / NAME
    return path if path.exists() else DEFAULT_DIR / NAME
