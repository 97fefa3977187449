"""What a tuned transformer makes of the candidates of a sentence: intent and slots read together.

As in Chen et al., "BERT for joint intent classification and slot filling", 2019: the form counts by the whole sentence,
each thing and place by what its words mean in it, and a quotation by its first and last word.
`bench/semantic_network.py` tunes it.
"""

from collections.abc import Mapping, Sequence
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from common.language.eight_bits import in_8_bits
from common.language.normalise import Words
from common.language.transformer import CLS, SEP, Adapter, Floats, transformer, word_pieces
from services.planner.grammar.chunks import Chunk
from services.planner.semantic.forms import Candidate

LONGEST = 200
"""Most word pieces that are read (chosen: bounds the time; 60 words have about 80)."""


class Read(NamedTuple):
    """A sentence in word pieces behind its situation.

    `second`: where it begins; `words`: first piece of each word and the one behind it; `things`: likewise of each thing
    and place.
    """

    pieces: list[int]
    second: int
    words: list[tuple[int, int]]
    things: list[tuple[int, int]]

    def ends(self, span: tuple[int, int]) -> tuple[int, int]:
        """The first and the last piece of the words from number `span[0]` to before `span[1]`."""
        return self.words[span[0]][0], self.words[span[1] - 1][1] - 1


def read(words: Words, found: Sequence[Chunk], situation: Words) -> Read:
    """The pieces of a sentence in words and marks; `situation`: words for what is held or was done before."""
    pieces = [CLS, *(piece for word in situation for piece in word_pieces(word)), SEP]
    second = len(pieces)
    at: list[tuple[int, int]] = []
    for word in words:
        begin = len(pieces)
        pieces += word_pieces(word)
        at.append((begin, len(pieces)))
    return Read([*pieces, SEP], second, at, [(at[c.begin][0], at[c.end - 1][1]) for c in found])


def slots(candidate: Candidate, found: Sequence[Chunk]) -> list[tuple[int, str]]:
    """Number of each thing and place outside the quotation, with two names of what it is in a candidate."""
    begin, end = candidate.span or (0, 0)
    names: list[tuple[int, str]] = []
    for at, chunk in enumerate(found):
        role = candidate.roles.get(at)
        if role:
            names += [(at, role), (at, f"{candidate.form} {role}")]
        elif not begin <= chunk.begin < end:
            names += [(at, f"no {chunk.kind}"), (at, f"{candidate.form} none")]
    return names


class Network:
    """`heads`: weights and biases: `form` (forms, 2 * SIZE), `slot` (slots, SIZE), `first` and `last` (forms, SIZE)."""

    def __init__(
        self,
        adapters: Mapping[str, Adapter],
        heads: Mapping[str, tuple[Floats, Floats]],
        forms: Sequence[str],
        slots: Sequence[str],
    ) -> None:
        self._adapters, self._heads, self.forms, self.slots = adapters, heads, list(forms), list(slots)
        self._form = {name: row for row, name in enumerate(forms)}
        self._slot = {name: row for row, name in enumerate(slots)}

    def scores(self, words: Words, found: Sequence[Chunk], meant: Sequence[Candidate], situation: Words) -> Floats:
        """Logarithm of each candidate's probability (n,); all the same for a sentence that is too long."""
        text = read(words, found, situation)
        if len(text.pieces) > LONGEST:
            return np.full(len(meant), -np.log(len(meant)), np.float32)
        states = transformer().states(text.pieces, text.second, self._adapters)
        form = self._head("form", np.concatenate([states[text.second :].mean(axis=0), states[0]]))
        slot = [self._head("slot", states[begin:end].mean(axis=0)) for begin, end in text.things]
        first, last = self._head("first", states), self._head("last", states)
        scores = np.zeros(len(meant), np.float32)
        for at, candidate in enumerate(meant):
            row = self._form.get(candidate.form)
            if row is None:  # a form that is newer than the network
                scores[at] = form.min()
                continue
            scores[at] = form[row] + sum(
                slot[of][self._slot[n]] for of, n in slots(candidate, found) if n in self._slot
            )
            if candidate.span is not None:
                begin, end = text.ends(candidate.span)
                scores[at] += first[begin][row] + last[end][row]
        scores -= scores.max()
        return np.asarray(scores - np.log(np.exp(scores).sum()), np.float32)

    def _head(self, name: str, states: Floats) -> Floats:
        weight, bias = self._heads[name]
        return np.asarray(states @ weight.T + bias, np.float32)

    @classmethod
    def load(cls, path: Traversable) -> "Network":
        """The network that `save` has written."""
        with path.open("rb") as file, np.load(file) as stored:
            arrays = {
                name: (stored[name] * stored[f"{name} step"]).astype(np.float32)
                for name in stored.files
                if f"{name} step" in stored.files
            }
            forms, slots = (bytes(stored[n]).decode().split("\n") for n in ("forms", "slots"))
        downs = {name.removesuffix(" down"): a for name, a in arrays.items() if name.endswith(" down")}
        return cls(
            {name: Adapter(down, arrays[f"{name} up"]) for name, down in downs.items()},
            {name: (arrays[f"{name} weight"], arrays[f"{name} bias"]) for name in ("form", "slot", "first", "last")},
            forms,
            slots,
        )

    def save(self, path: Path) -> None:
        """Write it with weights of 8 bits."""
        arrays = {f"{name} {of}": getattr(a, of) for name, a in self._adapters.items() for of in ("down", "up")}
        for name, (weight, bias) in self._heads.items():
            arrays |= {f"{name} weight": weight, f"{name} bias": bias}
        table: dict[str, np.ndarray] = {}
        for name, weights in arrays.items():
            table[name], table[f"{name} step"] = in_8_bits(weights)
        for name, listed in (("forms", self.forms), ("slots", self.slots)):
            table[name] = np.frombuffer("\n".join(listed).encode(), np.uint8)
        np.savez_compressed(path, **table)  # type: ignore[arg-type]
