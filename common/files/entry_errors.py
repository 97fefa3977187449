"""Error messages for entries of configuration files: the entry by its name, and the choices there are. Pure."""

import re
from typing import Any

import msgspec

_PATH = re.compile(r" - at `\$(?P<path>[^`]*)`$")
_STEP = re.compile(r"\.(\w+)|\[(\d+|\.\.\.)\]")


def in_words(error: msgspec.ValidationError, raw: Any, kind: Any) -> str:
    """msgspec's message about `raw`, which is no valid `kind`, with the entry's name and the choices there are."""
    text = str(error)
    match = _PATH.search(text)
    where: list[str] = []
    info: Any = msgspec.inspect.type_info(kind)
    for key, index in _STEP.findall(match["path"]) if match else ():
        if key:
            fields = {f.encode_name: f.type for f in getattr(info, "fields", ())}
            raw, info = (raw.get(key) if isinstance(raw, dict) else None), fields.get(key)
            where.append(key)
        else:
            raw, info = _item(raw, index), getattr(info, "item_type", None)
            name = raw.get("name") if isinstance(raw, dict) else None
            where[-1] += f" {name!r}" if name else f"[{index}]"
    what = text[: match.start()] if match else text
    choices: list[str] = []
    if "enum value" in what:
        choices = [str(value) for value in getattr(info, "values", ())]
    if "unknown field" in what:
        choices = [f.encode_name for f in getattr(info, "fields", ())]
    return ": ".join([*where, what]) + (f"; there are {', '.join(choices)}" if choices else "")


def _item(raw: Any, index: str) -> Any:
    return raw[int(index)] if isinstance(raw, (list, tuple)) and index.isdecimal() and int(index) < len(raw) else None
