"""Worlds from outside: a directory of worlds, what the robot is told of each, and what is asked of it there.

The formats are in docs/WORLDS.md.
"""

from pathlib import Path
from typing import NamedTuple

from common.config import config_dir
from common.floor_plan import Strict
from common.household import Household, load_household, load_words, mapped
from common.kinds import kind_of
from common.plan_tables import parse, read
from common.scene import ObjectSpec, Scene, SceneError, load_scene
from evaluation.case import Case, Expect, Line
from evaluation.suites.blocks import WORDINGS, random
from judge.effects import Effect
from judge.evidence import Want

WORLD, HOUSEHOLD, CASES = "world.toml", "household.toml", "cases.toml"
NARROW = 0.080
"""Width [m] up to which an object is drawn to be fetched: the hand opens to 85 mm."""


class WorldsError(LookupError):
    """A directory of worlds that cannot be used; names the file and the remedy."""


class Found(NamedTuple):
    """One world and its files."""

    name: str
    world: Scene
    household: Household
    cases: Path | None


class Asked(Strict, frozen=True, kw_only=True):
    """A row of a case file: what is said, and what it has to bring about.

    `thing` is the world's name of what is wanted, `to` where it belongs (the delivery place if empty), `called` the
    person's words for it when asked which one. `wants` and `effects` are for more than one object and other effects.
    """

    command: str
    name: str = ""
    thing: str = ""
    called: str = ""
    to: str | tuple[str, ...] = ()
    wants: tuple[Want, ...] = ()
    effects: tuple[Effect, ...] = ()
    expect: Expect = "delivered"
    honest: bool = False
    seed: int | None = None
    limit: float = 600.0


class CaseFile(Strict, frozen=True, kw_only=True):
    """The contents of a file of cases."""

    case: tuple[Asked, ...]


def cases(directory: Path, count: int | None, seed: int) -> list[Case]:
    """The cases of every world in a directory; `count` None: all that are written down, one of each other world.

    Where fewer are written down they come again with other seeds.

    Raises:
        WorldsError: no world there, or a file that cannot be used.
    """
    rows: list[tuple[Found, Asked | None]] = []
    for found in worlds(directory):
        rows += [(found, asked) for asked in (_read(found) if found.cases else [None])]
    number = len(rows) if count is None else count
    return [_case(*rows[n % len(rows)], seed + n, again=n >= len(rows)) for n in range(number)]


def worlds(directory: Path) -> list[Found]:
    """The worlds of sub-directories with a `world.toml` and of `NAME.world.toml` in the directory itself, by name.

    Raises:
        WorldsError: there is none, or a file that cannot be used.
    """
    if not directory.is_dir():
        raise WorldsError(f"--world {directory}: no such directory")
    prefixes = [(p.parent.name, f"{p.parent}/") for p in directory.glob(f"*/{WORLD}")]
    prefixes += [(p.name.removesuffix(f".{WORLD}"), str(p).removesuffix(WORLD)) for p in directory.glob(f"*.{WORLD}")]
    if (directory / WORLD).is_file():
        prefixes.append((directory.resolve().name, f"{directory}/"))
    if not prefixes:
        raise WorldsError(f"--world {directory}: neither NAME/{WORLD} nor NAME.{WORLD} is in it; see docs/WORLDS.md")
    try:
        return [_load(name, prefix) for name, prefix in sorted(prefixes)]
    except SceneError as error:
        raise WorldsError(str(error)) from None


def _load(name: str, prefix: str) -> Found:
    world = load_scene(prefix + WORLD)
    told, listed = Path(prefix + HOUSEHOLD), Path(prefix + CASES)
    household = load_household(str(told)) if told.exists() else mapped(world, load_words(config_dir()))
    return Found(name, world, household, listed if listed.exists() else None)


def _read(found: Found) -> tuple[Asked, ...]:
    path = found.cases
    assert path is not None
    try:
        rows = parse(read(path), CaseFile, path).case
    except SceneError as error:
        raise WorldsError(str(error)) from None
    for row in rows:
        if wrong := _fault(row, found.world):
            raise WorldsError(f"{path}: {row.command!r}: {wrong}")
    return rows


def _fault(row: Asked, world: Scene) -> str:
    """What of a row the world cannot bring about, in words; "" for nothing."""
    wants = _wants(row, world)
    for want in wants:
        if "" in want.goals:
            return "nothing says where it belongs: give `to`, or the world a `delivery`"
        if world.object(want.thing) is None:
            return f"the world has no object {want.thing!r}; it has {', '.join(o.name for o in world.objects)}"
        if unknown := next((g for g in want.goals if world.receptacle(g) is None), ""):
            return f"the world has no receptacle {unknown!r}; it has {', '.join(r.name for r in world.receptacles)}"
    if row.expect == "delivered" and not wants:
        return 'nothing is wanted: give `thing`, `wants`, or `effects` with `expect = "shown"`'
    return "`effects` are missing" if row.expect == "shown" and not row.effects else ""


def _wants(row: Asked, world: Scene) -> tuple[Want, ...]:
    to = (row.to,) if row.to and isinstance(row.to, str) else tuple(row.to) or (world.delivery,)
    return row.wants or ((Want(row.thing, to),) if row.thing and row.expect == "delivered" else ())


def _case(found: Found, row: Asked | None, seed: int, again: bool) -> Case:
    if row is None:
        row = _drawn(found, seed)
    elif row.seed is not None and not again:
        seed = row.seed
    return Case(
        suite="world", seed=seed, name=row.name or found.name, command=row.command, lines=(Line(row.command),),
        thing=row.thing, called=row.called, wants=_wants(row, found.world), effects=row.effects, expect=row.expect,
        honest=row.honest, scene=found.world, household=found.household, limit=row.limit,
    )  # fmt: skip


def _drawn(found: Found, seed: int) -> Asked:
    """A case of fetching an object that the household has words for, and nothing else in the world answers to."""
    rng = random(seed, 31)
    sayable = [(o, words) for o in found.world.objects if (words := said(o, found.world, found.household))]
    fitting = [(o, w) for o, w in sayable if kind_of(o.kind).by_the_rim or min(o.size) <= NARROW]
    if not fitting:
        raise WorldsError(
            f"{found.name}: the household has no words that mean one object of the world alone; "
            f"write a {CASES} with the commands"
        )
    spec, words = fitting[int(rng.integers(len(fitting)))]
    command = WORDINGS[int(rng.integers(len(WORDINGS)))].format(words)
    return Asked(command=command, thing=spec.name, called=words)


def said(spec: ObjectSpec, world: Scene, household: Household) -> str:
    """What a person of the household calls an object: by its name if it is a known thing, else by colour and kind."""
    if household.thing(spec.name) is not None:
        return spec.name
    alike = [o for o in world.objects if (o.kind, o.colour) == (spec.kind, spec.colour)]
    words = household.words
    known = words.kind(spec.kind) and words.colour(spec.colour)
    return f"{spec.colour} {spec.kind}" if known and len(alike) == 1 else ""
