"""The recogniser's decoder as one step for many beam hypotheses at once, rebuilt from the weights of the shipped one.

The shipped network keeps the encoder's keys and values for each hypothesis, gets its cache rearranged from outside and
unpacks its weights at each run: six times the CPU time (`python -m bench.recogniser`). Here the encoder's part is kept
once, the choice of the hypotheses that go on happens inside, and the matrices stay packed in 8 bits.
"""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from common.process.host import return_memory
from services.speech.recognise.packed_network import NetworkBuilder, PackedWeights, Weight

LAYERS, HEADS, HEAD_SIZE, ROTARY_SIZE = 8, 8, 52, 32
"""Moonshine base: decoder layers, attention heads, numbers per head, and how many of them are rotated by position."""
MODEL_SIZE = HEADS * HEAD_SIZE
ROTARY_BASE = 10000.0
"""Base of the rotary embedding's frequencies (Su et al., "RoFormer", 2021)."""
EPSILON = 1e-5
"""Added to the variance in layer normalisation, as in the shipped network."""
Array = NDArray[Any]
Cache = dict[str, Array]


class Decoder:
    """Sessions of two networks: the cross-attention cache of an utterance, and one step of decoding."""

    def __init__(self, path: Path, threads: int) -> None:
        packed = PackedWeights(path)
        embedding, scale, added = packed.weight("model.decoder.embed_tokens.weight_merged_0_add_tensor")
        self._embedding = embedding.copy()
        self._scale, self._added = float(scale.ravel()[0]), float(added.ravel()[0])
        self._cross = _cross_attention_network(packed, threads)
        self._step = _step_network(packed, (embedding.T, scale, added), threads)
        del packed, embedding
        return_memory()

    def cross_attention_cache(self, hidden: Array) -> Cache:
        """Keys and values per layer of what the encoder found, (variants, frames, MODEL_SIZE)."""
        return dict(zip(_cross_names(), self._cross.run(None, {"hidden": hidden}), strict=True))

    def step(self, attended: Cache, cache: Array, rows: list[int], tokens: list[int]) -> tuple[Array, Array]:
        """Log-probabilities (hypotheses, tokens) after one more token each, and the new cache.

        `rows` are the hypotheses in `cache` (2 LAYERS, variants, hypotheses, HEADS, length, HEAD_SIZE) that go on.
        """
        variants = len(attended["cross0"])
        x = self._embedding[tokens].astype(np.float32) * self._scale + self._added
        feeds = {"x": np.tile(x, (variants, 1, 1)), "rows": np.array(rows, np.int64), "cache": cache}
        feeds["rotation"] = rotary_embedding(cache.shape[4])
        scores, present = self._step.run(None, {**feeds, **attended})
        return scores, present

    @staticmethod
    def empty_cache(variants: int) -> Array:
        """The cache of the one hypothesis that there is at first."""
        return np.zeros((2 * LAYERS, variants, 1, HEADS, 0, HEAD_SIZE), np.float32)


def _cross_names() -> list[str]:
    return [f"cross{k}" for k in range(2 * LAYERS)]


def rotary_embedding(position: int) -> Array:
    """Rotation (HEAD_SIZE, HEAD_SIZE) that a query or key of that position is multiplied by."""
    angles = position / ROTARY_BASE ** (np.arange(0, ROTARY_SIZE, 2) / ROTARY_SIZE)
    found = np.eye(HEAD_SIZE, dtype=np.float32)
    even, odd = np.arange(0, ROTARY_SIZE, 2), np.arange(1, ROTARY_SIZE, 2)
    found[even, even] = found[odd, odd] = np.cos(angles)
    found[odd, even], found[even, odd] = -np.sin(angles), np.sin(angles)
    return found


def _cross_attention_network(packed: PackedWeights, threads: int) -> Any:
    """hidden -> per layer keys (variants, HEADS, HEAD_SIZE, frames), scaled, and values (.., frames, HEAD_SIZE)."""
    net, names = NetworkBuilder(), packed.by_layer()
    split, scale = net.shape(0, 0, HEADS, HEAD_SIZE), net.constant(np.array(HEAD_SIZE**-0.5, np.float32))
    for k in range(LAYERS):
        stem = f"/model/decoder/layers.{k}/encoder_attn/"
        for j, what in enumerate(("k_proj", "v_proj")):
            found = net.op("Reshape", net.times("hidden", packed.weight(names[f"{stem}{what}"])), split)
            output = f"cross{2 * k + j}"
            if j:
                net.op("Transpose", found, output=output, perm=[0, 2, 1, 3])
            else:
                net.op("Mul", net.op("Transpose", found, perm=[0, 2, 3, 1]), scale, output=output)
    return net.session({"hidden": (np.float32, 3)}, _cross_names(), threads)


