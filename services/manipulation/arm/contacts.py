"""Evidence that an object is wider than the hand: what the open fingers touched on their way around it."""

import math
from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from common.geometry import Array

OTHER_SIDE = math.radians(30)
"""Angle between two approaches, or two closing directions, from which they are different sides of an object [rad]:
more than the error of any sighting, less than the 50 degrees between the outermost grasps of a row."""
AIM_ERROR = 0.010
"""Most [m] that a grasp's own position may be off when the fingers are said to have been around the object: the error
of a sighting from 0.6 m with the object's size unknown by 15 mm."""
LASTING = 300.0
"""How long [s] a contact is evidence. Chosen: a mission with its retries, not the next day's."""
KEPT = 8
"""Contacts that are remembered: those of two goals with four grasps each."""


@dataclass(frozen=True)
class Contact:
    """Open fingers touched the object. `rotation` (3, 3) of the hand in frame map, as `arm_model.Pose` has it.

    `seen_at`: robot time [s] of the sighting that the grasp was planned for. `around`: the fingertips had come as far
    as the object was believed to reach, so that they touched it and not something before it.
    """

    rotation: Array
    seen_at: float
    around: bool


class ContactLog:
    """Contacts with one object since it was last grasped, over several goals and standing poses."""

    def __init__(self) -> None:
        self._label = ""
        self._contacts: deque[Contact] = deque(maxlen=KEPT)

    def add(self, label: str, contact: Contact) -> None:
        """One more contact with the object of that label; those with another one are forgotten."""
        if label != self._label:
            self.clear()
        while self._contacts and self._contacts[0].seen_at < contact.seen_at - LASTING:
            self._contacts.popleft()
        self._label = label
        self._contacts.append(contact)

    def clear(self) -> None:
        """The fingers went around the object: it fits between them."""
        self._contacts.clear()

    def rotations(self, label: str) -> list[Array]:
        """The hand's rotations (3, 3) in frame map at the contacts with an object."""
        return [c.rotation for c in self._contacts] if label == self._label else []

    def too_wide(self) -> bool:
        """Fingers around the object touched it on two sides, each by a sighting of its own."""
        pairs = combinations([c for c in self._contacts if c.around], 2)
        return any(a.seen_at != b.seen_at and other_side(a.rotation, b.rotation) for a, b in pairs)


def other_side(a: Array, b: Array) -> bool:
    """True when two rotations (3, 3) of the hand hold an object from different sides: approach or closing direction."""
    approach = float(a[:, 2] @ b[:, 2])
    closing = abs(float(a[:, 1] @ b[:, 1]))
    return min(approach, closing) < math.cos(OTHER_SIDE)


def new_sides_first(rotations: Iterable[Array], known: list[Array]) -> list[int]:
    """Indices of rotations (3, 3): those from another side than all `known` first, else in the given order."""
    near = [not all(other_side(rotation, other) for other in known) for rotation in rotations]
    return sorted(range(len(near)), key=lambda n: near[n])


def came_around(pinch: Array, grasp: Array, size: tuple[float, float, float], pad: float) -> bool:
    """The fingertips were within the believed object. `pinch` (3,) is where the hand stopped, `grasp` (3,) where it was
    to go, both in the base frame [m].

    `size`: the object's full extents [m]; `pad`: how far the fingertips reach beyond the pinch point [m].
    """
    return float(np.linalg.norm(pinch - grasp)) <= max(size[:2]) / 2 + pad + AIM_ERROR
