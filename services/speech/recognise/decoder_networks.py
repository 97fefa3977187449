"""Writes the networks of the rebuilt decoder (`decoder.py`), from the weights of the shipped one."""

from pathlib import Path

import numpy as np
import onnx

from services.speech.recognise.decoder import (
    CROSS,
    EMBEDDING,
    EMBEDDING_SCALE,
    HEAD_SIZE,
    HEADS,
    LAYERS,
    MODEL_SIZE,
    STEP,
    cross_names,
)
from services.speech.recognise.packed_network import NetworkBuilder, PackedWeights, Weight

EPSILON = 1e-5
"""Added to the variance in layer normalisation, as in the shipped network."""


def write(path: Path, folder: Path) -> None:
    """Write the decoder of an ORT file into a folder."""
    packed = PackedWeights(path)
    embedding, scale, added = packed.weight("model.decoder.embed_tokens.weight_merged_0_add_tensor")
    np.save(folder / EMBEDDING, embedding)
    np.save(folder / EMBEDDING_SCALE, np.array([scale.ravel()[0], added.ravel()[0]], np.float32))
    onnx.save_model(_cross_attention_network(packed), folder / CROSS)
    onnx.save_model(_step_network(packed, (embedding.T, scale, added)), folder / STEP)


def _cross_attention_network(packed: PackedWeights) -> onnx.ModelProto:
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
    return net.model({"hidden": (np.float32, 3)}, cross_names())


def _step_network(packed: PackedWeights, embedding: Weight) -> onnx.ModelProto:
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
    return net.model({**inputs, **dict.fromkeys(cross_names(), (np.float32, 4))}, ["scores", "present"])
