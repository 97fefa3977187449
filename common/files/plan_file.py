"""A world or household as TOML, whole in one file: for processes that get theirs from one, and for recordings."""

import json
from typing import Any

import msgspec

from common.floor_plan import FloorPlan


def to_toml(plan: FloorPlan) -> str:
    """The file's text; fields at their defaults are left out."""
    fields: dict[str, Any] = msgspec.to_builtins(plan)
    lists = {k: v for k, v in fields.items() if isinstance(v, list) and v and isinstance(v[0], dict)}
    rows = [f"{k} = {_value(v)}" for k, v in fields.items() if k not in lists]
    rows += [f"{k} = [\n{''.join(f'  {_value(row)},{chr(10)}' for row in v)}]" for k, v in lists.items()]
    return "\n".join(rows) + "\n"


def _value(value: Any) -> str:
    if isinstance(value, dict):
        given = {k: v for k, v in value.items() if v is not None}
        return "{ " + ", ".join(f"{json.dumps(k)} = {_value(v)}" for k, v in given.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(_value, value)) + "]"
    return json.dumps(value)
