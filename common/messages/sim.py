"""The simulation: its state, clock and log of contacts."""

from typing import Literal

from common.messages.base import Message

TouchKind = Literal["furniture", "obstacle", "floor", "self", "held"]


class SimState(Message):
    """Full physics state for cameras and viewers: float64 little-endian qpos and mocap poses."""

    t: float
    tick: int
    epoch: str
    qpos: bytes
    mocap: bytes = b""


class Touch(Message):
    """The robot or what it holds in contact with something, without a break; updates carry the same `id`.

    `kind`: what the robot's `part` touches, itself included, or `held`: then `part` is the object in the hand,
    which presses with what is beyond its own weight. Greatest `force` [N], `impulse` [Ns] and contact time `seconds` so
    far, greatest `depth` [m] of overlap.
    """

    id: int
    part: str
    thing: str
    kind: TouchKind
    first: float
    last: float
    seconds: float = 0.0
    force: float = 0.0
    impulse: float = 0.0
    depth: float = 0.0


class SimContacts(Message):
    """Touches that began or went on since the last message, from every physics step; for evaluators alone."""

    t: float
    epoch: str
    touches: list[Touch]


class SimModel(Message):
    """What is simulated, for who draws it: `files` are the pictures that `mjcf` names."""

    scene: str
    seed: int
    epoch: str
    mjcf: str
    files: dict[str, bytes] = {}


class SimStatus(Message):
    """`epoch` names the process, `world` the layout that it simulates, which outlives the process."""

    state: Literal["running", "paused", "stopped"]
    speed: str = "realtime"
    epoch: str = ""
    scene: str = ""
    seed: int = 0
    world: str = ""
    detail: str = ""


class SimClockTick(Message):
    """Robot time; published after the state of that tick."""

    t: float
    tick: int = -1
    epoch: str = ""
    lockstep: bool = False


class LockstepAck(Message):
    """Participant `name` has finished `tick` (tick -1: joins) and is due every `period` ticks.

    `heard`: the keys of messages without a tick, from clients, that the step saw first, one entry for each.
    """

    name: str
    tick: int
    period: int
    epoch: str = ""
    heard: list[str] = []
