"""CLIP (Radford et al., 2021) as a grounder: pictures of the objects and the phrase in one space, the nearest is meant.

Takes ONNX exports as the transformers' exporters write them: a folder with `model.onnx`, or with `vision_model.onnx`
and `text_model.onnx`, perhaps under `onnx/`, beside `tokenizer.json` and `preprocessor_config.json`.
"""

import importlib.util
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import onnxruntime as ort
from numpy.typing import NDArray
from PIL import Image

from services.perception.naming.grounders.grounder import Box, Choice, GrounderError, Question

Array = NDArray[np.float32]
FILES = ["*.json", "*model.onnx", "onnx/*model.onnx"]
"""What is fetched from a hub."""
TEMPLATES = ("a photo of a {}", "a {} on a table")
"""Sentences whose embeddings are averaged for a phrase; from the paper's prompts."""
BACKGROUND = ("a photo of an object", "a photo of a table", "a photo of something else", "a blurry photo")
"""What the picture of an object that is not meant is more like."""
TEMPERATURE = 100.0
"""Factor of the cosines before the softmax; what CLIP was trained with."""
PADDING = 0.15
"""Share of the object's box that is shown around it, so that it has an outline."""
CONTEXT = 77
"""Tokens of a sentence, unless the tokenizer says otherwise."""


class Preprocessor(msgspec.Struct):
    """`preprocessor_config.json`, as far as it is used."""

    size: dict[str, int] | int = 224
    crop_size: dict[str, int] | int = 224
    image_mean: tuple[float, ...] = (0.48145466, 0.4578275, 0.40821073)
    image_std: tuple[float, ...] = (0.26862954, 0.26130258, 0.27577711)

    @property
    def side(self) -> int:
        size = self.crop_size or self.size
        return size if isinstance(size, int) else next(iter(size.values()))


class Clip:
    """`source`: a folder, or the name of a repository on the Hugging Face hub; `least`: confidence of an answer."""

    def __init__(self, source: str, least: float) -> None:
        folder = _folder(source)
        if importlib.util.find_spec("tokenizers") is None:
            raise GrounderError("the package tokenizers is missing: pip install 'tidybot-zenoh[clip]'")
        from tokenizers import Tokenizer

        self._least = least
        try:
            self._tokenizer: Any = Tokenizer.from_file(str(_file(folder, "tokenizer.json")))
            raw = _file(folder, "preprocessor_config.json").read_bytes()
            self._pictures = msgspec.json.decode(raw, type=Preprocessor)
            both = _found(folder, "model.onnx")
            if both is not None:
                self._image = self._text = _session(both)
            else:
                self._image = _session(_file(folder, "vision_model.onnx"))
                self._text = _session(_file(folder, "text_model.onnx"))
        except GrounderError:
            raise
        except Exception as error:  # the tokenizer and onnxruntime raise bare ones for files that are none of theirs
            raise GrounderError(f"{folder} is no CLIP export: {error}") from None
        self._background: Array | None = None

    def choose(self, question: Question) -> Choice:
        """The candidate whose picture is most like the phrase, if it is more like it than like anything else."""
        if not question.candidates:
            return Choice(detail="nothing is in view")
        images = self._embed_images([_cut(question.picture, c.box) for c in question.candidates])
        if self._background is None:
            self._background = self._embed_texts(list(BACKGROUND))
        phrase = self._embed_texts([t.format(question.phrase) for t in TEMPLATES]).mean(axis=0, keepdims=True)
        texts = np.concatenate([_unit(phrase), self._background])
        likeness = TEMPERATURE * images @ texts.T
        among_texts = _softmax(likeness, axis=1)[:, 0]
        among_objects = _softmax(likeness[:, :1], axis=0)[:, 0]
        confidence = among_texts * among_objects
        best = int(confidence.argmax())
        found, sure = question.candidates[best], float(confidence[best])
        detail = f"CLIP: {found.label} {sure:.2f}"
        return Choice(found.key if sure >= self._least else "", sure, detail)

    def _embed_images(self, pictures: list[Image.Image]) -> Array:
        side = self._pictures.side
        mean, std = np.array(self._pictures.image_mean), np.array(self._pictures.image_std)
        pixels = [np.asarray(p.resize((side, side), Image.Resampling.BICUBIC), np.float32) / 255 for p in pictures]
        batch = np.stack([((p - mean) / std).transpose(2, 0, 1) for p in pixels]).astype(np.float32)
        return self._run(self._image, "image_embeds", pixel_values=batch)

    def _embed_texts(self, texts: list[str]) -> Array:
        rows = [self._tokenizer.encode(text).ids for text in texts]
        longest = min(CONTEXT, max(map(len, rows)))
        ids, mask = np.zeros((len(rows), longest), np.int64), np.zeros((len(rows), longest), np.int64)
        for i, row in enumerate(rows):
            # What is too long loses its end but not the last token, at which the sentence is read off.
            kept = row if len(row) <= longest else [*row[: longest - 1], row[-1]]
            ids[i, : len(kept)], mask[i, : len(kept)] = kept, 1
            ids[i, len(kept) :] = kept[-1]
        return self._run(self._text, "text_embeds", input_ids=ids, attention_mask=mask)

    def _run(self, session: Any, output: str, **inputs: NDArray[Any]) -> Array:
        """Unit vectors (n, d). A network of both kinds wants both inputs: the other one is blank."""
        n = len(next(iter(inputs.values())))
        for wanted in session.get_inputs():
            if wanted.name not in inputs:
                inputs[wanted.name] = self._blank(wanted.name, n)
        names = [o.name for o in session.get_outputs()]
        if output not in names:
            raise GrounderError(f"the network has no output {output}, but {', '.join(names)}")
        wanted_names = {w.name for w in session.get_inputs()}
        try:
            (found,) = session.run([output], {k: v for k, v in inputs.items() if k in wanted_names})
        except Exception as error:  # onnxruntime's own have no common base
            raise GrounderError(f"the network cannot be run: {error}") from None
        return _unit(np.asarray(found, np.float32))

    def _blank(self, name: str, n: int) -> NDArray[Any]:
        if name == "pixel_values":
            return np.zeros((n, 3, self._pictures.side, self._pictures.side), np.float32)
        return np.ones((n, 1), np.int64)


