"""Networks whose 8-bit weights are multiplied without being unpacked.

The networks as they ship unpack each weight at each run, which costs six times the CPU time.
"""

import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import onnx
from numpy.typing import NDArray
from onnx import TensorProto, helper, numpy_helper

from common.inference import options

BLOCK = 32
"""Weights per scale of `MatMulNBits`; the operator takes 16, 32, 64 and so on."""
OPSETS = {"": 17, "com.microsoft": 1}
"""Opset 17 is the first with LayerNormalization; MatMulNBits is onnxruntime's own."""
IR_VERSION = 8
"""Of the ONNX file format: the one that belongs to opset 17."""
Array = NDArray[Any]
Weight = tuple[Array, Array, Array]
"""A matrix (inputs, outputs) as int8, its scale and what is added: w = q * scale + added."""


class PackedWeights:
    """The 8-bit weights of a shipped network, by the name of what they multiply."""

    def __init__(self, path: Path) -> None:
        with tempfile.TemporaryDirectory(prefix="tidybot-") as folder:
            self.graph = onnx.load(str(_as_onnx(path, Path(folder)))).graph
        self.arrays: dict[str, Array] = {t.name: numpy_helper.to_array(t) for t in self.graph.initializer}

    def weight(self, name: str) -> Weight:
        """A matrix by the name of its unpacked form."""
        stem = name.removesuffix("_add_tensor")
        return self.arrays[f"{stem}_quantized"], self.arrays[f"{stem}_scale"], self.arrays[f"{stem}_zero_point"]

    def is_weight(self, name: str) -> bool:
        """True for the unpacked form of a matrix that can be multiplied packed."""
        packed = self.arrays.get(name.removesuffix("_add_tensor") + "_quantized")
        return name.endswith("_add_tensor") and packed is not None and packed.ndim == 2 and not packed.shape[0] % BLOCK

    def by_layer(self) -> dict[str, str]:
        """Names of weights by the path of the layer that multiplies by them."""
        nodes = (node for branch in self._branches() for node in branch.node if node.op_type == "MatMul")
        return {
            node.output[0].removesuffix("/MatMul_output_0"): node.input[1]
            for node in nodes
            if self.is_weight(node.input[1])
        }

    def _branches(self) -> Iterator[onnx.GraphProto]:
        """With and without a cache: the two sides of the network's choice."""
        for node in self.graph.node:
            if node.op_type == "If":
                yield from (attribute.g for attribute in node.attribute)


class NetworkBuilder:
    """A network under construction: operations return the names of what they compute."""

    def __init__(self) -> None:
        self._nodes: list[onnx.NodeProto] = []
        self._tensors: list[onnx.TensorProto] = []
        self._count = 0

    def constant(self, values: Array) -> str:
        """Name of a new constant tensor."""
        self._count += 1
        self._tensors.append(numpy_helper.from_array(np.ascontiguousarray(values), f"c{self._count}"))
        return f"c{self._count}"

    def shape(self, *sizes: int) -> str:
        """Name of a new constant vector of integers."""
        return self.constant(np.array(sizes, np.int64))

    def op(self, kind: str, *inputs: str, output: str = "", domain: str = "", **attributes: Any) -> str:
        """Append an operation with one result; name of the result."""
        self._count += 1
        output = output or f"t{self._count}"
        self._nodes.append(helper.make_node(kind, inputs, [output], domain=domain, **attributes))
        return output

    def split(self, x: str, parts: int, axis: int = 0) -> list[str]:
        """Names of equal parts along an axis; along the first one it disappears."""
        self._count += 1
        names = [f"s{self._count}_{k}" for k in range(parts)]
        self._nodes.append(helper.make_node("Split", [x], names, axis=axis))
        return names if axis else [self.op("Squeeze", name, self.shape(0)) for name in names]

    def times(self, x: str, weight: Weight, output: str = "") -> str:
        """Name of x (..., inputs) times a packed matrix (inputs, outputs)."""
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

    def copy(self, node: onnx.NodeProto, weights: PackedWeights) -> None:
        """Append a node of a shipped network; a matrix that it multiplies by stays packed."""
        if node.op_type == "MatMul" and weights.is_weight(node.input[1]):
            self.times(node.input[0], weights.weight(node.input[1]), output=node.output[0])
        else:
            self._nodes.append(node)

    def model(self, inputs: dict[str, tuple[Any, int]], outputs: list[str]) -> onnx.ModelProto:
        """The network as a model; inputs with type and number of dimensions, outputs are floats."""
        takes = [
            helper.make_tensor_value_info(
                name, helper.np_dtype_to_tensor_dtype(np.dtype(kind)), [f"{name}{k}" for k in range(rank)]
            )
            for name, (kind, rank) in inputs.items()
        ]
        gives = [helper.make_tensor_value_info(name, TensorProto.FLOAT, None) for name in outputs]
        return self._model(takes, gives)

    def like(self, graph: onnx.GraphProto) -> onnx.ModelProto:
        """The network as a model with inputs, outputs and weights of a shipped one, without what nothing needs."""
        used, needed = {output.name for output in graph.output}, []
        for node in reversed(self._nodes):
            if used.intersection(node.output):
                needed.append(node)
                used.update(node.input)
        self._nodes = needed[::-1]
        self._tensors += [tensor for tensor in graph.initializer if tensor.name in used]
        return self._model(graph.input, graph.output)

    def _model(self, takes: Sequence[onnx.ValueInfoProto], gives: Sequence[onnx.ValueInfoProto]) -> onnx.ModelProto:
        graph = helper.make_graph(self._nodes, "network", takes, gives, self._tensors)
        opsets = [helper.make_opsetid(domain, version) for domain, version in OPSETS.items()]
        return helper.make_model(graph, opset_imports=opsets, ir_version=IR_VERSION)


def write(path: Path, target: Path) -> None:
    """Write the network of an ORT file with matrices that stay packed; its other weights are unpacked at the start."""
    weights, net = PackedWeights(path), NetworkBuilder()
    for node in weights.graph.node:
        net.copy(node, weights)
    onnx.save_model(net.like(weights.graph), target)


def _as_onnx(path: Path, folder: Path) -> Path:
    """An ORT file as an ONNX file, unchanged otherwise."""
    import onnxruntime

    copy, writing = folder / "model.onnx", options()
    writing.graph_optimization_level = onnxruntime.GraphOptimizationLevel.ORT_DISABLE_ALL
    writing.optimized_model_filepath = str(copy)
    writing.add_session_config_entry("session.save_model_format", "ONNX")
    onnxruntime.InferenceSession(str(path), writing, providers=["CPUExecutionProvider"])
    return copy
