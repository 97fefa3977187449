"""What physics says happened: lifted, held in transit, upright and at rest where it belongs, nothing hit or moved.

Pure: samples of the world in, evidence out. What the robot claims does not enter.
"""

import math
from collections.abc import Mapping

import msgspec

from common import messages as m
from judge.contacts import ContactBook
from judge.track import ThingState, Track

STILL = 0.005
"""Drift [m] over `REST` that still counts as at rest: a rolling apple covers it in half the time."""
CREEP = 2e-5
"""Drift [m] over `REST` from which a thing moves of itself. Chosen: what has come to rest sleeps, a toy that topples
begins with 50 um in 50 ms."""
REST = 0.5
"""Time [s] over which rest is judged: ten samples at 20 Hz."""


class Sample(msgspec.Struct, frozen=True):
    """The world at robot time `t`; `opening`: gap between the pads [m]."""

    t: float
    base: tuple[float, float, float]
    things: dict[str, ThingState]
    opening: float = 0.0


class Want(msgspec.Struct, frozen=True):
    """One object and the receptacles in any of which it belongs after the mission."""

    thing: str
    goals: tuple[str, ...]


class ThingEvidence(msgspec.Struct):
    """What happened to one wanted object. `carried` [m]: way of the base with it in the hand; `tilt` [deg]."""

    thing: str
    started_on: str
    lifted: bool = False
    carried: float = 0.0
    dropped: bool = False
    drops: int = 0
    on: str = ""
    tilt: float = 0.0
    toppled: bool = False
    at_rest: bool = False
    released: bool = False
    delivered: bool = False
    why: str = ""


class Evidence(msgspec.Struct):
    """What physics shows of a whole case.

    `hits`: what the robot or the object in its hand touched too hard, itself included; `touches`: whatever they touched
    more than barely. `moved`: objects that moved or went over, whoever touched
    them; `disturbed`: those of them that nobody wanted moved.
    """

    things: list[ThingEvidence] = []
    hits: list[str] = []
    disturbed: list[str] = []
    driven: float = 0.0
    standing: bool = False
    moved: list[str] = []
    touches: list[str] = []


class EvidenceRecorder:
    """Collects samples of the world in the order of time and derives the evidence from them."""

    def __init__(self, kinds: Mapping[str, str], bins: frozenset[str] = frozenset()) -> None:
        """`kinds` of the objects by name; `bins`: receptacles into which things may be let fall, and lie as they do."""
        self._kinds, self._bins = kinds, bins
        self._recent: list[Sample] = []
        self._tracks: dict[str, Track] = {}
        self._book = ContactBook()
        self._driven = 0.0
        self._settling: set[str] = set()

    def add(self, sample: Sample) -> None:
        """Take one more sample of the world."""
        if not self._recent:
            self._tracks = {n: Track(self._kinds[n], self._bins, thing, thing) for n, thing in sample.things.items()}
            self._recent = [sample]
            return
        step = math.dist(sample.base[:2], self._recent[-1].base[:2])
        self._driven += step
        for name, now in sample.things.items():
            self._tracks[name].add(now, sample.t, step)
        self._recent = [x for x in self._recent if x.t >= sample.t - REST] + [sample]
        self._settling = {n for n in self._settling if self._moves_of_itself(n)}
        for name in self._settling:
            self._tracks[name].restart()

    def note_contacts(self, report: m.SimContacts) -> None:
        """Take a part of the simulation's log of contacts."""
        self._book.note(report)

    @property
    def ready(self) -> bool:
        """True once a sample was added."""
        return bool(self._recent)

    def restart(self) -> None:
        """Take where objects are now as their baseline, or where they come to rest, of those that still topple."""
        for track in self._tracks.values():
            track.restart()
        self._settling = {n for n in self._tracks if self._moves_of_itself(n)}

    def _moves_of_itself(self, name: str) -> bool:
        then, now = self._recent[0].things[name], self._recent[-1].things[name]
        return math.dist(then.position, now.position) > CREEP and not (now.touched or now.held)

    def things(self, wants: tuple[Want, ...]) -> list[ThingEvidence]:
        """The evidence for each wanted object at this moment."""
        if not self.ready:
            return [ThingEvidence(w.thing, "", why="the simulation showed nothing") for w in wants]
        return [self._judge(want) for want in wants]

    def conclude(self, wants: tuple[Want, ...], may_move: frozenset[str]) -> Evidence:
        """The evidence of all samples so far. `may_move`: objects that may have been moved."""
        moved = [n for n, track in sorted(self._tracks.items()) if track.disturbed]
        return Evidence(
            things=self.things(wants),
            hits=self._book.hits(),
            disturbed=[n for n in moved if n not in may_move],
            driven=round(self._driven, 3),
            standing=self._standing,
            moved=moved,
            touches=self._book.felt(),
        )

    @property
    def _standing(self) -> bool:
        """True when the base is at rest."""
        return self.ready and math.dist(self._recent[0].base[:2], self._recent[-1].base[:2]) < STILL

    def _judge(self, want: Want) -> ThingEvidence:
        track = self._tracks[want.thing]
        now, oldest = track.last, self._recent[0].things[want.thing]
        found = ThingEvidence(
            want.thing, track.baseline.on, lifted=track.lifted, carried=round(track.carried, 3),
            dropped=track.dropped, drops=track.drops, on=now.on, tilt=round(math.degrees(now.tilt), 1),
            toppled=track.toppled, at_rest=math.dist(oldest.position, now.position) < STILL,
            released=not now.held and not now.touched,
        )  # fmt: skip
        goals = " or ".join(want.goals)
        faults = [
            text
            for wrong, text in (
                (not found.lifted, "never lifted by the gripper"),
                (found.dropped, "dropped on the way"),
                (not found.released, "still touched by the gripper"),
                (found.on not in want.goals, f"on {found.on or 'nothing'}, not on {goals}"),
                (found.toppled, f"toppled, {found.tilt:.0f} degrees from upright"),
                (not found.at_rest, "not at rest"),
            )
            if wrong
        ]
        found.delivered, found.why = not faults, "; ".join(faults)
        return found


def spl(delivered: bool, shortest: float, driven: float) -> float:
    """Success weighted by path length (Anderson et al., "On Evaluation of Embodied Navigation Agents", 2018)."""
    return shortest / max(shortest, driven) if delivered and shortest > 0 else 0.0
