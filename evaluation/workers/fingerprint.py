"""Fingerprint of all that decides a seed's outcome, to compare the machines of a cluster."""

import hashlib
import platform
from functools import cache
from importlib.metadata import PackageNotFoundError, version

from common.config import config_dir
from common.installation import ROOT

SOURCES = ("common", "services", "cli", "judge", "evaluation")
DECIDES = (
    "mujoco", "mink", "daqp", "numpy", "scipy", "onnxruntime", "moonshine-cpp", "hibari-tts", "py_trees", "msgspec",
)  # fmt: skip
"""Packages whose release can change what a seed does."""


@cache
def fingerprint() -> dict[str, str]:
    """What decides a seed's outcome: Python, packages, and a hash of the project's sources and configuration."""
    digest = hashlib.sha256()
    files = {p.relative_to(ROOT).as_posix(): p for top in SOURCES for p in (ROOT / top).rglob("*.*")}
    files |= {f"config/{p.relative_to(config_dir())}": p for p in config_dir().rglob("*.toml")}
    for name, path in sorted(files.items()):
        if path.suffix in (".py", ".toml"):
            digest.update(name.encode() + b"\0" + path.read_bytes() + b"\0")
    return {
        "Python": ".".join(platform.python_version_tuple()[:2]),
        "tidybot": digest.hexdigest()[:16],
        **{name: _version(name) for name in DECIDES},
    }


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "missing"


def difference(ours: dict[str, str], theirs: dict[str, str]) -> str:
    """The differences of two fingerprints, as a sentence."""
    rows = [f"{name} {theirs.get(name)}, here {own}" for name, own in ours.items() if theirs.get(name) != own]
    return "runs other code: " + "; ".join(rows)
