"""The files of a map out of a floor plan, for homes that somebody has measured."""

from pathlib import Path

import msgspec
import numpy as np

from cli.errors import CliError
from common.config import config_dir
from common.files.map_file import (
    FREE,
    HOUSEHOLD,
    MAP,
    OCCUPIED,
    PICTURE,
    SURFACES,
    GridMap,
    MapError,
    named_picture,
    surface_rows,
    write_map,
)
from common.files.plan_file import to_toml
from common.floor_plan import FloorPlan
from common.household import Household, load_words, mapped
from common.scene import SceneError, load_scene

RESOLUTION = 0.05
"""Of the map's cells [m]: map_server's usual one."""


def plan_to_map(world: str, out: Path) -> Household:
    """Write map, surfaces and household of a world's or a household's floor plan to `out`; the household.

    Raises:
        CliError: a plan that cannot be used, or a directory that cannot be written to.
    """
    try:
        household = mapped(load_scene(world), load_words(config_dir()))
        out.mkdir(parents=True, exist_ok=True)
        grid = GridMap(drawn(household), RESOLUTION, household.low)
        write_map(out, grid, MAP)
        (out / SURFACES).write_bytes(msgspec.json.format(msgspec.json.encode(surface_rows(household)), indent=1))
        (out / HOUSEHOLD).write_text(to_toml(household), encoding="utf-8")
        named_picture(grid, household).save(out / PICTURE)
    except (SceneError, MapError) as error:
        raise CliError(str(error)) from None
    except OSError as error:
        raise CliError(f"{error.filename or out}: {error.strerror}") from None
    return household


def drawn(plan: FloorPlan) -> "np.ndarray[tuple[int, ...], np.dtype[np.uint8]]":
    """FREE or OCCUPIED for each cell (rows, columns) of the plan, row 0 in the south."""
    rows, columns = (round((plan.high[k] - plan.low[k]) / RESOLUTION) for k in (1, 0))
    xs = plan.low[0] + (np.arange(columns) + 0.5) * RESOLUTION
    ys = plan.low[1] + (np.arange(rows) + 0.5) * RESOLUTION
    gx, gy = np.meshgrid(xs, ys)
    taken = np.zeros((rows, columns), bool)
    for box in [wall.footprint for wall in plan.walls] + plan.footprints:
        taken |= box.signed_distances(gx, gy) <= 0.0
    return np.where(taken, OCCUPIED, FREE).astype(np.uint8)