def _folder(source: str) -> Path:
    """The folder of an export; one from a hub is fetched once and kept by the hub's client."""
    if not source:
        raise GrounderError("set perception.clip_model to the folder of an ONNX export, or to its name on a hub")
    path = Path(source).expanduser()
    if path.is_dir():
        return path
    if path.is_absolute() or source.count("/") != 1 or source.startswith("."):
        raise GrounderError(f"there is no folder {source}")
    if importlib.util.find_spec("huggingface_hub") is None:
        raise GrounderError(f"there is no folder {source}; to fetch it from a hub: pip install 'tidybot-zenoh[clip]'")
    import huggingface_hub

    try:
        return Path(huggingface_hub.snapshot_download(source, allow_patterns=FILES))
    except Exception as error:  # network, credentials, no such repository: the client's errors have no common base
        raise GrounderError(f"{source} is no folder and cannot be fetched: {error}") from None


def _found(folder: Path, name: str) -> Path | None:
    return next((p for p in (folder / name, folder / "onnx" / name) if p.is_file()), None)


def _file(folder: Path, name: str) -> Path:
    path = _found(folder, name)
    if path is None:
        raise GrounderError(f"{folder} has no {name}; export the model to ONNX with its tokenizer and preprocessor")
    return path


def _session(path: Path) -> Any:
    options = ort.SessionOptions()
    options.intra_op_num_threads = 1
    return ort.InferenceSession(str(path), options, providers=["CPUExecutionProvider"])


def _cut(picture: NDArray[np.uint8], box: Box) -> Image.Image:
    """The square around a box, filled with grey where the picture ends."""
    left, top, right, bottom = box
    half = max(right - left, bottom - top) * (0.5 + PADDING)
    x, y = (left + right) / 2, (top + bottom) / 2
    whole = Image.fromarray(picture)
    return whole.transform(
        (224, 224), Image.Transform.EXTENT, (x - half, y - half, x + half, y + half), fillcolor=(128, 128, 128)
    )


def _unit(rows: Array) -> Array:
    return np.asarray(rows / np.maximum(np.linalg.norm(rows, axis=-1, keepdims=True), 1e-9), np.float32)


def _softmax(values: Array, axis: int) -> Array:
    powers = np.exp(values - values.max(axis=axis, keepdims=True))
    return np.asarray(powers / powers.sum(axis=axis, keepdims=True), np.float32)
