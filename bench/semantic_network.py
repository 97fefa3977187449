"""The network of services/planner/semantic/network.py in torch, where its adapters and heads are learnt."""

import math
import random
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import torch
from torch import nn
from torch.nn import functional

from bench.labelled import Labelled
from common.language.transformer import HEADS, LAYERS, PARTS, SIZE, Adapter, transformer
from services.planner.semantic.network import Network, Read, read, slots

RANK = 16
"""Width of the matrices that are added (chosen: 0.7 MB)."""
DROPPED = 0.1
"""Share of numbers left out while learning, as the network was trained."""
RATE, HEAD_RATE = 1e-3, 2e-3
"""Greatest learning rates of adapters and heads (chosen)."""
DECAY, HEAD_DECAY = 0.01, 0.05
"""Weight decay of both (chosen)."""
WARM = 100
"""Steps until the greatest learning rate; from there it falls to 0 in a line."""
SCALE = 2.0
"""Weight of what the adapters add."""
BATCH, SORTED = 32, 20
"""Sentences of a step, and steps whose sentences are sorted by length so that few are filled up."""
EPOCHS = 4
"""Times that each sentence is seen (chosen on lists left out: 86 in a hundred ranked first, 85 after three)."""
SEED = 0
"""Of the order of sentences and of the first weights."""


class Prepared(NamedTuple):
    """A sentence for the network: `slots` and `spans` of its candidates by number, `right`: which of those are."""

    text: Read
    forms: list[int]
    slots: list[tuple[int, int, int]]
    spans: list[tuple[int, int, int]]
    right: list[bool]


class Names:
    """Numbers of forms and slots in the order in which they are met."""

    def __init__(self) -> None:
        self.forms: dict[str, int] = {}
        self.slots: dict[str, int] = {}

    def prepared(self, row: Labelled) -> Prepared:
        """One sentence in numbers."""
        text = read(row.words, row.found, row.situation)
        forms = [self.forms.setdefault(c.form, len(self.forms)) for c in row.meant]
        roles: list[tuple[int, int, int]] = []
        spans: list[tuple[int, int, int]] = []
        for at, c in enumerate(row.meant):
            roles += [(at, n, self.slots.setdefault(name, len(self.slots))) for n, name in slots(c, row.found)]
            if c.span is not None:
                spans.append((at, *text.ends(c.span)))
        return Prepared(text, forms, roles, spans, row.right)


def learn(rows: Sequence[Labelled]) -> Network:
    """The network that makes the right candidates of sentences most likely."""
    names, chance = Names(), random.Random(SEED)
    prepared = [names.prepared(row) for row in rows]
    tuned = _Tuned(len(names.forms), len(names.slots), EPOCHS * math.ceil(len(prepared) / BATCH))
    for epoch in range(EPOCHS):
        losses: list[float] = []
        for batch in _batches(prepared, chance):
            losses.append(tuned.step(batch))
            if len(losses) % 100 == 0:
                print(
                    f"epoch {epoch + 1} of {EPOCHS}, step {len(losses)}: loss {np.mean(losses[-100:]):.3f}", flush=True
                )
    return tuned.network(list(names.forms), list(names.slots))


def _batches(rows: Sequence[Prepared], chance: random.Random) -> list[list[Prepared]]:
    """All sentences once, those of like length together."""
    order, step = chance.sample(rows, len(rows)), BATCH * SORTED
    groups = [sorted(order[at : at + step], key=lambda p: len(p.text.pieces)) for at in range(0, len(order), step)]
    found = [group[at : at + BATCH] for group in groups for at in range(0, len(group), BATCH)]
    return chance.sample(found, len(found))


class _Adapted(nn.Module):
    def __init__(self, name: str) -> None:
        super().__init__()
        weight, bias = transformer().matrix(name)
        self.register_buffer("weight", torch.tensor(weight.T.copy()))
        self.register_buffer("bias", torch.tensor(bias))
        self.down = nn.Parameter(torch.randn(RANK, weight.shape[0]) / math.sqrt(weight.shape[0]))
        self.up = nn.Parameter(torch.zeros(weight.shape[1], RANK))

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        added = functional.linear(functional.linear(x, self.down), self.up)
        return functional.linear(x, self.weight, self.bias) + SCALE * added


class _Norm(nn.LayerNorm):
    def __init__(self, name: str) -> None:
        super().__init__(SIZE, eps=1e-12)
        weight, bias = transformer().matrix(name)
        self.weight = nn.Parameter(torch.tensor(weight), requires_grad=False)
        self.bias = nn.Parameter(torch.tensor(bias), requires_grad=False)


class _Layer(nn.Module):
    def __init__(self, number: int) -> None:
        super().__init__()
        name = f"encoder.layer.{number}."
        self.parts = nn.ModuleDict({part.replace(".", "/"): _Adapted(name + part) for part in PARTS})
        self.after, self.last = _Norm(f"{name}attention.output.LayerNorm"), _Norm(f"{name}output.LayerNorm")
        self.drop = nn.Dropout(DROPPED)

    def forward(self, x: torch.Tensor, mask: torch.Tensor) -> torch.Tensor:
        query, key, value, after, wide, narrow = (self.parts[part.replace(".", "/")] for part in PARTS)
        q, k, v = (part(x).unflatten(-1, (HEADS, -1)).transpose(1, 2) for part in (query, key, value))
        seen = functional.scaled_dot_product_attention(q, k, v, attn_mask=mask).transpose(1, 2).flatten(2)
        x = self.after(x + self.drop(after(seen)))
        return self.last(x + self.drop(narrow(functional.gelu(wide(x), approximate="tanh"))))


