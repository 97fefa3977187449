"""The words for objects: from the household, from what was seen, and from the configuration. Pure."""

from collections.abc import Iterable
from typing import Any

from common.household import Household
from common.language.lexicon import COMMANDING
from common.language.normalise import Words, infinitive, normalise, without_determiners
from common.language.noun_phrase import UNSEEN, WHICH
from common.language.quantities import UNITS
from common.naming.names import normalise as unmarked
from services.planner.config import PlannerConfig
from services.planner.grammar.senses import (
    ABSTRACT,
    ANY,
    LIVING,
    LONGEST_NAME,
    MASSES,
    NO_NOUN,
    OBJECT,
    POSITIONS,
    SHORTEST_NAME,
    TOYS,
    WHOLE,
    Sense,
    singulars,
)
from services.planner.grammar.spots import Spots
from services.planner.world import World


class Vocabulary(Spots):
    """The nouns beside the places. Built for one request."""

    def __init__(self, world: World, config: PlannerConfig) -> None:
        self.new_nouns = False
        self.phrases: dict[tuple[bool, Words], Any] = {}
        self.ranked: dict[tuple[bool, Words], Any] = {}
        household, known = world.household, [*world.specs, *world.objects]
        self.before = normalise(world.history.last.command) if world.history.last is not None else ""
        self.situation = _situation(world)
        words = household.words
        self.kinds = {t.kind for t in known if t.kind} | set(words.kinds)
        colours = {c: c for c in {*(t.colour for t in known), *(r.colour for r in household.receptacles)} if c}
        colours |= {word: c for c, others in words.colours.items() for word in (c, *others)}
        super().__init__(household, world.places, colours)
        self._kind_of = {t.label: t.kind for t in known}
        self._nouns: dict[str, Sense] = {}
        self._meant: dict[str, tuple[Sense, str, bool] | None] = {}
        self._printed: dict[str, set[str]] = {}
        self._aliases(household)
        for item in known:
            self._nouns.setdefault(normalise(item.label), Sense(names=frozenset({item.label})))
            for name in item.names:
                self._name(normalise(name), item.label)
        self._read(world)
        for kind in self.kinds:
            named = self._nouns.get(kind, Sense())
            only = next(iter(named.names)) if len(named.names) == 1 else ""
            self._nouns[kind] = Sense(kinds=frozenset({kind}), prefer=only)
        for kind, others in words.kinds.items():
            for word in others:
                self._mean(word, (kind,))
        for word, group in words.groups.items():
            self._mean(word, group)
        self.groups = frozenset(map(normalise, words.groups))
        self._mass = frozenset(map(normalise, words.mass))

    def _mean(self, word: str, kinds: Iterable[str]) -> None:
        """A word for objects of these kinds, beside what it means already."""
        noun = normalise(word)
        before = self._nouns.get(noun, Sense())
        if not before.names or before.kinds:
            self._nouns[noun] = Sense(kinds=before.kinds | frozenset(kinds), prefer=before.prefer)

    def _name(self, noun: str, label: str) -> None:
        """One more thing that has this name."""
        before = self._nouns.get(noun, Sense())
        self._nouns[noun] = Sense(names=before.names | {label}, kinds=before.kinds)

    def _read(self, world: World) -> None:
        """Words printed on things and of taught names: up to three together name the thing, where they are new."""
        told = [(spec.name, spec.aliases) for spec in self._household.things]
        for label, said in (*told, *((item.label, (item.text, *item.names)) for item in world.objects)):
            texts = [normalise(text).split() for text in said]
            runs = {" ".join(t[i : i + n]) for t in texts for n in (1, 2, 3) for i in range(len(t) - n + 1)} - LIVING
            for run in runs - self._nouns.keys() - self.kinds - self.colours.keys():
                if len(run) > 2 and run not in NO_NOUN:
                    self._printed.setdefault(run, set()).add(label)

    def _aliases(self, household: Household) -> None:
        for spec in household.things:
            for alias in (spec.name, *spec.aliases):
                self._nouns[normalise(alias)] = Sense(names=frozenset({spec.name}))
            for alias in spec.aliases:
                noun = normalise(alias).removeprefix(f"{spec.colour} ")
                if noun != normalise(alias):
                    self._nouns.setdefault(noun, Sense(kinds=frozenset({spec.kind})))

    def noun(self, phrase: str) -> tuple[Sense, str, bool] | None:
        """(meaning, singular form, is it a plural) of a noun without colours; None if unknown."""
        if phrase not in self._meant:
            self._meant[phrase] = self._noun(phrase)
        return self._meant[phrase]

    def _noun(self, phrase: str) -> tuple[Sense, str, bool] | None:
        if phrase in WHOLE:
            return Sense(every=True), "thing", phrase in ("everything", "all", "mess", "all of it", "it all")
        if "'" in phrase and (taught := self._nouns.get(unmarked(phrase))) is not None:
            return taught, phrase, False  # "grandmother's can", as it was taught
        for form, plural in singulars(phrase):
            if form in ANY:
                return Sense(every=True), form, plural or form in MASSES
            if sense := self._nouns.get(form):
                return sense, form, plural or form in self._mass
        head, _, last = phrase.rpartition(" ")
        if head and last.removesuffix("s") in ANY and head not in self.colours and (named := self.noun(head)):
            return named  # that bottle thing; the orange thing is no orange
        if phrase.startswith("anything ") and (sense := self._nouns.get(phrase.replace("any", "some", 1))):
            return sense, phrase, False
        whole, found, part = phrase.partition(" of ")
        if found and (named := self.noun(part)) is not None:
            kinds = self._nouns.get(whole, Sense()).kinds
            if inside := frozenset(label for label in named[0].names if self._kind_of.get(label) in kinds):
                return Sense(names=inside), *named[1:]  # a can of soup
        kinds = self._nouns[last].kinds if last in self._nouns else frozenset[str]()
        if cans := frozenset(label for label in self._printed.get(head, ()) if self._kind_of.get(label) in kinds):
            return Sense(names=cans), phrase, False  # the soup can
        for form, plural in singulars(phrase):
            if printed := self._printed.get(form):
                return Sense(names=frozenset(printed)), form, plural
        return None

    def new_noun(self, words: Words, determined: bool = True) -> Sense | None:
        """As `unlisted`, where such names are to be read."""
        return self.unlisted(words, determined) if self.new_nouns else None

    def unlisted(self, words: Words, determined: bool = True) -> Sense | None:
        """The words as the name of a thing that nobody has listed or seen; None for a place or a part of a sentence.

        `determined`: a determiner stood before it, so that its first word is no verb (`the hand cream`).
        """
        for at in (i for i, word in enumerate(words[1:-1], 1) if word in ("of", "with")):
            whole, part = words[:at], without_determiners(words[at + 1 :])
            unknown = whole[-1] in ANY or (whole[-1] not in self.kinds and self._names(whole, determined))
            if part and unknown and self._names(part, True):
                return Sense(names=frozenset({" ".join(words)}), new=True)  # the roll of tape, the cup with the lid
        return Sense(names=frozenset({" ".join(words)}), new=True) if self._names(words, determined) else None

    def _names(self, words: Words, determined: bool) -> bool:
        """May the words name a thing that nobody has listed or seen?"""
        if not 0 < len(words) <= LONGEST_NAME or (self._commands(words[0]) and not (determined and len(words) > 1)):
            return False
        if not all(w.replace("'", "").isalnum() for w in words) or max(map(len, words)) < SHORTEST_NAME:
            return False
        named = words
        if words[1:2] == ("of",) and words[0] in self.kinds:
            words, named = (words[0], *words[2:]), words[2:]  # a can of tuna
        elif words[-1] in self.kinds:
            named = words[:-1] or words  # the tuna can
        if not words or (NO_NOUN - self.kinds) & set(named) or (is_abstract(words) and "'s" not in " ".join(words)):
            return False  # the dog's lead
        acts = words[-1].endswith(("ed", "kept")) or self._commands(infinitive(words[-1], COMMANDING))
        if acts or any(
            len(words) > b - a > 1 and self.spot(words[a:b])
            for a in range(len(words))
            for b in range(a + 2, len(words) + 1)
        ):
            return False
        of_looks = (
            determined
            and len(words) == 2
            and words[1] in OBJECT
            and words[0] not in {*self.colours, *UNSEEN, *POSITIONS}
        )
        if words[-1] in self.colours or words[-1] in WHICH or words[-1] in UNITS:
            return False
        if words[-1] in ANY | WHOLE and not (of_looks and words[0] not in WHICH):  # the round thing
            return False
        known = self.spot(words) or self.furniture(words) or self._and_place(words)
        return not known

    def _commands(self, word: str) -> bool:
        """Is it a verb of a command, and no thing either, as the jam is?"""
        return word in COMMANDING and word not in self._household.words.looks

    def _and_place(self, words: Words) -> bool:
        """Are they the name of a thing and that of a place, `box bookshelf`?"""
        return any(self.noun(" ".join(words[:at])) and self.spot(words[at:]) for at in range(1, len(words)))

    def names(self) -> set[str]:
        """All names of things and places that are known."""
        places = {n for r in self._household.receptacles for n in (r.name, *r.aliases)}
        return {*self._nouns, *self._printed, *self._places, *places}

    def words(self) -> tuple[set[str], set[str]]:
        """(colours, words of names) that are known."""
        names = {w for n in (*self.names(), *ANY, *WHOLE) for w in n.split()}
        return set(self.colours), (names | {f"{n}s" for n in names}) - self.colours.keys()


def is_abstract(words: Words) -> bool:
    """Is the head of a noun phrase nothing that could be carried?"""
    if TOYS.intersection(words[:-1]):
        return False  # the toy bus
    head = words[words.index("of") - 1] if "of" in words[1:] else words[-1]
    return any(form in ABSTRACT for form, _ in singulars(head))


def _situation(world: World) -> Words:
    """What is held and how the last command ended, in words."""
    held = ["holding", *normalise(world.held.label).split()] if world.held is not None else []
    last = world.history.last
    return (*held, *([last.outcome, *normalise(last.command).split()] if last is not None else []))
