"""The recogniser's decoder as one step for many beginnings of an utterance at once, written anew from its weights.

The network that ships keeps what was heard for each beginning and gets its memory rearranged from outside; here it is
kept once, and the choice of the beginnings that go on happens inside. The matrices stay packed in 8 bits.
"""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from services.speech.recognise.packed_network import Net, Packed, return_memory

LAYERS, HEADS, WIDTH, TURNED = 8, 8, 52, 32
SIZE = HEADS * WIDTH
EPSILON = 1e-5
Array = NDArray[Any]


class Decoder:
    """Sessions for what was heard and for a step."""

    def __init__(self, path: Path, threads: int) -> None:
        packed = Packed(path)
        names = packed.multiplied()
        embedding, scale, added = packed.weight("model.decoder.embed_tokens.weight_merged_0_add_tensor")
        self._embedding = embedding.copy()
        self._scale, self._added = float(scale.ravel()[0]), float(added.ravel()[0])
        self._heard = _heard(packed, names, threads)
        self._step = _step(packed, names, (embedding.T, scale, added), threads)
        del packed, embedding
        return_memory()

    def heard(self, hidden: Array) -> dict[str, Array]:
        """What the encoder found, (renditions, frames, SIZE), as the layers look at it."""
        return dict(zip(_names("heard"), self._heard.run(None, {"hidden": hidden}), strict=True))

    def step(self, heard: dict[str, Array], past: Array, rows: list[int], tokens: list[int]) -> tuple[Array, Array]:
        """Log-probabilities (beginnings, tokens) after one more token each, and the new past.

        `rows` are the beginnings in `past` (2 LAYERS, renditions, beginnings, HEADS, length, WIDTH) that go on.
        """
        renditions = len(heard["heard0"])
        x = self._embedding[tokens].astype(np.float32) * self._scale + self._added
        feeds = {"x": np.tile(x, (renditions, 1, 1)), "rows": np.array(rows, np.int64), "past": past}
        feeds["turn"] = _turn(past.shape[4])
        scores, present = self._step.run(None, {**feeds, **heard})
        return scores, present

    @staticmethod
    def nothing(renditions: int) -> Array:
        """The past of the one beginning that there is at first."""
        return np.zeros((2 * LAYERS, renditions, 1, HEADS, 0, WIDTH), np.float32)


def _names(stem: str) -> list[str]:
    return [f"{stem}{k}" for k in range(2 * LAYERS)]


def _turn(position: int) -> Array:
    """The rotation (WIDTH, WIDTH) that tells a query or key its position."""
    angles = position / 10000.0 ** (np.arange(0, TURNED, 2) / TURNED)
    found = np.eye(WIDTH, dtype=np.float32)
    even, odd = np.arange(0, TURNED, 2), np.arange(1, TURNED, 2)
    found[even, even] = found[odd, odd] = np.cos(angles)
    found[odd, even], found[even, odd] = -np.sin(angles), np.sin(angles)
    return found


def _heard(packed: Packed, names: dict[str, str], threads: int) -> Any:
    """hidden -> per layer keys (renditions, HEADS, WIDTH, frames), scaled, and values (.., frames, WIDTH)."""
    net = Net()
    split, scale = net.shape(0, 0, HEADS, WIDTH), net.constant(np.array(WIDTH**-0.5, np.float32))
    for k in range(LAYERS):
        stem = f"/model/decoder/layers.{k}/encoder_attn/"
        for j, what in enumerate(("k_proj", "v_proj")):
            found = net.op("Reshape", net.times("hidden", packed.weight(names[f"{stem}{what}"])), split)
            output = f"heard{2 * k + j}"
            if j:
                net.op("Transpose", found, output=output, perm=[0, 2, 1, 3])
            else:
                net.op("Mul", net.op("Transpose", found, perm=[0, 2, 3, 1]), scale, output=output)
    return net.session({"hidden": (np.float32, 3)}, _names("heard"), threads)


def _step(packed: Packed, names: dict[str, str], embedding: tuple[Array, Array, Array], threads: int) -> Any:
    """One token for each beginning; x is (renditions, beginnings, SIZE)."""
    net, arrays = Net(), packed.arrays
    split, joined = net.shape(0, 0, HEADS, 1, WIDTH), net.shape(0, 0, SIZE)
    flat, scale = net.shape(0, 0, HEADS, WIDTH), net.constant(np.array(WIDTH**-0.5, np.float32))
    past = net.op("Gather", "past", "rows", axis=2)
    pasts = net.split(past, 2 * LAYERS)
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
        q, key = net.op("Mul", net.op("MatMul", q, "turn"), scale), net.op("MatMul", key, "turn")
        keys = net.op("Concat", pasts[2 * k], key, axis=3)
        values = net.op("Concat", pasts[2 * k + 1], value, axis=3)
        new += [keys, values]
        weights = net.op("Softmax", net.op("MatMul", q, net.op("Transpose", keys, perm=[0, 1, 2, 4, 3])), axis=-1)
        out = net.op("Reshape", net.op("MatMul", weights, values), joined)
        x = net.op("Add", x, times(out, "self_attn/dense"))

        h = normed(x, "post_attention_layernorm")
        q = net.op("Transpose", net.op("Reshape", times(h, "encoder_attn/q_proj"), flat), perm=[0, 2, 1, 3])
        weights = net.op("Softmax", net.op("MatMul", q, f"heard{2 * k}"), axis=-1)
        out = net.op("Transpose", net.op("MatMul", weights, f"heard{2 * k + 1}"), perm=[0, 2, 1, 3])
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
    inputs = {"x": (np.float32, 3), "rows": (np.int64, 1), "past": (np.float32, 6), "turn": (np.float32, 2)}
    return net.session({**inputs, **dict.fromkeys(_names("heard"), (np.float32, 4))}, ["scores", "present"], threads)
