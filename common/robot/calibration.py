"""The file in which the cameras' true mounts are kept: written by `tidybot calibrate`, read by the camera service."""

import math
import tomllib
from pathlib import Path

from common.topics import PICTURES

Vector = tuple[float, float, float]
Mounts = dict[str, tuple[Vector, Vector]]
"""Offset [m] and turn [deg, a rotation vector] of each camera from its drawing, in its optical frame."""
LARGEST_OFFSET, LARGEST_TURN = 0.05, 10.0
"""What a mount may be off its drawing [m, deg] before the file is taken for nonsense; chosen: ten bad brackets."""


class CalibrationError(ValueError):
    """The file cannot be used; says why."""


def read(path: Path) -> Mounts:
    """The mounts that a file tells.

    Raises:
        CalibrationError: no such file, no TOML, or numbers that no mount has.
    """
    try:
        tables = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise CalibrationError(f"{path}: {error.strerror}; `tidybot calibrate --out {path}` makes one") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise CalibrationError(f"{path}: {error}") from None
    if strange := sorted(set(tables) - set(PICTURES)):
        raise CalibrationError(f"{path}: no camera is called {strange[0]!r}; there are {' and '.join(PICTURES)}")
    return {
        name: (_vector(path, name, table, "offset", LARGEST_OFFSET), _vector(path, name, table, "turn", LARGEST_TURN))
        for name, table in tables.items()
    }


def _vector(path: Path, camera: str, table: object, key: str, largest: float) -> Vector:
    values = table.get(key) if isinstance(table, dict) else None
    good = (
        isinstance(values, list)
        and len(values) == 3
        and all(isinstance(v, int | float) and math.isfinite(v) and abs(v) <= largest for v in values)
    )
    if not good:
        raise CalibrationError(f"{path}: {camera}.{key} must be three numbers from {-largest:g} to {largest:g}")
    assert isinstance(values, list)
    return float(values[0]), float(values[1]), float(values[2])


def text(mounts: Mounts, remarks: dict[str, str]) -> str:
    """The file's content; `remarks` say how sure each camera's numbers are."""
    lines = ["# Where the cameras sit, seen from their drawing, in their optical frames (x right, y down, z forward)."]
    for name, (offset, turn) in mounts.items():
        lines += ["", f"# {remarks[name]}", f"[{name}]"]
        lines.append(f"offset = [{', '.join(f'{v:.6f}' for v in offset)}]  # [m]")
        lines.append(f"turn = [{', '.join(f'{v:.5f}' for v in turn)}]  # rotation vector [deg]")
    return "\n".join(lines) + "\n"