def _step_network(packed: PackedWeights, embedding: Weight, threads: int) -> Any:
    """One token for each hypothesis; x is (variants, hypotheses, MODEL_SIZE)."""
    net, arrays, names = NetworkBuilder(), packed.arrays, packed.by_layer()
    split, joined = net.shape(0, 0, HEADS, 1, HEAD_SIZE), net.shape(0, 0, MODEL_SIZE)
    flat, scale = net.shape(0, 0, HEADS, HEAD_SIZE), net.constant(np.array(HEAD_SIZE**-0.5, np.float32))
    cache = net.op("Gather", "cache", "rows", axis=2)
    pasts = net.split(cache, 2 * LAYERS)
    x, new = "x", []
    for k in range(LAYERS):
        stem = f"/model/decoder/layers.{k}/"
        norm = f"model.decoder.layers.{k}."

        def normed(value: str, which: str, norm: str = norm) -> str:
            weight = net.constant(arrays[f"{norm}{which}.weight_merged_0"])
            return net.op("LayerNormalization", value, weight, axis=-1, epsilon=EPSILON)

        def times(value: str, which: str, stem: str = stem) -> str:
            return net.times(value, packed.weight(names[stem + which]))

        h = normed(x, "input_layernorm")
        q, key, value = (net.op("Reshape", times(h, f"self_attn/{w}_proj"), split) for w in "qkv")
        q, key = net.op("Mul", net.op("MatMul", q, "rotation"), scale), net.op("MatMul", key, "rotation")
        keys = net.op("Concat", pasts[2 * k], key, axis=3)
        values = net.op("Concat", pasts[2 * k + 1], value, axis=3)
        new += [keys, values]
        weights = net.op("Softmax", net.op("MatMul", q, net.op("Transpose", keys, perm=[0, 1, 2, 4, 3])), axis=-1)
        out = net.op("Reshape", net.op("MatMul", weights, values), joined)
        x = net.op("Add", x, times(out, "self_attn/dense"))

        h = normed(x, "post_attention_layernorm")
        q = net.op("Transpose", net.op("Reshape", times(h, "encoder_attn/q_proj"), flat), perm=[0, 2, 1, 3])
        weights = net.op("Softmax", net.op("MatMul", q, f"cross{2 * k}"), axis=-1)
        out = net.op("Transpose", net.op("MatMul", weights, f"cross{2 * k + 1}"), perm=[0, 2, 1, 3])
        x = net.op("Add", x, times(net.op("Reshape", out, joined), "encoder_attn/dense"))

        h = normed(x, "final_layernorm")
        up = net.op("Add", times(h, "mlp/up_proj"), net.constant(arrays[f"{norm}mlp.up_proj.bias_merged_0"]))
        plain, gate = net.split(up, 2, axis=-1)
        active = net.op("Mul", plain, net.op("Mul", gate, net.op("Sigmoid", gate)))
        down = net.op("Add", times(active, "mlp/down_proj"), net.constant(arrays[f"{norm}mlp.down_proj.bias_merged_0"]))
        x = net.op("Add", x, down)
    weight = net.constant(arrays["model.decoder.norm.weight_merged_0"])
    logits = net.times(net.op("LayerNormalization", x, weight, axis=-1, epsilon=EPSILON), embedding)
    net.op("ReduceMean", net.op("LogSoftmax", logits, axis=-1), output="scores", axes=[0], keepdims=0)
    first = net.shape(0)
    net.op("Concat", *(net.op("Unsqueeze", n, first) for n in new), output="present", axis=0)
    inputs = {"x": (np.float32, 3), "rows": (np.int64, 1), "cache": (np.float32, 6), "rotation": (np.float32, 2)}
    return net.session({**inputs, **dict.fromkeys(_cross_names(), (np.float32, 4))}, ["scores", "present"], threads)
