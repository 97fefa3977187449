"""Networks with 8-bit weights as they ship, multiplied without being unpacked: a quarter of the memory, and faster for
few rows. The ORT files themselves unpack each weight at each run."""

import ctypes
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from services.speech.recognise import protobuf as pb

BLOCK = 32
Array = NDArray[Any]


class Packed:
    """An ORT file: its operations and its 8-bit weights by the name of what they multiply."""

    def __init__(self, path: Path) -> None:
        with tempfile.TemporaryDirectory(prefix="tidybot-") as folder:
            self.model = _written(path, Path(folder)).read_bytes()
        self.graph = pb.every(self.model, pb.MODEL_GRAPH)[0]
        self.arrays = dict(pb.array(t) for t in pb.every(self.graph, pb.GRAPH_INITIALISER))
        self.nodes: list[memoryview] = pb.every(self.graph, pb.GRAPH_NODE)

    def weight(self, name: str) -> tuple[Array, Array, Array]:
        """A matrix (inputs, outputs) as int8, its scale and what is added: w = q * scale + added."""
        stem = name.removesuffix("_add_tensor")
        return self.arrays[f"{stem}_quantized"], self.arrays[f"{stem}_scale"], self.arrays[f"{stem}_zero_point"]

    def is_weight(self, name: str) -> bool:
        """True for the unpacked form of a matrix that can be multiplied packed."""
        packed = self.arrays.get(name.removesuffix("_add_tensor") + "_quantized")
        return name.endswith("_add_tensor") and packed is not None and packed.ndim == 2 and not packed.shape[0] % BLOCK

    def multiplied(self) -> dict[str, str]:
        """Weights by the path of the layer that multiplies them."""
        found = {}
        for raw in (n for graph in self._branches() for n in pb.every(graph, pb.GRAPH_NODE)):
            if pb.texts(raw, pb.NODE_TYPE)[0] == "MatMul":
                by = pb.texts(raw, pb.NODE_INPUT)[1]
                if self.is_weight(by):
                    found[pb.texts(raw, pb.NODE_OUTPUT)[0].removesuffix("/MatMul_output_0")] = by
        return found

    def _branches(self) -> list[memoryview]:
        choices = [n for n in self.nodes if pb.texts(n, pb.NODE_TYPE)[0] == "If"]
        attributes = [a for n in choices for a in pb.every(n, pb.NODE_ATTRIBUTE)]
        return [g for a in attributes for g in pb.every(a, pb.ATTRIBUTE_GRAPH)]


class Net:
    """A network under construction: operations return the names of what they make."""

    def __init__(self) -> None:
        self.nodes: list[bytes] = []
        self.tensors: list[bytes] = []
        self._count = 0

    def constant(self, values: Array) -> str:
        """Its name."""
        self._count += 1
        self.tensors.append(pb.tensor(f"c{self._count}", np.ascontiguousarray(values)))
        return f"c{self._count}"

    def shape(self, *sizes: int) -> str:
        return self.constant(np.array(sizes, np.int64))

    def op(self, kind: str, *inputs: str, output: str = "", domain: str = "", **attributes: Any) -> str:
        """One operation with one result."""
        self._count += 1
        output = output or f"t{self._count}"
        self.nodes.append(pb.node(kind, inputs, [output], domain, **attributes))
        return output

    def split(self, x: str, parts: int, axis: int = 0) -> list[str]:
        """Equal parts along an axis; along the first one it disappears."""
        self._count += 1
        names = [f"s{self._count}_{k}" for k in range(parts)]
        self.nodes.append(pb.node("Split", [x], names, axis=axis))
        return names if axis else [self.op("Squeeze", name, self.shape(0)) for name in names]

    def times(self, x: str, weight: tuple[Array, Array, Array], output: str = "") -> str:
        """x (..., inputs) times a packed matrix (inputs, outputs)."""
        q, scale, added = weight
        inputs, outputs = q.shape
        zero = int(np.rint(-float(added.ravel()[0]) / float(scale.ravel()[0]))) + 128
        blocks = outputs * inputs // BLOCK
        packed = (q.T.astype(np.int16) + 128).astype(np.uint8).reshape(outputs, inputs // BLOCK, BLOCK)
        scales = np.full(blocks, scale.ravel()[0], np.float32)
        zeros = np.full(blocks, zero, np.uint8)
        return self.op(
            "MatMulNBits", x, self.constant(packed), self.constant(scales), self.constant(zeros), output=output,
            domain="com.microsoft", K=inputs, N=outputs, bits=8, block_size=BLOCK, accuracy_level=4,
        )  # fmt: skip

    def session(self, inputs: dict[str, tuple[Any, int]], outputs: list[str], threads: int) -> Any:
        """Ready to run."""
        with tempfile.TemporaryDirectory(prefix="tidybot-") as folder:
            path = Path(folder) / "model.onnx"
            path.write_bytes(pb.model(self.nodes, self.tensors, inputs, outputs))
            return session(path, threads)


def session(path: Path, threads: int) -> Any:
    """An inference session of an ONNX or ORT file. Given the bytes themselves it would keep them for good."""
    import onnxruntime

    return onnxruntime.InferenceSession(str(path), _options(threads), providers=["CPUExecutionProvider"])


def _options(threads: int) -> Any:
    import onnxruntime

    made = onnxruntime.SessionOptions()
    made.intra_op_num_threads = threads
    made.inter_op_num_threads = 1
    made.log_severity_level = 3
    # Memory patterns and the arena would keep the space of the longest utterance for good.
    made.enable_mem_pattern = False
    made.enable_cpu_mem_arena = False
    return made


def return_memory() -> None:
    """Give what is not needed any more back to the system, where the C library can."""
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None) if sys.platform == "linux" else None
    if trim is not None:
        trim(0)


def unpacked(path: Path, threads: int) -> Any:
    """A session of an ORT file with its weights unpacked once instead of at each run.

    onnxruntime computes constants beforehand for ONNX files only, so the file is written out as one and read again.
    """
    with tempfile.TemporaryDirectory(prefix="tidybot-") as folder:
        found = session(_written(path, Path(folder)), threads)
    return_memory()
    return found


def _written(path: Path, folder: Path) -> Path:
    """An ORT file as an ONNX file, unchanged otherwise."""
    import onnxruntime

    copy, writing = folder / "model.onnx", _options(1)
    writing.graph_optimization_level = onnxruntime.GraphOptimizationLevel.ORT_DISABLE_ALL
    writing.optimized_model_filepath = str(copy)
    writing.add_session_config_entry("session.save_model_format", "ONNX")
    onnxruntime.InferenceSession(str(path), writing, providers=["CPUExecutionProvider"])
    return copy
