"""The command grammar: patterns over words, compiled to an automaton over characters.

Patterns use `(a | b)`, `[optional]` and `<part>`; a line `name = pattern` defines a part, several lines for one
name are alternatives, a line without a name is a sentence.
"""

import re
from collections.abc import Iterable, Mapping

from common.household import Household
from common.language.meaning import heard_parts
from common.language.normalise import normalise
from common.language.pattern import Either, Node, PatternError, Sequence, Slot, Word, parse
from services.speech.config import SpeechConfig

State = frozenset[int]
_WORDS = re.compile(r"^[\w' ]+$")
_NAMED = re.compile(r"^(\w+)\s*=\s*(.+)$")


class Grammar:
    """A nondeterministic automaton over characters; states of the walk are sets of its nodes, found lazily."""

    def __init__(self, patterns: Iterable[str], words: Mapping[str, Iterable[str]]) -> None:
        self._parts: dict[str, list[str]] = {name: list(dict.fromkeys(rows)) for name, rows in words.items()}
        sentences = []
        for line in patterns:
            named = _NAMED.match(line.strip())
            if named:
                self._parts.setdefault(named[1], []).append(named[2])
            else:
                sentences.append(line)
        self._nodes = 0
        self._edges: dict[tuple[int, str], int] = {}
        self._silent: dict[int, list[int]] = {}
        self._first, self._final = self._node(), self._node()
        self._depth = 0
        for sentence in sentences:
            self._parse(sentence, self._first, self._final)
        self._steps: dict[tuple[State, str], State] = {}
        self.start: State = self._closure({self._first})
        if self.accepts(""):
            raise PatternError("the grammar accepts silence: a pattern is wholly optional")

    # --- walking
    def step(self, state: State, character: str) -> State:
        """The state after one more character; empty when no sentence continues like that."""
        key = state, character
        found = self._steps.get(key)
        if found is None:
            found = self._closure({n for s in state if (n := self._edges.get((s, character), 0))})
            self._steps[key] = found
        return found

    def forget_walks(self) -> None:
        """Free the memory of the states found so far; they are found anew when they are needed."""
        self._steps.clear()

    def walk(self, text: str) -> State:
        """The state after `text`."""
        state = self.start
        for character in text:
            state = self.step(state, character)
            if not state:
                break
        return state

    def is_final(self, state: State) -> bool:
        """True where a sentence may end."""
        return self._final in state

    def accepts(self, text: str) -> bool:
        """True for a whole sentence, in lower case without punctuation."""
        return self.is_final(self.walk(f" {text}" if text else ""))

    # --- building
    def _node(self) -> int:
        self._nodes += 1
        return self._nodes

    def _join(self, start: int, end: int) -> None:
        """Let `end` follow on `start` without a character."""
        self._silent.setdefault(start, []).append(end)

    def _closure(self, nodes: set[int]) -> State:
        stack, seen = list(nodes), set(nodes)
        while stack:
            for n in self._silent.get(stack.pop(), ()):
                if n not in seen:
                    seen.add(n)
                    stack.append(n)
        return frozenset(seen)

    def _word(self, start: int, word: str) -> int:
        """The node after a word (with the space before it); words with a common beginning share nodes."""
        node = start
        for character in f" {word}":
            key = node, character
            if key not in self._edges:
                self._edges[key] = self._node()
            node = self._edges[key]
        return node

    def _parse(self, pattern: str, start: int, end: int) -> None:
        self._build(parse(pattern), start, end, pattern)

    def _build(self, node: Node, start: int, end: int, pattern: str) -> None:
        """Ways from the automaton's node `start` to `end` for each sentence of a pattern's syntax tree."""
        match node:
            case Word(text):
                self._join(self._word(start, text), end)
            case Slot(name):
                self._part(name, start, end, pattern)
            case Either(options):
                for option in options:
                    first = self._node()
                    self._join(start, first)
                    self._build(option, first, end, pattern)
            case Sequence(parts):
                at = start
                for part in parts:
                    after = self._node()
                    self._build(part, at, after, pattern)
                    at = after
                self._join(at, end)

    def _part(self, name: str, start: int, end: int, pattern: str) -> None:
        if name not in self._parts:
            raise PatternError(f"pattern {pattern!r}: nothing defines <{name}>")
        self._depth += 1
        if self._depth > 12:
            raise PatternError(f"pattern {pattern!r}: <{name}> contains itself")
        for row in self._parts[name]:
            if _WORDS.match(row):
                node = start
                for word in row.split():
                    node = self._word(node, word)
                self._join(node, end)
            else:
                self._parse(row, start, end)
        self._depth -= 1


def vocabulary(
    household: Household, objects: Iterable[str], places: Iterable[str], colours: Iterable[str]
) -> dict[str, list[str]]:
    """The parts that patterns need not define: <verb> and <utterance> from the wordings' table, and as names and
    aliases of the household and its words for kinds and groups, with the configured ones, <object>, <place>, <surface>,
    <container> and <colour>.

    Anything can be put on a receptacle; bins and rooms can hold things.
    """
    words = household.words
    things = [n for o in household.things for n in (o.name, o.kind, *o.aliases)]
    things += [n for kind, others in words.kinds.items() for n in (kind, *others)] + list(words.groups)
    surfaces = [n for r in household.receptacles for n in (r.name, *r.aliases)]
    rooms = [n for r in household.rooms for n in (r.name, *r.aliases)]
    bins = [n for r in household.receptacles if r.kind in ("bin", "tray") for n in (r.name, *r.aliases)]
    spots = [n for p in (household.home, *household.places) for n in (p.name, *p.aliases)]
    return {
        **heard_parts(),
        "object": [normalise(n) for n in (*things, *objects)],
        "place": [normalise(n) for n in (*surfaces, *rooms, *spots, *places)],
        "surface": [normalise(n) for n in surfaces],
        "container": [normalise(n) for n in (*bins, *rooms)],
        "colour": [normalise(n) for n in (*(o.colour for o in household.things), *words.colours, *colours) if n],
    }


def known_names(config: SpeechConfig, household: Household, names: Iterable[str]) -> frozenset[str]:
    """The single words of the names of things, places and colours, in singular and plural."""
    parts = vocabulary(household, (*config.objects, *names), config.places, config.colours)
    kinds = ("object", "place", "surface", "container", "colour")
    words = {word for kind in kinds for name in parts[kind] for word in name.split()}
    return frozenset(words | {f"{word}{ending}" for word in words for ending in ("s", "es")})
