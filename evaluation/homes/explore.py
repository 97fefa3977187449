"""Exploration of an unknown home in lockstep in one process, as `tidybot map` does with processes."""

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import msgspec

from common import messages as m
from common import topics
from common.household import load_household
from common.scene import Scene
from evaluation.registry import service_class
from evaluation.stack import Stack
from judge.contacts import ContactBook

LIMIT = 1800.0
"""Robot time [s] for one home."""
NOT_NEEDED = ("manipulation", "speech", "planner", "perception", "brain")
REPORT = 5.0
"""Robot time [s] between two looks at how far it is."""


class Explored(NamedTuple):
    """How an exploration went: robot time [s], the last status, and what was hit."""

    seconds: float
    status: m.MappingStatus
    hits: list[str]


def explore(
    scene: Scene,
    seed: int,
    out: Path,
    limit: float = LIMIT,
    tell: Callable[[Stack, m.MappingStatus], None] = lambda stack, status: None,
    settings: tuple[str, ...] = (),
) -> Explored:
    """Map a home, all services in this process; the files are in `out`. `tell` hears of it every `REPORT`."""
    stack = Stack(
        scene, seed, (*settings, "navigation.map=mapping", f"mapping.out={out}"),
        household=load_household("unmapped"), without=NOT_NEEDED,
    )  # fmt: skip
    try:
        stack.join(service_class("mapping"))
        touches = stack.bus.tap(topics.SIM_CONTACTS)
        book, status = ContactBook(), m.MappingStatus(t=0.0, phase="idle")
        while stack.now < limit and status.phase not in ("done", "failed"):
            stack.advance(REPORT)
            status = msgspec.json.decode(stack.bus.last[topics.MAPPING_STATUS.key], type=m.MappingStatus)
            for payload in touches:
                book.note(msgspec.msgpack.decode(payload, type=m.SimContacts))
            touches.clear()
            tell(stack, status)
        seconds = stack.now
        if status.phase not in ("done", "failed"):
            stack.bus.send(topics.MAPPING_GOAL, m.MappingGoal(goal="save", id="limit"))
            stack.advance(REPORT)
        return Explored(seconds, status, book.hits())
    finally:
        stack.close()
