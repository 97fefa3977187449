"""The few parts of protobuf and of ONNX's format that reading and writing a network takes, without the onnx package."""

import struct
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

# Field numbers of onnx.proto.
MODEL_GRAPH, GRAPH_NODE, GRAPH_INITIALISER, NODE_INPUT, NODE_OUTPUT, NODE_TYPE, NODE_ATTRIBUTE = 7, 1, 5, 1, 2, 4, 5
ATTRIBUTE_GRAPH, TENSOR_DIMS, TENSOR_TYPE, TENSOR_NAME, TENSOR_RAW = 6, 1, 2, 8, 9
TYPES: dict[int, Any] = {1: np.float32, 2: np.uint8, 3: np.int8, 7: np.int64}
NUMBERS = {np.dtype(kind): number for number, kind in TYPES.items()}


def fields(message: bytes | memoryview) -> Iterator[tuple[int, memoryview, Any]]:
    """(number, its bytes, value) of each field: a memoryview of what it embeds, or an integer."""
    view, i = memoryview(message), 0
    while i < len(view):
        start = i
        key, i = _varint(view, i)
        value: Any = None
        match key & 7:
            case 2:
                size, i = _varint(view, i)
                value = view[i : i + size]
                i += size
            case 0:
                value, i = _varint(view, i)
            case 1:
                i += 8
            case 5:
                i += 4
            case kind:
                raise ValueError(f"not a protobuf message: wire type {kind}")
        yield key >> 3, view[start:i], value


def every(message: bytes | memoryview, wanted: int) -> list[Any]:
    """The values of all fields of that number."""
    return [value for number, _, value in fields(message) if number == wanted]


def texts(message: bytes | memoryview, wanted: int) -> list[str]:
    """The same as strings."""
    return [bytes(value).decode() for value in every(message, wanted)]


def field(number: int, value: bytes | str | int) -> bytes:
    """One field, as it is written."""
    if isinstance(value, int):
        return _number(number << 3) + _number(value)
    raw = value.encode() if isinstance(value, str) else value
    return _number(number << 3 | 2) + _number(len(raw)) + raw


def array(tensor: bytes | memoryview) -> tuple[str, NDArray[Any]]:
    """Name and contents of a tensor."""
    dims: list[int] = []
    name, kind, raw = "", 1, memoryview(b"")
    for number, _, value in fields(tensor):
        if number == TENSOR_DIMS and isinstance(value, int):
            dims.append(value)
        elif number == TENSOR_DIMS:
            dims += _packed(value)
        elif number == TENSOR_TYPE:
            kind = value
        elif number == TENSOR_NAME:
            name = bytes(value).decode()
        elif number == TENSOR_RAW:
            raw = value
    return name, np.frombuffer(raw, TYPES[kind]).reshape(dims)


def tensor(name: str, values: NDArray[Any]) -> bytes:
    """A tensor, as it is written."""
    dims = b"".join(field(TENSOR_DIMS, size) for size in values.shape)
    number = NUMBERS[values.dtype]
    return dims + field(TENSOR_TYPE, number) + field(TENSOR_NAME, name) + field(TENSOR_RAW, values.tobytes())


def node(kind: str, inputs: Sequence[str], outputs: Sequence[str], domain: str = "", **attributes: Any) -> bytes:
    """One operation; attributes are integers, numbers, or lists of integers."""
    parts = [field(NODE_INPUT, name) for name in inputs] + [field(NODE_OUTPUT, name) for name in outputs]
    parts += [field(NODE_TYPE, kind)]
    for name, value in attributes.items():
        if isinstance(value, int):
            written = field(3, value & (1 << 64) - 1) + field(20, 2)
        elif isinstance(value, float):
            written = _number(2 << 3 | 5) + struct.pack("<f", value) + field(20, 1)
        else:
            written = b"".join(field(8, v & (1 << 64) - 1) for v in value) + field(20, 7)
        parts.append(field(NODE_ATTRIBUTE, field(1, name) + written))
    return b"".join([*parts, field(7, domain)] if domain else parts)


def model(nodes: list[bytes], tensors: list[bytes], inputs: dict[str, tuple[Any, int]], outputs: list[str]) -> bytes:
    """A network; inputs with type and number of dimensions."""
    parts = [field(1, n) for n in nodes] + [field(2, "network")] + [field(5, t) for t in tensors]
    for name, (kind, rank) in inputs.items():
        shape = b"".join(field(1, field(2, f"{name}{k}")) for k in range(rank))
        parts.append(
            field(11, field(1, name) + field(2, field(1, field(1, NUMBERS[np.dtype(kind)]) + field(2, shape))))
        )
    for name in outputs:
        parts.append(field(12, field(1, name) + field(2, field(1, field(1, 1)))))
    opsets = field(8, field(2, 17)) + field(8, field(1, "com.microsoft") + field(2, 1))
    return field(1, 8) + opsets + field(7, b"".join(parts))


def _packed(view: memoryview) -> list[int]:
    found, i = [], 0
    while i < len(view):
        value, i = _varint(view, i)
        found.append(value)
    return found


def _varint(view: memoryview, i: int) -> tuple[int, int]:
    value = shift = 0
    while True:
        byte = view[i]
        i += 1
        value |= (byte & 127) << shift
        if byte < 128:
            return value, i
        shift += 7


def _number(value: int) -> bytes:
    out = bytearray()
    while value > 127:
        out.append(value & 127 | 128)
        value >>= 7
    out.append(value)
    return bytes(out)
