"""Sentence patterns: `(a | b)`, `[optional]` and `<slot>` over words, as a syntax tree and as a matcher. Pure.

The planner matches sentences against them, speech compiles them to the grammar that its recogniser searches. The
matcher is a nondeterministic automaton (Thompson, "Regular expression search algorithm", 1968) that knows of each state
with which words it goes on, so that a slot ends only where the rest may begin.
"""

import re
from collections.abc import Iterator
from typing import NamedTuple

from common.language.normalise import Words

Slots = dict[str, Words]
_TOKEN = re.compile(r"<(\w+)>|([()\[\]|])|([\w']+)")
_Tokens = list[tuple[str, str, str]]


class PatternError(ValueError):
    """A pattern that cannot be used; the message names it."""


class Word(NamedTuple):
    """One word."""

    text: str


class Slot(NamedTuple):
    """Words that belong to the name."""

    name: str


class Sequence(NamedTuple):
    """Parts one after the other."""

    parts: tuple["Node", ...]


class Either(NamedTuple):
    """One of the options; an optional part has the empty sequence as its last."""

    options: tuple["Node", ...]


Node = Word | Slot | Sequence | Either
NOTHING = Sequence(())
ANY = "*"
"""In place of a word that may be any."""


def parse(pattern: str) -> Node:
    """Syntax tree of a pattern.

    Raises:
        PatternError: unbalanced brackets, or characters that are no word.
    """
    text = pattern.lower()
    if rest := _TOKEN.sub("", text).strip():
        raise PatternError(f"pattern {pattern!r}: {rest[:10]!r} is not understood")
    tokens: _Tokens = _TOKEN.findall(text)
    node, at = _alternatives(tokens, 0, pattern)
    if at != len(tokens):
        raise PatternError(f"pattern {pattern!r}: a closing bracket too many")
    return node


def _alternatives(tokens: _Tokens, at: int, pattern: str) -> tuple[Node, int]:
    node, at = _sequence(tokens, at, pattern)
    options = [node]
    while at < len(tokens) and tokens[at][1] == "|":
        node, at = _sequence(tokens, at + 1, pattern)
        options.append(node)
    return (options[0] if len(options) == 1 else Either(tuple(options))), at


def _sequence(tokens: _Tokens, at: int, pattern: str) -> tuple[Node, int]:
    parts: list[Node] = []
    while at < len(tokens):
        slot, mark, word = tokens[at]
        if mark in ("|", ")", "]"):
            break
        at += 1
        if slot:
            parts.append(Slot(slot))
        elif word:
            parts.append(Word(word))
        else:
            inner, at = _alternatives(tokens, at, pattern)
            closing = ")" if mark == "(" else "]"
            if at >= len(tokens) or tokens[at][1] != closing:
                raise PatternError(f"pattern {pattern!r}: {mark} is not closed")
            at += 1
            parts.append(inner if mark == "(" else Either((inner, NOTHING)))
    return (parts[0] if len(parts) == 1 else Sequence(tuple(parts))), at


class Pattern:
    """A pattern whose slots take any words that let the rest match."""

    def __init__(self, pattern: str) -> None:
        self.tree = parse(pattern)
        self._state = _compiled(self.tree, _END)
        self._needed = needed(self.tree)

    def matches(self, words: Words) -> Iterator[Slots]:
        """Every reading of the whole sentence, shorter first slots first."""
        if not self._needed or not self._needed.isdisjoint(words):
            yield from self._state.readings(words, 0, {})


class _State:
    """What is left of a pattern; `first`: the words with which that may begin, ANY among them, "" for nothing more."""

    first: frozenset[str]

    def readings(self, words: Words, at: int, slots: Slots) -> Iterator[Slots]:
        """Every way in which the words from `at` on are all of it, in the order of the options."""
        raise NotImplementedError

    def may_begin(self, words: Words, at: int) -> bool:
        return (words[at] in self.first or ANY in self.first) if at < len(words) else "" in self.first


class _End(_State):
    first = frozenset({""})

    def readings(self, words: Words, at: int, slots: Slots) -> Iterator[Slots]:
        if at == len(words):
            yield slots


_END = _End()


class _OneWord(_State):
    def __init__(self, text: str, then: _State) -> None:
        self._text, self._then, self.first = text, then, frozenset({text})

    def readings(self, words: Words, at: int, slots: Slots) -> Iterator[Slots]:
        if at < len(words) and words[at] == self._text:
            yield from self._then.readings(words, at + 1, slots)


class _Name(_State):
    first = frozenset({ANY})

    def __init__(self, name: str, then: _State) -> None:
        self._name, self._then = name, then

    def readings(self, words: Words, at: int, slots: Slots) -> Iterator[Slots]:
        for end in range(at + 1, len(words) + 1):
            if self._then.may_begin(words, end):
                yield from self._then.readings(words, end, {**slots, self._name: words[at:end]})


class _Fork(_State):
    def __init__(self, options: list[_State]) -> None:
        self._options, self.first = options, frozenset[str]().union(*(option.first for option in options))

    def readings(self, words: Words, at: int, slots: Slots) -> Iterator[Slots]:
        for option in self._options:
            if option.may_begin(words, at):
                yield from option.readings(words, at, slots)


def _compiled(node: Node, then: _State) -> _State:
    """The node and what follows it as a chain of states, each of which knows how it may begin."""
    match node:
        case Word(text):
            return _OneWord(text, then)
        case Slot(name):
            return _Name(name, then)
        case Either(options):
            return _Fork([_compiled(option, then) for option in options])
        case Sequence(parts):
            for part in reversed(parts):
                then = _compiled(part, then)
            return then


def words_of(node: Node) -> set[str]:
    """Every word of a pattern."""
    match node:
        case Word(text):
            return {text}
        case Slot(_):
            return set()
        case _:
            parts = node.options if isinstance(node, Either) else node.parts
            return set[str]().union(*map(words_of, parts))


def needed(node: Node) -> frozenset[str]:
    """Words of which every sentence of the pattern has at least one; empty when there are none such."""
    match node:
        case Word(text):
            return frozenset({text})
        case Slot(_):
            return frozenset()
        case Either(options):
            sets = [needed(option) for option in options]
            return frozenset().union(*sets) if all(sets) else frozenset()
        case Sequence(parts):
            return min((n for part in parts if (n := needed(part))), key=len, default=frozenset())


def first_words(node: Node) -> set[str]:
    """Words with which a sentence of the pattern may begin: ANY where that is a slot, "" where it may be empty."""
    match node:
        case Word(text):
            return {text}
        case Slot(_):
            return {ANY}
        case Either(options):
            return set[str]().union(*(first_words(option) for option in options))
        case Sequence(parts):
            found = {""}
            for part in parts:
                if "" not in found:
                    break
                found = (found - {""}) | first_words(part)
            return found
