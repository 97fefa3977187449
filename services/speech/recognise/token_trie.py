"""The recogniser's tokens as a trie of characters, and which of them a grammar allows next."""

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from services.speech.recognise.grammar import Grammar, State

BOS, EOS = 1, 2
"""Numbers of the tokens that begin and end a sentence."""
STATES = 20_000
"""States of the grammar whose next tokens are kept [count]; chosen: some tens of MB, and hundreds of sentences."""
_PUNCTUATION = set('.,?!;:"-')


@cache
def read_tokens(path: Path) -> list[str]:
    """tokenizer.bin: per token one length byte (two from 128 on) and its UTF-8 bytes; 0 marks an unused number."""
    raw, tokens, i = path.read_bytes(), [], 0
    while i < len(raw):
        size = raw[i]
        i += 1
        if size >= 128:
            size = raw[i] * 128 + size - 128
            i += 1
        tokens.append(raw[i : i + size].decode("utf-8", "replace").replace("▁", " "))
        i += size
    return tokens


@cache
def _trie(tokens: tuple[str, ...]) -> dict[str, Any]:
    trie: dict[str, Any] = {}
    for number, token in enumerate(tokens):
        if number > EOS and token and not token.startswith("<") and all(c.isascii() for c in token):
            node = trie
            for character in token.lower():
                node = node.setdefault(character, {})
            node.setdefault("", []).append(number)
    return trie


class TokenTrie:
    """The tokens as a trie of lower-case characters, walked together with the grammar's automaton."""

    def __init__(self, tokens: list[str], grammar: Grammar) -> None:
        self.tokens = tokens
        self.grammar = grammar
        self._trie = _trie(tuple(tokens))
        self._allowed: dict[State, tuple[NDArray[np.int64], list[State]]] = {}

    def allowed(self, state: State) -> tuple[NDArray[np.int64], list[State]]:
        """Token numbers that continue a sentence from `state`, and the state after each."""
        if state not in self._allowed:
            if len(self._allowed) >= STATES:
                self._allowed.clear()
                self.grammar.forget_walks()
            numbers: list[int] = []
            states: list[State] = []
            self._collect(self._trie, state, numbers, states)
            self._allowed[state] = np.array(numbers, dtype=np.int64), states
        return self._allowed[state]

    def _collect(self, node: dict[str, Any], state: State, numbers: list[int], states: list[State]) -> None:
        for number in node.get("", ()):
            numbers.append(number)
            states.append(state)
        for character, child in node.items():
            if not character:
                continue
            after = self.grammar.step(state, character)
            if after:
                self._collect(child, after, numbers, states)
            elif character in _PUNCTUATION:
                self._collect(child, state, numbers, states)

    @property
    def start(self) -> State:
        """The state before the first token."""
        return self.grammar.start

    def is_final(self, state: State) -> bool:
        """True where a sentence may end."""
        return self.grammar.is_final(state)


class AnyTokens:
    """The grammar that allows every token everywhere, for transcription without a grammar."""

    start: State = frozenset()

    def __init__(self, tokens: list[str]) -> None:
        usable = [k for k, t in enumerate(tokens) if k > EOS and t and not t.startswith("<") and t.isascii()]
        self._allowed = np.array(usable, dtype=np.int64), [self.start] * len(usable)

    def allowed(self, _state: State) -> tuple[NDArray[np.int64], list[State]]:
        """All token numbers, and the state after each."""
        return self._allowed

    def is_final(self, _state: State) -> bool:
        """True everywhere."""
        return True


def letters(token: str) -> str:
    """What a token adds to a sentence, in lower case and without punctuation."""
    return "".join(c for c in token.lower() if c not in _PUNCTUATION)
