"""Where a robot of MuJoCo Menagerie is on this machine, and what its names are in ours."""

import importlib
import os
import tomllib
from pathlib import Path
from typing import Any

import msgspec

from common.config import Config

PREFIX = "menagerie:"
MAPPINGS = Path(__file__).parent / "robots"
PACKAGE, ROOT = "mujoco_menagerie", "MENAGERIE_ROOT"
HOME_PAGE = "github.com/google-deepmind/mujoco_menagerie"


class RobotError(Exception):
    """The robot cannot be had; the text says what to do."""


class Mapping(Config, frozen=True):
    """Our names -> the model's. `model` is its file; `home` the keyframe whose arm is the carry pose."""

    model: str
    home: str
    bodies: dict[str, str]
    joints: dict[str, str]
    actuators: dict[str, str]
    sites: dict[str, str]
    pads: dict[str, list[str]]
    cameras: dict[str, str] = {}


def mapping(name: str) -> tuple[Mapping, Path]:
    """The names of a robot, and the file that holds them.

    Raises:
        RobotError: not one that we know.
    """
    path = MAPPINGS / f"{name}.toml"
    known = sorted(p.stem for p in MAPPINGS.glob("*.toml"))
    if name not in known:
        raise RobotError(
            f"robot {PREFIX}{name}: its names are not mapped; known: {', '.join(PREFIX + k for k in known)}. "
            f"Another one needs a file like services/sim/robots/{known[0]}.toml"
        )
    return msgspec.convert(tomllib.loads(path.read_text()), Mapping), path


def find(name: str, file: str) -> Path:
    """The model's file: below MENAGERIE_ROOT, or else from the `mujoco-menagerie` package, which downloads it once.

    Raises:
        RobotError: neither has it.
    """
    root = os.environ.get(ROOT, "")
    if root:
        return _below(Path(root).expanduser() / name, file)
    try:
        package: Any = importlib.import_module(PACKAGE)
    except ImportError:
        raise RobotError(
            f"robot {PREFIX}{name} is not on this machine. Either `.venv/bin/pip install mujoco-menagerie` "
            f"(it downloads the model at the first start), or set {ROOT} to a checkout of {HOME_PAGE}"
        ) from None
    try:
        return Path(package.get(name).xml(Path(file).stem))
    except (package.MenagerieError, OSError) as error:
        raise RobotError(
            f"robot {PREFIX}{name}: the mujoco-menagerie package could not get it ({error}). Without a network set "
            f"{ROOT} to a checkout of {HOME_PAGE}"
        ) from None


def _below(folder: Path, file: str) -> Path:
    """`file` of a folder, or the only model in it that is no scene."""
    if (folder / file).is_file():
        return folder / file
    models = [p for p in sorted(folder.glob("*.xml")) if not p.stem.startswith("scene")]
    if len(models) == 1:
        return models[0]
    found = ", ".join(p.name for p in models) or "no model"
    raise RobotError(
        f"{ROOT}: {folder} has no {file} ({found}). Set {ROOT} to the folder that holds {folder.name}/, for example a "
        f"checkout of {HOME_PAGE}"
    )
