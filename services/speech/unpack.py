"""A quantised ORT model with its weights unpacked once instead of at each run: ten times the speed for the memory.

onnxruntime computes constants beforehand for ONNX files only, so the ORT file is written out as one and read again.
"""

import ctypes
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

# Field numbers of onnx.proto.
MODEL_GRAPH, GRAPH_NODE, GRAPH_NAME, NODE_TYPE, NODE_ATTRIBUTE, ATTRIBUTE_GRAPH = 7, 1, 2, 4, 5, 6


def session(path: Path, threads: int) -> Any:
    """An inference session of the model, or of its packed form where nothing can be written."""
    import onnxruntime

    def options() -> Any:
        made = onnxruntime.SessionOptions()
        made.intra_op_num_threads = threads
        made.inter_op_num_threads = 1
        made.log_severity_level = 3
        # Memory patterns would keep a second copy of the space for the intermediate results.
        made.enable_mem_pattern = False
        return made

    providers = ["CPUExecutionProvider"]
    try:
        with tempfile.TemporaryDirectory(prefix="tidybot-") as folder:
            copy = Path(folder) / "model.onnx"
            writing = options()
            writing.optimized_model_filepath = str(copy)
            writing.add_session_config_entry("session.save_model_format", "ONNX")
            onnxruntime.InferenceSession(str(path), writing, providers=providers)
            model = with_named_graphs(copy.read_bytes())
    except OSError:
        return onnxruntime.InferenceSession(str(path), options(), providers=providers)
    made = onnxruntime.InferenceSession(model, options(), providers=providers)
    del model
    _return_memory()
    return made


def _return_memory() -> None:
    """Give what unpacking needed in between, as much as the model, back to the system, where the C library can."""
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None) if sys.platform == "linux" else None
    if trim is not None:
        trim(0)


def with_named_graphs(model: bytes) -> bytes:
    """ONNX demands a name of every graph; those in the branches of an `If` come without."""
    return _edited(model, MODEL_GRAPH, lambda graph: _edited(graph, GRAPH_NODE, _named_branches))


def _named_branches(node: bytes) -> bytes:
    if not any(number == NODE_TYPE and value == b"If" for number, _, value in _fields(node)):
        return node
    return _edited(node, NODE_ATTRIBUTE, lambda attribute: _edited(attribute, ATTRIBUTE_GRAPH, _named))


def _named(graph: bytes) -> bytes:
    return graph + _field(GRAPH_NAME, b"branch")


def _edited(message: bytes, wanted: int, edit: Any) -> bytes:
    """The message with one kind of embedded message changed."""
    parts = []
    for number, raw, value in _fields(message):
        parts.append(_field(number, edit(value)) if number == wanted and value is not None else raw)
    return b"".join(parts)


def _fields(message: bytes) -> Iterator[tuple[int, bytes, bytes | None]]:
    """(number, its bytes, what it embeds) of each field of a protobuf message."""
    view, i = memoryview(message), 0
    while i < len(view):
        start = i
        key, i = _varint(view, i)
        value = None
        match key & 7:
            case 2:
                size, i = _varint(view, i)
                value = bytes(view[i : i + size])
                i += size
            case 0:
                _, i = _varint(view, i)
            case 1:
                i += 8
            case 5:
                i += 4
            case kind:
                raise ValueError(f"not a protobuf message: wire type {kind}")
        yield key >> 3, bytes(view[start:i]), value


def _varint(view: memoryview, i: int) -> tuple[int, int]:
    value = shift = 0
    while True:
        byte = view[i]
        i += 1
        value |= (byte & 127) << shift
        if byte < 128:
            return value, i
        shift += 7


def _field(number: int, value: bytes) -> bytes:
    return _number(number << 3 | 2) + _number(len(value)) + value


def _number(value: int) -> bytes:
    out = bytearray()
    while value > 127:
        out.append(value & 127 | 128)
        value >>= 7
    out.append(value)
    return bytes(out)
