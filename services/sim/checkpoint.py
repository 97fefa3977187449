"""The world on disk, twice a second, so that a simulation that was killed goes on where it was."""

import hashlib
from pathlib import Path

import msgspec

from common.files import atomic_file
from common.messages import Touch

VERSION = 1
"""Of the file's form; another one is not resumed from."""
NAME = "sim.checkpoint"


class Checkpoint(msgspec.Struct):
    """Everything that a world is made of: `physics` float64 bytes of MuJoCo's integration state, `setpoint` of base
    and arm, `odometry` the believed pose, `touches` the log of contacts, `charge` of the battery. `run` and `model` say
    to which run and model it belongs.
    """

    run: str
    model: str
    seed: int
    tick: int
    world: str
    physics: bytes
    setpoint: list[float]
    odometry: tuple[float, float, float]
    effort: float
    stopped: bool
    touches: list[Touch] = []
    charge: float = 1.0
    version: int = VERSION


def fingerprint(mjcf: str) -> str:
    """Hash that names a model."""
    return hashlib.sha256(mjcf.encode()).hexdigest()[:16]


def save(path: Path, state: Checkpoint) -> str:
    """Replace the file in one step; the reason when that was not possible."""
    return atomic_file.replace(path, msgspec.msgpack.encode(state))


def load(path: Path, run: str, model: str) -> Checkpoint | None:
    """The last state of this run and model, None when there is none or it cannot be read."""
    try:
        state = msgspec.msgpack.decode(path.read_bytes(), type=Checkpoint)
    except (OSError, msgspec.DecodeError):
        return None
    return state if (state.version, state.run, state.model) == (VERSION, run, model) else None
