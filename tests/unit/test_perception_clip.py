"""CLIP as a grounder, on a tiny network made here: pictures and sentences are their mean colours."""

from pathlib import Path
from typing import Any

import numpy as np
import onnx
import pytest
from onnx import TensorProto, helper, numpy_helper

from common.runtime import StartError
from services.perception.config import PerceptionConfig
from services.perception.naming.grounders.clip import Clip
from services.perception.naming.grounders.grounder import Candidate, GrounderError, Question
from services.perception.naming.grounders.load import load_grounder

tokenizers = pytest.importorskip("tokenizers", reason="the extra `clip`")

COLOURS = {"red": (1.0, -1.0, -1.0), "green": (-1.0, 1.0, -1.0), "blue": (-1.0, -1.0, 1.0)}
PLAIN = (0.01, 0.01, 0.01)
WORDS = ["[UNK]", "a", "photo", "of", "on", "table", "box", "object", "something", "else", "blurry", "an", *COLOURS]


def network(path: Path, *parts: str) -> None:
    """Embeds `image`s as their mean colour, `text`s as the sum of their words' colours."""
    table = np.array([COLOURS.get(word, PLAIN) for word in WORDS], np.float32)
    nodes, inputs, outputs = [], [], []
    if "image" in parts:
        nodes += [
            helper.make_node("GlobalAveragePool", ["pixel_values"], ["pooled"]),
            helper.make_node("Flatten", ["pooled"], ["image_embeds"]),
        ]
        inputs.append(helper.make_tensor_value_info("pixel_values", TensorProto.FLOAT, ["n", 3, 8, 8]))
        outputs.append(helper.make_tensor_value_info("image_embeds", TensorProto.FLOAT, ["n", 3]))
    if "text" in parts:
        nodes += [
            helper.make_node("Gather", ["table", "input_ids"], ["words"]),
            helper.make_node("ReduceSum", ["words", "axes"], ["text_embeds"], keepdims=0),
        ]
        inputs.append(helper.make_tensor_value_info("input_ids", TensorProto.INT64, ["m", "l"]))
        outputs.append(helper.make_tensor_value_info("text_embeds", TensorProto.FLOAT, ["m", 3]))
    constants = [numpy_helper.from_array(table, "table"), numpy_helper.from_array(np.array([1], np.int64), "axes")]
    graph = helper.make_graph(nodes, "tiny", inputs, outputs, constants if "text" in parts else [])
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)], ir_version=8)
    onnx.checker.check_model(model)
    path.parent.mkdir(parents=True, exist_ok=True)
    onnx.save(model, str(path))


@pytest.fixture(params=["one", "two"])
def folder(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    if request.param == "one":
        network(tmp_path / "model.onnx", "image", "text")
    else:
        network(tmp_path / "onnx" / "vision_model.onnx", "image")
        network(tmp_path / "onnx" / "text_model.onnx", "text")
    vocabulary = {word: n for n, word in enumerate(WORDS)}
    tokenizer = tokenizers.Tokenizer(tokenizers.models.WordLevel(vocabulary, unk_token="[UNK]"))
    tokenizer.pre_tokenizer = tokenizers.pre_tokenizers.Whitespace()
    tokenizer.save(str(tmp_path / "tokenizer.json"))
    (tmp_path / "preprocessor_config.json").write_text(
        '{"crop_size": {"height": 8, "width": 8}, "image_mean": [0.5, 0.5, 0.5], "image_std": [0.5, 0.5, 0.5]}'
    )
    return tmp_path


def question(phrase: str, *colours: tuple[int, int, int]) -> Question:
    picture = np.full((60, 60 * max(1, len(colours)), 3), 128, np.uint8)
    candidates = []
    for n, colour in enumerate(colours):
        left = 60 * n + 15
        picture[15:45, left : left + 30] = colour
        candidates.append(Candidate(f"object-{n}", f"thing {n}", (left, 15, left + 30, 45)))
    return Question(phrase, picture, tuple(candidates))


RED, GREEN, BLUE, GREY = (230, 20, 20), (20, 220, 30), (10, 30, 230), (128, 128, 128)


@pytest.mark.parametrize(
    ("phrase", "key"), [("red box", "object-1"), ("green box", "object-0"), ("blue box", "object-2")]
)
def test_the_object_whose_picture_is_like_the_phrase_is_chosen(folder: Path, phrase: str, key: str) -> None:
    choice = Clip(str(folder), 0.5).choose(question(phrase, GREEN, RED, BLUE))
    assert choice.key == key and choice.confidence > 0.9 and choice.detail


def test_what_is_not_there_is_not_chosen(folder: Path) -> None:
    clip = Clip(str(folder), 0.5)
    assert clip.choose(question("red box", GREEN, BLUE)).key == ""
    assert clip.choose(question("red box")).key == ""


def test_of_two_alike_none_is_chosen(folder: Path) -> None:
    assert Clip(str(folder), 0.6).choose(question("red box", RED, RED)).key == ""


def test_a_long_phrase_is_cut_and_an_object_at_the_edge_is_padded(folder: Path) -> None:
    asked = question("red " + "box " * 200, GREEN, RED)
    edge = Question(asked.phrase, asked.picture[:45, :105], asked.candidates)
    assert Clip(str(folder), 0.5).choose(edge).key == "object-1"


@pytest.mark.parametrize("name", ["tokenizer.json", "preprocessor_config.json"])
@pytest.mark.parametrize("content", [None, b"{]"])
def test_an_incomplete_or_broken_export_is_refused_at_the_start(folder: Path, name: str, content: bytes | None) -> None:
    if content is None:
        (folder / name).unlink()
    else:
        (folder / name).write_bytes(content)
    with pytest.raises(GrounderError, match=r"no CLIP export|has no"):
        Clip(str(folder), 0.5)


def test_a_network_of_another_kind_is_refused_with_what_it_has(folder: Path) -> None:
    for path in folder.rglob("*.onnx"):
        path.unlink()
    network(folder / "vision_model.onnx", "text")
    network(folder / "text_model.onnx", "text")
    with pytest.raises(GrounderError, match="text_embeds"):
        Clip(str(folder), 0.5).choose(question("red box", RED))


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"grounder": "clip"}, "perception.clip_model"),
        ({"grounder": "clip", "clip_model": "/nowhere"}, "no folder /nowhere"),
        ({"grounder": "vision"}, "perception.vision_url"),
        ({"grounder": "vision", "vision_url": "http://127.0.0.1:1/v1"}, "perception.vision_model"),
        ({"grounder": "oracle"}, "words, clip or vision"),
    ],
)
def test_a_grounder_that_cannot_work_ends_the_start_with_what_to_do(settings: dict[str, Any], message: str) -> None:
    with pytest.raises(StartError, match=message):
        load_grounder(PerceptionConfig(**settings))


def test_by_default_nobody_else_is_asked() -> None:
    assert load_grounder(PerceptionConfig()) is None


def test_an_export_from_a_hub_is_fetched_by_its_client(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    hub = pytest.importorskip("huggingface_hub")
    asked: list[str] = []

    def download(source: str, allow_patterns: list[str]) -> str:
        asked.append(source)
        if source == "a/missing":
            raise OSError("no such repository")
        return str(folder)

    monkeypatch.setattr(hub, "snapshot_download", download)
    assert Clip("somebody/clip", 0.5).choose(question("red box", RED, GREEN)).key == "object-0"
    with pytest.raises(GrounderError, match="no such repository"):
        Clip("a/missing", 0.5)
    assert asked == ["somebody/clip", "a/missing"]
