"""Writing networks with packed weights, and the decoder that is written anew against the one that ships."""

from pathlib import Path

import numpy as np
import onnx
import pytest

from common.inference import session
from common.speech_weights import folder as models
from services.speech.recognise.moonshine import networks
from services.speech.recognise.packed_network import BLOCK, NetworkBuilder
from services.speech.recognise.token_trie import BOS
from services.speech.speak.voice import Voice

HEADS, LAYERS, WIDTH = 8, 8, 52


def test_packed_weights_multiply_as_unpacked_ones(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    q = rng.integers(-128, 128, (2 * BLOCK, 24)).astype(np.int8)
    scale, zero = np.array([0.02], np.float32), -7
    added = -zero * scale
    x = rng.normal(size=(3, 2 * BLOCK)).astype(np.float32)
    net = NetworkBuilder()
    doubled = net.op("Add", "x", "x")
    net.times(doubled, (q, scale, added), output="y")
    path = tmp_path / "net.onnx"
    onnx.save_model(net.model({"x": (np.float32, 2)}, ["y"]), path)
    (found,) = session(path).run(None, {"x": x})
    wanted = 2 * x @ (q * scale + added)
    assert np.abs(found - wanted).max() < 0.02 * np.abs(wanted).max()


@pytest.mark.slow
def test_the_decoder_finds_what_the_shipped_one_finds() -> None:
    shipped = session(models() / "decoder_model_merged.ort")
    names = [o.name for o in shipped.get_outputs()]
    encoder, decoder = networks()
    sound = Voice().speak("bring me the red mug").astype(np.float32) / np.float32(32768)
    hidden = encoder.run(None, {"input_values": np.stack([sound, sound[::-1]])})[0]
    attended, cache = decoder.cross_attention_cache(hidden), decoder.empty_cache(2)
    sequences, rows = np.array([[BOS, 518, 29915, 263], [BOS, 2803, 592, 278]]), [0, 0]
    for length in range(1, sequences.shape[1] + 1):
        scores, cache = decoder.step(attended, cache, rows, list(sequences[:, length - 1]))
        rows = [0, 1]
    empty = np.zeros((0, HEADS, 1, WIDTH), np.float32)
    feeds = {
        f"past_key_values.{k}.{side}.{what}": empty
        for k in range(LAYERS) for side in ("decoder", "encoder") for what in ("key", "value")
    }  # fmt: skip
    feeds |= {"use_cache_branch": np.array([False])}
    for row, sequence in enumerate(sequences):
        feeds |= {"encoder_hidden_states": hidden, "input_ids": np.tile(sequence, (2, 1))}
        logits = dict(zip(names, shipped.run(None, feeds), strict=True))["logits"][:, -1]
        wanted = (logits - np.log(np.exp(logits).sum(axis=1, keepdims=True))).mean(axis=0)
        likely = np.argsort(wanted)[-50:]
        assert np.abs(np.exp(scores[row][likely]) - np.exp(wanted[likely])).max() < 0.05
        assert np.abs(scores[row][likely] - wanted[likely]).max() < 0.5
