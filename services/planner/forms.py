"""Sentence forms: `(a | b)`, `[optional]` and `<slot>` over words; a slot takes any words that let the rest match."""

import re
from collections.abc import Callable, Iterator

Words = tuple[str, ...]
Slots = dict[str, Words]
_Found = Iterator[tuple[int, Slots]]
_Node = Callable[[Words, int, Slots], _Found]
_TOKEN = re.compile(r"<(\w+)>|([()\[\]|])|([a-z0-9']+)")


class Form:
    """One form. `matches` yields every reading of the whole sentence, shorter first slots first."""

    def __init__(self, pattern: str) -> None:
        self.pattern = pattern
        self._tokens = _TOKEN.findall(pattern)
        self._at = 0
        self._node = self._alternatives()
        if self._at != len(self._tokens):
            raise ValueError(f"form {pattern!r}: a closing bracket too many")

    def matches(self, words: Words) -> Iterator[Slots]:
        for end, slots in self._node(words, 0, {}):
            if end == len(words):
                yield slots

    def _alternatives(self) -> _Node:
        options = [self._sequence()]
        while self._at < len(self._tokens) and self._tokens[self._at][1] == "|":
            self._at += 1
            options.append(self._sequence())
        return options[0] if len(options) == 1 else _either(options)

    def _sequence(self) -> _Node:
        nodes: list[_Node] = []
        while self._at < len(self._tokens):
            slot, mark, word = self._tokens[self._at]
            if mark in ("|", ")", "]"):
                break
            self._at += 1
            if slot:
                nodes.append(_slot(slot))
            elif word:
                nodes.append(_word(word))
            else:
                inner = self._alternatives()
                closing = ")" if mark == "(" else "]"
                if self._at >= len(self._tokens) or self._tokens[self._at][1] != closing:
                    raise ValueError(f"form {self.pattern!r}: {mark} is not closed")
                self._at += 1
                nodes.append(inner if mark == "(" else _either([inner, _nothing]))
        return _chain(nodes)


def _word(text: str) -> _Node:
    def match(words: Words, at: int, slots: Slots) -> _Found:
        if at < len(words) and words[at] == text:
            yield at + 1, slots

    return match


def _slot(name: str) -> _Node:
    def match(words: Words, at: int, slots: Slots) -> _Found:
        for end in range(at + 1, len(words) + 1):
            yield end, {**slots, name: words[at:end]}

    return match


def _nothing(words: Words, at: int, slots: Slots) -> _Found:
    yield at, slots


def _either(options: list[_Node]) -> _Node:
    def match(words: Words, at: int, slots: Slots) -> _Found:
        for option in options:
            yield from option(words, at, slots)

    return match


def _chain(nodes: list[_Node]) -> _Node:
    def match(words: Words, at: int, slots: Slots, depth: int = 0) -> _Found:
        if depth == len(nodes):
            yield at, slots
            return
        for end, found in nodes[depth](words, at, slots):
            yield from match(words, end, found, depth + 1)

    return match
