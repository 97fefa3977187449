"""Checkpoints of the world on disk, twice a second, from which a simulation that was killed goes on."""

import hashlib
from pathlib import Path

import msgspec

from common.files import atomic_file
from common.messages import Touch

VERSION = 1
"""Of the file's form; another one is not resumed from."""
NAME = "sim.checkpoint"


class Checkpoint(msgspec.Struct):
    """The complete state of a world: `physics` float64 bytes of MuJoCo's integration state, `setpoint` of base
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
    """A hash that identifies a model."""
    return hashlib.sha256(mjcf.encode()).hexdigest()[:16]


def save(path: Path, state: Checkpoint) -> str:
    """Save atomically; returns the reason when that was not possible, else ""."""
    return atomic_file.replace(path, msgspec.msgpack.encode(state))


def load(path: Path, run: str, model: str) -> Checkpoint | None:
    """The last checkpoint of this run and model, None when there is none or it cannot be read."""
    try:
        state = msgspec.msgpack.decode(path.read_bytes(), type=Checkpoint)
    except (OSError, msgspec.DecodeError):
        return None
    return state if (state.version, state.run, state.model) == (VERSION, run, model) else None
