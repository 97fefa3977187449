"""Location of MuJoCo Menagerie's model of the robot on this machine."""

import importlib
import os
from pathlib import Path
from typing import Any

NAME = "stanford_tidybot"
PACKAGE, ROOT = "mujoco_menagerie", "MENAGERIE_ROOT"
HOME_PAGE = "github.com/google-deepmind/mujoco_menagerie"


class RobotError(Exception):
    """The model is not available; the message says what to do."""


def find() -> Path:
    """The model's file: below MENAGERIE_ROOT, or else from the `mujoco-menagerie` package, which downloads it once.

    Raises:
        RobotError: neither has it.
    """
    root = os.environ.get(ROOT, "")
    if root:
        return _below(Path(root).expanduser() / NAME)
    try:
        package: Any = importlib.import_module(PACKAGE)
    except ImportError:
        raise RobotError(
            f"the official model {NAME} is not on this machine. Either `.venv/bin/pip install mujoco-menagerie` "
            f"(it downloads the model at the first start), or set {ROOT} to a checkout of {HOME_PAGE}"
        ) from None
    try:
        return Path(package.get(NAME).xml("tidybot"))
    except (package.MenagerieError, OSError) as error:
        raise RobotError(
            f"the mujoco-menagerie package could not get {NAME} ({error}). Without a network set {ROOT} to a checkout "
            f"of {HOME_PAGE}"
        ) from None


def _below(folder: Path) -> Path:
    """`tidybot.xml` of a folder, or the only model in it that is no scene."""
    if (folder / "tidybot.xml").is_file():
        return folder / "tidybot.xml"
    models = [p for p in sorted(folder.glob("*.xml")) if not p.stem.startswith("scene")]
    if len(models) == 1:
        return models[0]
    found = ", ".join(p.name for p in models) or "no model"
    raise RobotError(
        f"{ROOT}: {folder} has no tidybot.xml ({found}). Set {ROOT} to the folder that holds {folder.name}/, for "
        f"example a checkout of {HOME_PAGE}"
    )
