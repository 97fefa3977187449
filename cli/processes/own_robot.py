"""A robot that a program starts for itself, beside any that runs here: the options of `tidybot up` for it."""

import argparse
import uuid
from collections.abc import Sequence

from cli.processes.ports import free_port
from common.security.keys import OFF


def own_robot(
    name: str,
    *,
    speed: str = "max",
    seed: int | None = None,
    without: str = "",
    settings: Sequence[str] = (),
    scene: str = "",
    **files: str,
) -> argparse.Namespace:
    """Options of a `Plan`: a free port, a namespace that begins with `name`, no keys and no window.

    `settings`: as `section.key=value`; `files`: paths of a `world` and a `household` in place of the `scene`.
    """
    return argparse.Namespace(
        port=free_port(), namespace=f"{name}-{uuid.uuid4().hex[:8]}", speed=speed, seed=seed, only="", without=without,
        set=list(settings), scene=scene, viewer=False, keys=OFF, **files,
    )  # fmt: skip
