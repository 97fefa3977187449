"""Sentence patterns: `(a | b)`, `[optional]` and `<slot>` over words, as a syntax tree and as a matcher. Pure.

The planner matches sentences against them, speech compiles them to the grammar that its recogniser searches.
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
        self._first = first_words(self.tree)
        self._needed = needed(self.tree)

    def matches(self, words: Words) -> Iterator[Slots]:
        """Every reading of the whole sentence, shorter first slots first."""
        if self._first & {"", ANY, *words[:1]} and (not self._needed or not self._needed.isdisjoint(words)):
            for end, slots in _match(self.tree, words, 0, {}):
                if end == len(words):
                    yield slots


def _match(node: Node, words: Words, at: int, slots: Slots) -> Iterator[tuple[int, Slots]]:
    """(end, slots) of every way in which `node` fits the words from `at` on."""
    match node:
        case Word(text):
            if at < len(words) and words[at] == text:
                yield at + 1, slots
        case Slot(name):
            for end in range(at + 1, len(words) + 1):
                yield end, {**slots, name: words[at:end]}
        case Either(options):
            for option in options:
                yield from _match(option, words, at, slots)
        case Sequence(parts):
            yield from _match_all(parts, 0, words, at, slots)


def _match_all(parts: tuple[Node, ...], depth: int, words: Words, at: int, slots: Slots) -> Iterator[tuple[int, Slots]]:
    """The same for `parts` from `depth` on, one after the other."""
    if depth == len(parts):
        yield at, slots
        return
    for end, found in _match(parts[depth], words, at, slots):
        yield from _match_all(parts, depth + 1, words, end, found)


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
