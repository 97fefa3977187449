"""Numbers that a robot can act on: a NaN, an infinity or 1e300 in a message is a fault of its sender."""

import types
import typing
from collections.abc import Callable
from functools import cache, partial
from math import hypot
from operator import attrgetter
from typing import Any

import msgspec

LIMIT = 1e15
"""Greatest magnitude of a number in a message [any unit]; chosen: its square and its nanoseconds are still finite."""
Check = Callable[[Any], bool]
Getter = Callable[[Any], tuple[float, ...]]


def bad_field(message: msgspec.Struct) -> str:
    """The first field that holds a number beyond the limit or no number at all; "" when there is none."""
    scalars, others = _checks(type(message))
    if scalars is not None and not hypot(*scalars(message)) <= LIMIT:
        names = (f.name for f in msgspec.structs.fields(message))
        return next(n for n in names if not _finite(getattr(message, n)))
    for name, fine in others:
        if not fine(getattr(message, name)):
            return name
    return ""


@cache
def _checks(
    kind: type[msgspec.Struct],
) -> tuple[Getter | None, tuple[tuple[str, Check], ...]]:
    """The plain floats of a struct together, and every other field that holds floats with its test."""
    hints = typing.get_type_hints(kind)
    scalars = [name for name in kind.__struct_fields__ if hints[name] is float]
    found = ((name, _check(hints[name])) for name in kind.__struct_fields__ if name not in scalars)
    # Named twice: attrgetter of one name returns no tuple.
    getter = attrgetter(*scalars, scalars[0]) if scalars else None
    return getter, tuple((name, check) for name, check in found if check is not None)


def _check(kind: Any) -> Check | None:
    origin, inner = typing.get_origin(kind), typing.get_args(kind)
    if kind is float:
        return _finite
    if origin in (list, tuple) and set(inner) <= {float, Ellipsis}:
        return _all_fine
    if origin in (list, tuple):
        each = _check(inner[0]) if len(set(inner)) == 1 else None
        return None if each is None else partial(_each_fine, each)
    if origin in (typing.Union, types.UnionType):
        checks = [c for c in map(_check, inner) if c is not None]
        return None if not checks else lambda value: value is None or all(c(value) for c in checks)
    if isinstance(kind, type) and issubclass(kind, msgspec.Struct):
        # Looked up when called: a struct may contain itself.
        return lambda value: not bad_field(value)
    return None


def _finite(value: Any) -> bool:
    return not isinstance(value, float) or -LIMIT <= value <= LIMIT


def _all_fine(values: Any) -> bool:
    return hypot(*values) <= LIMIT


def _each_fine(check: Check, values: Any) -> bool:
    return all(map(check, values))
