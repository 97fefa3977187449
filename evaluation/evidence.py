"""What physics says happened: lifted, held in transit, at rest where it belongs, nothing hit, nothing knocked over.

Pure: a sequence of looks at the world in, evidence and verdict out. What the robot claims does not enter.
"""

import math
from collections.abc import Mapping

import msgspec

from evaluation.replica import Look, distance

LIFTED = 0.05
"""Rise [m] above where it stood that counts as lifted."""
STILL = 0.005
"""Drift [m] over `REST` that still counts as at rest."""
REST = 0.5
HARD = 0.004
"""Depth [m] of a contact with furniture that the skin of a real robot would feel."""
SHOVED = 0.06
TIPPED = math.radians(35)
MOVED = 0.25
ROLLS = ("apple", "ball")
FALL = 1.0
"""Time [s] that a thing let go above a bin may take to lie in it."""


class Want(msgspec.Struct, frozen=True):
    """One object and the receptacles in any of which it belongs after the mission."""

    thing: str
    goals: tuple[str, ...]


class ThingEvidence(msgspec.Struct):
    """What happened to one wanted object. `carried` [m] is how far the base drove while it was in the hand."""

    thing: str
    started_on: str
    lifted: bool = False
    carried: float = 0.0
    dropped: bool = False
    drops: int = 0
    on: str = ""
    at_rest: bool = False
    released: bool = False
    delivered: bool = False
    why: str = ""


class Evidence(msgspec.Struct):
    """The whole case. `hits`: furniture, walls and obstacles the robot touched; `disturbed`: other objects it moved."""

    things: list[ThingEvidence] = []
    hits: list[str] = []
    disturbed: list[str] = []
    driven: float = 0.0
    standing: bool = False
    moved: list[str] = []


class Recorder:
    """Takes looks in the order of time."""

    def __init__(self, wants: tuple[Want, ...], kinds: Mapping[str, str], bins: frozenset[str] = frozenset()) -> None:
        """`bins`: the receptacles into which things are let fall."""
        self._wants, self._kinds = wants, kinds
        self._bins = {w.thing: bins & set(w.goals) for w in wants}
        self._let_go: dict[str, float] = {}
        self._first: Look | None = None
        self._last: Look | None = None
        self._recent: list[Look] = []
        self._hits: dict[str, float] = {}
        self._driven = 0.0
        self._marks: dict[str, ThingEvidence] = {}
        self._touched: set[str] = set()

    def see(self, look: Look) -> None:
        if self._first is None or self._last is None:
            self._first = self._last = look
            self._recent = [look]
            self._marks = {n: ThingEvidence(n, thing.on) for n, thing in look.things.items()}
            return
        step = distance(look.base[:2], self._last.base[:2])
        self._driven += step
        for part, thing, depth in look.hits:
            if depth >= HARD:
                key = f"{part} on {thing}"
                self._hits[key] = max(self._hits.get(key, 0.0), depth)
        self._touched |= look.pushed
        for name, now in look.things.items():
            mark, before = self._marks[name], self._last.things[name]
            risen = now.position[2] - self._first.things[name].position[2]
            mark.lifted = mark.lifted or (now.held and risen > LIFTED)
            mark.carried += step if now.held else 0.0
            if now.held and not before.held:
                # What slipped and was picked up again is judged by the carry that followed.
                mark.dropped = False
            fell = now.on == "floor" and mark.started_on != "floor"
            if mark.dropped and now.on in self._bins.get(name, ()) and look.t - self._let_go[name] < FALL:
                mark.dropped, mark.drops = False, mark.drops - 1
            if not mark.dropped and (fell or (before.held and not now.touched and not now.on)):
                mark.dropped, self._let_go[name] = True, look.t
                mark.drops += 1
        self._last = look
        self._recent = [x for x in self._recent if x.t >= look.t - REST] + [look]

    @property
    def ready(self) -> bool:
        return self._first is not None

    def conclude(self) -> Evidence:
        """The evidence so far; what is at rest is judged over the last half second."""
        first, last = self._first, self._last
        if first is None or last is None:
            return Evidence(
                things=[ThingEvidence(w.thing, "", why="the simulation showed nothing") for w in self._wants]
            )
        wanted = {w.thing for w in self._wants}
        hits = [f"{key}, {1000 * depth:.0f} mm" for key, depth in sorted(self._hits.items())]
        return Evidence(
            things=[self._judge(w, last) for w in self._wants],
            hits=hits,
            disturbed=[n for n in sorted(self._touched - wanted) if self._disturbed(n, first, last)],
            driven=round(self._driven, 3),
            standing=distance(self._recent[0].base[:2], last.base[:2]) < STILL,
            moved=[n for n, t in last.things.items() if distance(t.position, first.things[n].position) > MOVED],
        )

    def _judge(self, want: Want, last: Look) -> ThingEvidence:
        mark, now = self._marks[want.thing], last.things[want.thing]
        oldest = self._recent[0].things[want.thing]
        mark.on, mark.released = now.on, not now.held and not now.touched
        mark.at_rest = distance(oldest.position, now.position) < STILL
        mark.carried = round(mark.carried, 3)
        goals = " or ".join(want.goals)
        faults = [
            text
            for wrong, text in (
                (not mark.lifted, "never lifted by the gripper"),
                (mark.dropped, "dropped on the way"),
                (not mark.released, "still touched by the gripper"),
                (mark.on not in want.goals, f"on {mark.on or 'nothing'}, not on {goals}"),
                (not mark.at_rest, "not at rest"),
            )
            if wrong
        ]
        mark.delivered, mark.why = not faults, "; ".join(faults)
        return mark

    def _disturbed(self, name: str, first: Look, last: Look) -> bool:
        """Knocked over, pushed off, or shoved by the robot."""
        was, now = first.things[name], last.things[name]
        tipped = self._kinds.get(name) not in ROLLS and abs(now.tilt - was.tilt) > TIPPED
        return tipped or now.on != was.on or distance(was.position, now.position) > SHOVED


def spl(delivered: bool, shortest: float, driven: float) -> float:
    """Success weighted by path length (Anderson et al., "On Evaluation of Embodied Navigation Agents", 2018)."""
    return shortest / max(shortest, driven) if delivered and shortest > 0 else 0.0
