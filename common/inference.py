"""Sessions of onnxruntime with one thread and without memory arenas, as the robot's processes need them."""

from pathlib import Path
from typing import Any


def session(path: Path) -> Any:
    """An inference session of an ONNX or ORT file. Given the bytes themselves it would keep them for good."""
    import onnxruntime

    return onnxruntime.InferenceSession(str(path), options(), providers=["CPUExecutionProvider"])


def options() -> Any:
    """Options of a session."""
    import onnxruntime

    made = onnxruntime.SessionOptions()
    made.intra_op_num_threads = 1
    made.inter_op_num_threads = 1
    made.log_severity_level = 3
    # Memory patterns and the arena would keep the space of the longest utterance for good.
    made.enable_mem_pattern = False
    made.enable_cpu_mem_arena = False
    return made
