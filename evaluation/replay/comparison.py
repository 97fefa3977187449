"""Recorded against replayed messages: the same, or where they first differ."""

import math
from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from typing import Any

import msgspec

from common import messages as m
from common.topic import Topic

EPOCHS = {"epoch", "world"}  # random for every start of a process
TIMES = {"t", "seen_at", "started"}
TOLERANCE = 1e-9
"""Within which numbers are the same, absolute and relative: what another order of additions makes of a double."""
Timed = tuple[float, m.Message]


class Comparison(msgspec.Struct):
    """One topic: how many were recorded, how many came out of the replay, and the first difference ("" for none)."""

    key: str
    recorded: int
    replayed: int
    difference: str = ""

    @property
    def same(self) -> bool:
        return not self.difference


def compare(topic: Topic[Any], recorded: Sequence[Timed], replayed: Sequence[Timed], slack: float) -> Comparison:
    """Judge one topic; `slack` is for times [s].

    Events must come in the same order. Of a stream, with slack, every replayed value must be found among the recorded
    ones of about that time, because a stream may skip values.
    """
    verdict = Comparison(topic.key, len(recorded), len(replayed))
    if topic.keep == "latest" and slack > 0:
        verdict.difference = _stray(recorded, replayed, slack)
    else:
        verdict.difference = _ordered(recorded, replayed, slack)
    return verdict


def _ordered(recorded: Sequence[Timed], replayed: Sequence[Timed], slack: float) -> str:
    for n, ((t, old), (u, new)) in enumerate(zip(recorded, replayed, strict=False), 1):
        if where := differs(old, new, slack):
            return f"message {n} at {t:.2f} s: {where}"
        if abs(t - u) > slack + 1e-6:
            return f"message {n} at {t:.2f} s: came at {u:.2f} s"
    if len(recorded) > len(replayed):
        t, old = recorded[len(replayed)]
        return f"message {len(replayed) + 1} at {t:.2f} s never came: {_short(old)}"
    if len(replayed) > len(recorded):
        u, new = replayed[len(recorded)]
        return f"message {len(recorded) + 1} at {u:.2f} s was not recorded: {_short(new)}"
    return ""


def _stray(recorded: Sequence[Timed], replayed: Sequence[Timed], slack: float) -> str:
    if bool(recorded) != bool(replayed):
        return f"{len(recorded)} recorded, {len(replayed)} replayed"
    times = [t for t, _ in recorded]
    for u, new in replayed:
        low, high = bisect_left(times, u - slack - 1e-6), bisect_right(times, u + slack + 1e-6)
        wrong = [differs(old, new, slack) for _, old in recorded[low:high]]
        if wrong and all(wrong):
            return f"at {u:.2f} s: {wrong[len(wrong) // 2]}"
    return ""


def differs(old: Any, new: Any, slack: float, name: str = "", tolerance: float = TOLERANCE) -> str:
    """`field[2].x 1.0 -> 1.1` for the first difference of two values, "" when there is none."""
    if isinstance(old, m.Message) and type(old) is type(new):
        for field in old.__struct_fields__:
            inner = f"{name}.{field}" if name else field
            if field in EPOCHS:
                continue
            limit = max(slack, TOLERANCE) if field in TIMES else TOLERANCE
            if found := differs(getattr(old, field), getattr(new, field), slack, inner, limit):
                return found
        return ""
    if isinstance(old, (list, tuple)) and isinstance(new, (list, tuple)):
        if len(old) != len(new):
            return f"{name} has {len(old)} -> {len(new)} items"
        pairs = enumerate(zip(old, new, strict=True))
        return next((f for i, (a, b) in pairs if (f := differs(a, b, slack, f"{name}[{i}]", tolerance))), "")
    if _number(old) and _number(new):
        same = old == new or math.isclose(old, new, rel_tol=tolerance, abs_tol=tolerance)
    else:
        same = old == new
    return "" if same else f"{name} {_short(old)} -> {_short(new)}"


def _number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _short(value: Any) -> str:
    if isinstance(value, m.Message):
        value = msgspec.to_builtins(value, builtin_types=(bytes,))
    text = f"<{len(value)} bytes>" if isinstance(value, bytes) else repr(value)
    return text if len(text) <= 120 else text[:117] + "..."
