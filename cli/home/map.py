"""`tidybot map`: the robot explores a home that nobody has described to it and writes the household it lives with."""

import argparse
import math
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.live import Live
from rich.text import Text

from cli.errors import CliError, port_number
from cli.link import Link, Subscription
from cli.processes.plan import Plan, add_start_options
from cli.processes.ports import free_port, port_is_free
from cli.processes.supervision import Supervision, run_dir
from cli.processes.up import Stopped, bring_up, check_free, interruptible
from common import messages as m
from common import topics
from common.bus.session import open_session
from common.cells import unpacked
from common.config import config_dir
from common.files.map_file import (
    FREE,
    HOUSEHOLD,
    OCCUPIED,
    PICTURE,
    UNKNOWN,
    GridMap,
    MapError,
    picture,
    write_home,
)
from common.floor_plan import FloorPlan
from common.household import Household, load_household, load_words, mapped
from common.household_edits import edited
from common.scene import SceneError, load_scene
from common.time.clock import monotonic

RESOLUTION = 0.05
"""Of the map's cells [m]: map_server's usual one."""
NAMES = ("router", "sim", "camera", "navigation", "mapping", "dashboard")
EXAMPLES = """examples:
  tidybot map --out home                         map the shipped flat
  tidybot map --world mine.world.toml --out home
  tidybot map --resume home --out home           go on with it, or add what was shut before
  tidybot up --world mine.world.toml --household home/household.toml
  tidybot map --from mine.world.toml --out home  the same files from a plan, without driving

Ctrl-C saves what there is. docs/MAPPING.md says what the files hold."""
WIDTH = 72
"""Columns of the map in the terminal."""
PICTURE_EVERY = 5.0
"""Wall time [s] between two pictures of the growing map."""
LINE_EVERY = 15.0
"""Wall time [s] between two lines of progress where there is no terminal to draw in."""
SAVE_LIMIT = 60.0
"""Wall time [s] that the last files may take after Ctrl-C."""


def run(args: argparse.Namespace) -> int:
    """Explore a home, or take over a plan of it; the exit status."""
    out = args.out.resolve()
    if args.from_plan is not None:
        household = plan_to_map(args.from_plan, out)
        print(f"{out}: {len(household.receptacles)} surfaces of {household.name}")
        print("\n".join([*contents(household), _next(args, out)]))
        return 0
    args.port = args.port or (7447 if port_is_free(7447) else free_port())
    args.only, args.without, args.namespace, args.household = ",".join(NAMES), args.without, None, "unmapped"
    args.set = [
        "navigation.map=mapping", f"mapping.out={out}", f"mapping.name={out.name}", *_resumed(args.resume), *args.set
    ]  # fmt: skip
    plan, supervision = Plan(args), Supervision(run_dir() / f"map-{args.port}")
    check_free(supervision, plan)
    out.mkdir(parents=True, exist_ok=True)
    say = Console(highlight=False).print
    try:
        with interruptible():
            say(f"ready in {bring_up(supervision, plan, say):.1f} s; Ctrl-C saves what there is")
            with open_session(plan.connect, plan.namespace) as session:
                status = follow(Link(session, plan.connect), supervision, out, args.timeout)
    except Stopped:
        say("stopped before there was a map")
        return 130
    finally:
        supervision.stop()
    if status.phase == "failed" or not status.saves:
        raise CliError(f"no map: {status.detail or status.phase}")
    say(f"{out}: {status.area:.1f} m2, {status.surfaces} surfaces, {status.frontiers} places left to look at")
    say("\n".join(contents(load_household(str(out / HOUSEHOLD)))))
    say(_next(args, out))
    return 0 if status.phase == "done" else 130


def contents(household: Household) -> list[str]:
    """The surfaces of each room by the robot's names for them, as `room 1: table, bin 2`."""
    named = edited(household, m.HouseholdEdits())
    rooms = {
        room.name: [r.name for r in named.receptacles if named.room_at(*r.center[:2]) == room] for room in named.rooms
    }
    lost = [r.name for r in named.receptacles if named.room_at(*r.center[:2]) is None]
    rows = [*rooms.items(), *([("elsewhere", lost)] if lost else [])]
    return [f"  {name}: {', '.join(surfaces) or 'nothing to put things on'}" for name, surfaces in rows]


def _next(args: argparse.Namespace, out: Path) -> str:
    world = args.from_plan or args.world or args.scene
    return f"tidybot up {f'--world {world} ' if world else '--world apartment '}--household {out / HOUSEHOLD}"


def _resumed(directory: Path | None) -> list[str]:
    """Raises `CliError` where there is nothing to go on with."""
    if directory is None:
        return []
    if not (directory / "pose_graph.json").exists():
        raise CliError(f"--resume {directory}: no pose_graph.json there; it is written by `tidybot map --out DIR`")
    return [f"mapping.resume={directory.resolve()}"]


