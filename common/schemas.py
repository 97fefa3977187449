"""JSON schemas of the messages in the dialect that Foxglove reads: no references, no unions, no nested arrays."""

from functools import cache
from typing import Any

import msgspec

from common import messages as m

DEPTH = 4
"""Levels of structs within structs that a schema shows [count]; chosen: structs that contain themselves end there."""
_PLAIN = {"boolean", "string", "number", "integer", "object"}


@cache
def schema_of(kind: type[m.Message]) -> bytes:
    """The schema of a message as JSON; fields that Foxglove cannot type are left out, they stay in the data."""
    (root,), components = msgspec.json.schema_components(
        [kind], ref_template="{name}", schema_hook=lambda unknown: {"type": "object"}
    )
    found = _flat(root, components, DEPTH) or {"type": "object", "properties": {}}
    return msgspec.json.encode({"title": kind.__name__, **found})


def _flat(schema: dict[str, Any], components: dict[str, Any], depth: int) -> dict[str, Any] | None:
    """One schema with its references put in place, None where the dialect has no word for it."""
    if "$ref" in schema:
        if depth == 0:
            return {"type": "object", "properties": {}}
        return _flat(components[schema["$ref"]], components, depth - 1)
    if "anyOf" in schema:  # a value or null, or words of two lists
        values = [_flat(s, components, depth) for s in schema["anyOf"] if s.get("type") != "null"]
        return values[0] if all(v == values[0] for v in values) else None
    kind = "string" if "enum" in schema else schema.get("type")
    if kind == "array":
        items = schema.get("items") or next(iter(schema.get("prefixItems", ())), None)
        item = _flat(items, components, depth) if items else None
        known = item is not None and item["type"] in _PLAIN and "contentEncoding" not in item
        return {"type": "array", "items": item} if known else None
    if kind not in _PLAIN:
        return None
    found: dict[str, Any] = {"type": kind}
    if "contentEncoding" in schema:
        found["contentEncoding"] = schema["contentEncoding"]
    if kind == "object":
        flat = {name: _flat(field, components, depth) for name, field in schema.get("properties", {}).items()}
        found["properties"] = {name: field for name, field in flat.items() if field is not None}
        if "description" in schema:
            found["description"] = schema["description"]
    return found
