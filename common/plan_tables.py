"""Files of worlds and households: TOML tables with a floor plan in them or named, checked against a struct."""

import tomllib
from pathlib import Path
from typing import Any, TypeVar

import msgspec

from common.files.entry_errors import in_words
from common.floor_plan import FloorPlan, Strict
from common.free_sides import with_sides
from common.installation import ROOT, shipped
from common.plan_faults import measure_fault

SCENES, FLOOR_PLANS = ROOT / "services" / "sim" / "scenes", shipped("config") / "floor_plans"
MAP = "map.yaml"
"""Beside a household that the robot mapped."""
S = TypeVar("S", bound=Strict)


class SceneError(ValueError):
    """A world or household file that cannot be used; the message names file, entry and remedy."""


def read(path: Path) -> dict[str, Any]:
    """The TOML of a world or household file, with the floor plan that its `plan` names: one of ours, or a file.

    Raises:
        SceneError: no such file, or bad TOML.
    """
    tables = _tables(path, "scene", SCENES)
    named = tables.pop("plan", None)
    if named is None:
        return tables
    if not isinstance(named, str):
        raise SceneError(f"{path}: plan: expected the name of a floor plan or a file")
    if "/" in named or named.endswith(".toml"):
        file = path.parent / named
    else:
        file = FLOOR_PLANS / f"{named}.toml"
    try:
        plan = _tables(file, "floor plan", FLOOR_PLANS)
    except SceneError as error:
        raise SceneError(f"{path}: plan: {error}") from None
    return {k: v for k, v in plan.items() if k in FloorPlan.__struct_fields__} | tables


def _tables(path: Path, what: str, shipped: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except (FileNotFoundError, IsADirectoryError, NotADirectoryError):
        known = ", ".join(sorted(p.stem for p in shipped.glob("*.toml")))
        raise SceneError(f"no {what} file {path}; shipped {what}s: {known}") from None
    except OSError as error:
        raise SceneError(f"{path}: {error.strerror}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise SceneError(f"{path}: not valid TOML: {error}") from None
    except ValueError as error:
        raise SceneError(f"{path}: {error}") from None


def parse(raw: dict[str, Any], kind: type[S], path: Path) -> S:
    """The struct that a file's tables stand for.

    Raises:
        SceneError: an unknown key or a wrong type.
    """
    try:
        return msgspec.convert(raw, kind, strict=False)
    except msgspec.ValidationError as error:
        raise SceneError(f"{path}: {in_words(error, raw, kind)}") from None


P = TypeVar("P", bound=FloorPlan)


def checked(plan: P, path: Path) -> P:
    """The plan, with the sides that its surfaces are free on where the file leaves them out.

    What the robot mapped itself is taken as it was measured, furniture beyond the walls that it saw through a door too.

    Raises:
        SceneError: it is impossible.
    """
    is_measured = path.with_name(MAP).exists()
    if found := plan.fault() or ("" if is_measured else measure_fault(plan)):
        raise SceneError(f"{path}: {found}")
    return with_sides(plan)