def follow(link: Link, supervision: Supervision, out: Path, timeout: float) -> m.MappingStatus:
    """Show the growing map until it is done, or save it on Ctrl-C; returns the last mapping status.

    Raises:
        CliError: a process ended, or nothing was saved.
    """
    statuses, grids = Subscription(link, topics.MAPPING_STATUS), Subscription(link, topics.MAP_GRID)
    status = m.MappingStatus(t=0.0, phase="idle")
    began, drawn = monotonic(), -math.inf
    console = Console(highlight=False)
    told = began
    with Live(console=console, refresh_per_second=4, transient=True) as live:
        try:
            while status.phase not in ("done", "failed"):
                status = statuses.next(0.5) or status
                if why := supervision.died():
                    raise CliError(f"the supervisor is gone: {why}")
                if monotonic() - began > timeout:
                    raise Stopped
                grid = grids.next(0.0) or grids.last
                shown = unpacked(grid) if grid is not None else None
                drawing = terminal(shown) if shown is not None and console.is_terminal else []
                if console.is_terminal:
                    live.update(Text("\n".join([*drawing, line(status)])))
                elif monotonic() - told > LINE_EVERY:
                    told = monotonic()
                    console.print(line(status))
                exploring = status.phase not in ("saving", "done", "failed")
                if shown is not None and exploring and monotonic() - drawn > PICTURE_EVERY:
                    drawn = monotonic()
                    out.mkdir(parents=True, exist_ok=True)
                    picture(shown).save(out / PICTURE)
        except Stopped:
            status = _save_now(link, statuses, status)
    return status


def _save_now(link: Link, statuses: Subscription[m.MappingStatus], status: m.MappingStatus) -> m.MappingStatus:
    """Have the map saved as it is."""
    link.send(topics.MAPPING_GOAL, m.MappingGoal(goal="save", id="ctrl-c"))
    saved = statuses.until(lambda now: now.saves > status.saves, SAVE_LIMIT)
    if saved is None:
        raise CliError(f"not saved after {SAVE_LIMIT:.0f} s; see the log of mapping")
    return saved


def line(status: m.MappingStatus) -> str:
    """`exploring  34.2 m2 of floor, 5 places left to look at, 02:13`."""
    minutes, seconds = divmod(int(status.t), 60)
    words = f"{status.phase:10} {status.area:6.1f} m2 of floor, {status.frontiers} places left to look at"
    return f"{words}, {status.keyframes} keyframes, {status.loops} loops, {minutes:02}:{seconds:02}"


def terminal(cells: "np.ndarray[tuple[int, ...], np.dtype[np.uint8]]") -> list[str]:
    """The map as lines of characters, two cells high for each one wide, north up."""
    step = max(1, -(-cells.shape[1] // WIDTH))
    rows, columns = cells.shape[0] // (2 * step), cells.shape[1] // step
    if not rows or not columns:
        return []
    blocks = cells[: rows * 2 * step, : columns * step].reshape(rows, 2 * step, columns, step)
    taken, unknown = (blocks == OCCUPIED).any(axis=(1, 3)), (blocks == UNKNOWN).all(axis=(1, 3))
    signs = np.where(taken, "#", np.where(unknown, " ", "."))
    return ["".join(row) for row in signs[::-1]]


def register(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = commands.add_parser(
        "map", help="explore a home nobody has described, and write its map and household", epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )  # fmt: skip
    parser.add_argument("--out", type=Path, default=Path("map"), metavar="DIR", help="where to (default: %(default)s)")
    parser.add_argument("--resume", type=Path, metavar="DIR", help="go on with the map of this directory")
    parser.add_argument("--from", dest="from_plan", metavar="FILE", help="make the files from a plan instead")
    add_start_options(parser)
    parser.add_argument("--without", default="", metavar="A,B", help="leave these services out, such as dashboard")
    parser.add_argument("--port", type=port_number, default=0, help="default: 7447, or a free one if in use")
    parser.add_argument("--timeout", type=float, default=7200.0, metavar="S", help="wall time (default %(default)s)")
    parser.set_defaults(run=run)


# --- the files of a map out of a floor plan, for homes that somebody has measured
def plan_to_map(world: str, out: Path) -> Household:
    """Write map, surfaces and household of a world's or a household's floor plan to `out`; the household.

    Raises:
        CliError: a plan that cannot be used, or a directory that cannot be written to.
    """
    try:
        household = mapped(load_scene(world), load_words(config_dir()))
        out.mkdir(parents=True, exist_ok=True)
        grid = GridMap(drawn(household), RESOLUTION, household.low)
        write_home(out, grid, household)
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
