"""Configuration: TOML files, environment and `--set`, checked against frozen structs before anything starts."""

import ast
import contextlib
import inspect
import itertools
import os
import re
import tomllib
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Literal, TypeVar

import msgspec

from common.installation import shipped, workspace

S = TypeVar("S", bound=msgspec.Struct)
PREFIX = "TIDYBOT__"
_SECRET = re.compile(r"key|token|secret|password")
"""Names of parameters whose values are for nobody's eyes."""
DEFAULT_DIR = shipped("config")


class ConfigError(ValueError):
    """A configuration that cannot be used; names source, key and expected type."""


class Config(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """Base of a service's parameters."""


class RuntimeConfig(Config, frozen=True):
    """Parameters that every process shares (section `runtime`)."""

    scene: str = "apartment"
    """World and household in one file, or the name of a shipped one: everything in it is told to the robot."""
    world: str = ""
    """What the simulation builds: a file, or the name of a shipped one; "" for `scene`."""
    household: str = ""
    """What the robot is told of it, likewise."""
    seed: int = 0
    """Seed of everything that is drawn by lot."""
    lockstep: bool = False
    """Robot time stands still until every participant has answered."""
    log_level: Literal["debug", "info", "warning", "error"] = "info"
    """The least that is logged."""

    @property
    def world_file(self) -> str:
        """Path or name of the world that the simulation builds."""
        return self.world or self.scene

    @property
    def household_file(self) -> str:
        """What the robot is told.

        Raises:
            ConfigError: a world of its own and no household: the robot would be told of another home.
        """
        if self.world and not self.household:
            raise ConfigError(
                f"runtime.world = {self.world} needs runtime.household, the file with what the robot is told; "
                "runtime.scene takes one file as both"
            )
        return self.household or self.scene


def described(kind: type[Config]) -> dict[str, tuple[Any, str]]:
    """key -> (default, what it is), in the order of the class; what it is stands below each field as a string."""
    body = ast.parse(inspect.getsource(kind)).body[0]
    assert isinstance(body, ast.ClassDef)
    said = {
        field.target.id: " ".join(below.value.value.split())
        for field, below in itertools.pairwise(body.body)
        if isinstance(field, ast.AnnAssign) and isinstance(field.target, ast.Name)
        if isinstance(below, ast.Expr) and isinstance(below.value, ast.Constant) and isinstance(below.value.value, str)
    }
    fields = msgspec.structs.fields(kind)
    return {
        f.name: (f.default_factory() if callable(f.default_factory) else f.default, said.get(f.name, ""))
        for f in fields
    }


def parse_value(text: str) -> Any:
    """`3`, `true`, `[1, 2]`, `{a = 1}` as TOML values; anything else is a string."""
    try:
        return tomllib.loads(f"v = {text}")["v"]
    except tomllib.TOMLDecodeError:
        return text


def overrides(environ: Mapping[str, str], settings: Iterable[str]) -> dict[str, dict[str, tuple[Any, str]]]:
    """section -> key -> (value, where it came from), from TIDYBOT__SECTION__KEY and `section.key=value`.

    Raises:
        ConfigError: a setting that is not of that form.
    """
    found: dict[str, dict[str, tuple[Any, str]]] = {}
    for name, text in environ.items():
        parts = name[len(PREFIX) :].lower().split("__") if name.startswith(PREFIX) else []
        if len(parts) == 2 and all(parts):
            found.setdefault(parts[0], {})[parts[1]] = parse_value(text), name
        elif parts:
            raise ConfigError(f"{name}: expected {PREFIX}<SECTION>__<KEY>")
    for setting in settings:
        left, equals, text = setting.partition("=")
        section, dot, key = left.strip().partition(".")
        if not (equals and dot and section and key):
            raise ConfigError(f"--set {setting}: expected section.key=value")
        found.setdefault(section, {})[key] = parse_value(text), f"--set {left.strip()}"
    return found


def config_dir(environ: Mapping[str, str] = os.environ) -> Path:
    """Where the TOML files are: TIDYBOT_CONFIG_DIR or the project's own `config/`.

    Raises:
        ConfigError: no such directory, so that every parameter would be the default.
    """
    given = environ.get("TIDYBOT_CONFIG_DIR")
    if given and not Path(given).is_dir():
        raise ConfigError(f"TIDYBOT_CONFIG_DIR={given}: no such directory")
    return Path(given) if given else DEFAULT_DIR


def state_dir(environ: Mapping[str, str], connect: str, namespace: str) -> Path:
    """Where processes keep what outlives them: TIDYBOT_STATE_DIR, or a folder for each robot and router."""
    if environ.get("TIDYBOT_STATE_DIR"):
        return Path(environ["TIDYBOT_STATE_DIR"])
    ours = workspace()
    base = ours / "run" if ours is not None else None
    if base is None or (base.exists() and not os.access(base, os.W_OK)):
        base = Path(environ.get("XDG_STATE_HOME") or Path.home() / ".local" / "state") / "tidybot"
    return base / "state" / re.sub(r"[^\w.-]+", "-", f"{namespace or 'robot'}-{connect}")


def load(section: str, kind: type[S], directory: Path, changes: Mapping[str, Mapping[str, tuple[Any, str]]]) -> S:
    """The parameters of one section: defaults, then `<section>.toml`, then environment, then `--set`.

    Raises:
        ConfigError: unknown key, wrong type or bad TOML.
    """
    path = directory / f"{section}.toml"
    values: dict[str, Any] = {}
    if path.exists():
        try:
            values = tomllib.loads(path.read_text(encoding="utf-8"))
        except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
            raise ConfigError(f"{path}: not valid TOML: {error}") from None
        except OSError as error:
            raise ConfigError(f"{path}: {error.strerror}") from None
        _convert(values, kind, str(path))
    for key, (value, source) in changes.get(section, {}).items():
        values[key] = value
        _convert(values, kind, source, key)
    return _convert(values, kind, section)


def settings() -> dict[str, Any]:
    """What files and environment set, as `section.key`, but for tables and secrets; a default stands in no file."""
    found: dict[str, Any] = {}
    for path in sorted(config_dir().glob("*.toml")):
        with contextlib.suppress(tomllib.TOMLDecodeError, UnicodeDecodeError, OSError):
            values = tomllib.loads(path.read_text(encoding="utf-8"))
            found |= {f"{path.stem}.{key}": value for key, value in values.items()}
    for section, changes in overrides(os.environ, ()).items():
        found |= {f"{section}.{key}": value for key, (value, _) in changes.items()}
    plain = {name: value for name, value in found.items() if isinstance(value, (bool, int, float, str))}
    return {name: value for name, value in plain.items() if not _SECRET.search(name)}


def _convert(values: dict[str, Any], kind: type[S], source: str, key: str = "") -> S:
    fields = {f.name: f for f in msgspec.structs.fields(kind)}
    for name in values:
        if name not in fields:
            raise ConfigError(f"{source}: unknown key {name!r}; known keys: {', '.join(sorted(fields))}")
    for name, value in values.items():
        if fields[name].type is str and isinstance(value, (int, float)) and key == name:
            values[name] = str(value)
    try:
        return msgspec.convert(values, kind)
    except msgspec.ValidationError as error:
        raise ConfigError(f"{source}: {error}") from None
