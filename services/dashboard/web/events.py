"""Events from visitors of the page."""

import asyncio
from dataclasses import dataclass

import msgspec
import numpy as np
from numpy.typing import NDArray


class Words(msgspec.Struct, frozen=True):
    """What a visitor did: `do` is stop, resume, go on, say, name, yes, no, restart, drive or hand.

    `text` goes with say, name, restart, drive ("forward left turn", each from -1 to 1) and hand
    (`HandTeleoperation.hold`).
    """

    do: str
    text: str = ""


class Sound(msgspec.Struct, frozen=True):
    """A piece of what a visitor's microphone heard: int16 at 16 kHz; an empty one ends it."""

    data: bytes


@dataclass(frozen=True)
class Click:
    """A visitor clicked in the 3-D view: the ray below the pointer, in frame map."""

    origin: NDArray[np.float64]
    direction: NDArray[np.float64]


@dataclass(frozen=True)
class Asked:
    """A visitor asks for a mission's page; `answer` of `Web` gives it."""

    mission: str
    answer: "asyncio.Future[str]"


Event = Words | Sound | Click | Asked
