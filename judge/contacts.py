"""Hits among the contacts of the simulation's log, by force and impulse. Pure.

ISO/TS 15066:2016 (now in ISO 10218-2:2025), table A.2, allows a robot to press on a person's face, the most sensitive
part that it may touch at all, with 65 N for longer than 0.5 s; what touches for less is transient, and twice as much
may be. The judge grants no transient bonus and takes everything the robot meets for somebody's face.
"""

from common import messages as m

FORCE = 65.0
"""Greatest force [N] on furniture, walls, floor and obstacles: table A.2, face, quasi-static."""
IMPULSE = FORCE * 0.5
"""Greatest impulse [Ns] of one touch: that force over the 0.5 s from which a contact is no longer transient. So 10 N
for 3 s are leaning on something, and a hit."""
SELF_FORCE = 10.0
"""Greatest force [N] of the robot on itself. It has no skin and plans around itself: what is more than a graze, the
weight of one of its links (Kinova Gen3: 0.5 to 1.4 kg), is a collision."""
SELF_IMPULSE = SELF_FORCE * 0.5
"""Greatest impulse [Ns] of the robot on itself, over the same 0.5 s."""
FELT = 1.0
"""Force [N] from which a touch is worth a line in the evidence: the weight of a small object."""


def limits(kind: m.TouchKind) -> tuple[float, float]:
    """Greatest force [N] and impulse [Ns] of a contact of this kind that is no hit."""
    if kind == "self":
        return SELF_FORCE, SELF_IMPULSE
    return FORCE, IMPULSE


def is_hit(touch: m.Touch) -> bool:
    """True for a contact with more force or impulse than its kind allows."""
    force, impulse = limits(touch.kind)
    return touch.force > force or touch.impulse > impulse


class ContactBook:
    """The newest state of every contact, by the simulation's epoch and its id."""

    def __init__(self) -> None:
        self._touches: dict[tuple[str, int], m.Touch] = {}

    def note(self, report: m.SimContacts) -> None:
        """Take a part of the simulation's log: contacts that began or went on."""
        for touch in report.touches:
            self._touches[report.epoch, touch.id] = touch

    def hits(self) -> list[str]:
        """Descriptions of the hits, in the order in which they began."""
        return [describe(t) for t in self._touches.values() if is_hit(t)]

    def felt(self) -> list[str]:
        """Descriptions of all contacts with at least FELT of force, in the order in which they began."""
        return [describe(t) for t in self._touches.values() if t.force >= FELT]


def describe(touch: m.Touch) -> str:
    """The contact in words, as `base on kitchen table: 120 N, 3.1 Ns in 0.05 s at 12.3 s`."""
    part, thing = (name.replace("_", " ") for name in (touch.part, touch.thing))
    held = f"{part} in the hand" if touch.kind == "held" else part
    how = f"{touch.force:.0f} N, {touch.impulse:.1f} Ns in {touch.seconds:.2f} s"
    return f"{held} on {thing}: {how} at {touch.first:.1f} s"