class _Model(nn.Module):
    def __init__(self, forms: int, slots: int) -> None:
        super().__init__()
        self.norm = _Norm("embeddings.LayerNorm")
        self.layers = nn.ModuleList(_Layer(number) for number in range(LAYERS))
        sizes = {"form": (2 * SIZE, forms), "slot": (SIZE, slots), "first": (SIZE, forms), "last": (SIZE, forms)}
        self.heads = nn.ModuleDict({name: nn.Linear(*size) for name, size in sizes.items()})
        for head in self.heads.values():
            nn.init.normal_(head.weight, std=0.02)
            nn.init.zeros_(head.bias)
        self.drop = nn.Dropout(DROPPED)

    def forward(self, batch: Sequence[Prepared]) -> tuple[torch.Tensor, torch.Tensor]:
        """Score of every candidate, and the number of its sentence."""
        longest = max(len(p.text.pieces) for p in batch)
        x = torch.zeros(len(batch), longest, SIZE)
        here, own = torch.zeros(len(batch), longest, dtype=torch.bool), torch.zeros(len(batch), longest, 1)
        for at, p in enumerate(batch):
            n = len(p.text.pieces)
            x[at, :n] = torch.from_numpy(transformer().embedded(p.text.pieces, p.text.second))
            here[at, :n] = True
            own[at, p.text.second : n] = 1.0
        mask = torch.zeros(len(batch), 1, 1, longest).masked_fill(~here[:, None, None], -1e9)
        x = self.drop(self.norm(x))
        for layer in self.layers:
            x = layer(x, mask)
        x = self.drop(x)
        form = self.heads["form"](torch.cat([(x * own).sum(1) / own.sum(1), x[:, 0]], -1))
        scores = [self._scores(x[at], form[at], p) for at, p in enumerate(batch)]
        of = torch.tensor([at for at, p in enumerate(batch) for _ in p.forms])
        return torch.cat(scores), of

    def _scores(self, states: torch.Tensor, form: torch.Tensor, p: Prepared) -> torch.Tensor:
        scores = form[torch.tensor(p.forms)]
        if p.slots:
            things = torch.stack([states[begin:end].mean(0) for begin, end in p.text.things])
            at, thing, name = torch.tensor(p.slots).T
            scores = scores.index_add(0, at, self.heads["slot"](things)[thing, name])
        if p.spans:
            at, first, last = torch.tensor(p.spans).T
            of = torch.tensor(p.forms)[at][:, None]
            ends = self.heads["first"](states[first]).gather(1, of) + self.heads["last"](states[last]).gather(1, of)
            scores = scores.index_add(0, at, ends[:, 0])
        return scores


class _Tuned:
    """A network while it learns, in `steps` steps."""

    def __init__(self, forms: int, slots: int, steps: int) -> None:
        torch.manual_seed(SEED)
        self._model = _Model(forms, slots)
        heads = [p for n, p in self._model.named_parameters() if n.startswith("heads")]
        adapters = [p for n, p in self._model.named_parameters() if p.requires_grad and not n.startswith("heads")]
        groups: list[dict[str, Any]] = [
            {"params": adapters, "lr": RATE, "weight_decay": DECAY},
            {"params": heads, "lr": HEAD_RATE, "weight_decay": HEAD_DECAY},
        ]
        self._optimiser = torch.optim.AdamW(groups)
        self._rate = torch.optim.lr_scheduler.LambdaLR(
            self._optimiser, lambda step: min(1.0, (step + 1) / WARM) * max(0.0, 1 - step / steps)
        )

    def step(self, batch: Sequence[Prepared]) -> float:
        """Learn from some sentences; returns the mean negative logarithm of the probability of what is right."""
        scores, of = self._model(batch)
        right = torch.tensor([r for p in batch for r in p.right])
        loss = (_log_sums(scores, of, len(batch)) - _log_sums(scores[right], of[right], len(batch))).mean()
        self._optimiser.zero_grad()
        loss.backward()
        nn.utils.clip_grad_norm_(self._model.parameters(), 1.0)
        self._optimiser.step()
        self._rate.step()
        return float(loss)

    def network(self, forms: Sequence[str], slots: Sequence[str]) -> Network:
        """What was learnt, to be used without torch."""
        adapters = {
            f"encoder.layer.{number}.{part}": Adapter(_array(of.down), SCALE * _array(of.up))
            for number, layer in enumerate(self._model.layers)
            for part, of in zip(PARTS, layer.parts.values(), strict=True)
        }
        heads = {name: (_array(head.weight), _array(head.bias)) for name, head in self._model.heads.items()}
        return Network(adapters, heads, forms, slots)


def _log_sums(scores: torch.Tensor, of: torch.Tensor, n: int) -> torch.Tensor:
    """Logarithm of the sum of the exponentials of each sentence's scores."""
    most = torch.full((n,), -1e9).scatter_reduce(0, of, scores.detach(), "amax")
    return most + torch.log(torch.zeros(n).index_add(0, of, torch.exp(scores - most[of])))


def _array(of: torch.Tensor) -> Any:
    return np.asarray(of.detach().numpy(), np.float32)
