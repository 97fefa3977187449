"""Object tracks over time: seen, seen again, moved, grasped, gone. Pure."""

import math
from collections import deque
from collections.abc import Sequence

import numpy as np

from common.floor_plan import Vec3
from common.geometry import Rectangle, yaw_quat
from common.household import Household
from common.messages import End, WorldObject
from services.perception.detection import Detection
from services.perception.shapes.measurement import LEVEL as LYING
from services.perception.tracking.association import moved_here, overlap, separation, should_show
from services.perception.tracking.descriptor import shares
from services.perception.tracking.track import OPENING, SURE, Track, aim, see, several, shown
from services.perception.views.view import View

CERTAIN = 0.8
"""Confidence from which an object that was not listed is told of after one sighting."""
HELD_RANGE = 0.12
"""Distance [m] from the hand within which the object that it closed on was believed to be."""
DOUBT = 0.45
"""Weight of the best sighting [1/m2] below which kind and shape are in doubt: that of a whole view from 1.5 m."""
FALLEN = 0.15
"""Height [m] above where it would rest from which what leaves the hand falls. Chosen: a tall bottle that is put down
is held 0.08 above its middle."""
FALLS, TURNED = 1.0, 0.35
"""How far [m] on the floor plan from the hand what fell from it is seen again, and by which share its extents may
differ then. Chosen: from a worktop, and rolling; a toy plane on its back is wider by that, its wings hide nothing."""
LOW, ABOVE = 0.045, 0.005
"""Height [m] up to which a thing lies flat, and how much higher than it what lies on it is. Chosen: as `joints.LOW` has
it; half a pencil."""
LOST = 20
"""Tracks that are remembered after they were lost [count]. Chosen: more than a person confirms in one mission."""
FRESH = 20.0
"""For how long [s] an object is new. Chosen: from when the hand begins to move one until all of the place is seen."""


class ObjectTracker:
    """What is where, as far as it was seen."""

    def __init__(self, household: Household, gone_after: int, min_confidence: float) -> None:
        self._household, self._gone_after, self._min = household, gone_after, min_confidence
        self._tracks: list[Track] = []
        self._lost: deque[Track] = deque(maxlen=LOST)
        self._fallen: deque[Track] = deque(maxlen=LOST)
        self._count = 0

    def update(self, view: View, detections: Sequence[Detection], now: float) -> set[str]:
        """Take in what a view shows; ids of the objects that were seen."""
        free = [t for t in self._tracks if not t.held]
        seen: set[str] = set()
        if view.camera == "wrist":
            seen, detections = self._take_near(view, detections, now)
            free = [t for t in free if t in self._tracks]
        pairs = sorted(
            (apart, n, k)
            for n, d in enumerate(detections)
            for k, t in enumerate(free)
            if (apart := separation(d, t)) is not None
        )
        matched: dict[int, Track] = {}
        for _, n, k in pairs:
            if n not in matched and free[k].id not in seen:
                matched[n] = free[k]
                seen.add(free[k].id)
        missing = [t for t in free if t.id not in seen and should_show(t, view)]
        for n, d in enumerate(detections):
            track = matched.get(n) or moved_here(d, missing)
            if track in missing:
                missing.remove(track)
                seen.add(track.id)
            if track is None:
                self._count += 1
                track = Track(f"object-{self._count}", d.position, d.yaw, d.size, d.on, now, 0.0, tilt=d.tilt)
                track.began = now
                self._tracks.append(track)
                seen.add(track.id)
            see(track, d, now, should_show(track, view))
        self._fallen = deque((t for t in self._fallen if not self._is_found(t, seen)), LOST)
        for track in missing:
            track.misses += 1
            if track.seen_at > track.looked_at and self._is_found(track, seen):
                track.misses = self._gone_after
                continue
            fresh = [t for t in self._tracks if t.began > max(track.began, now - FRESH) and t.id in seen]
            heir = moved_here(track, fresh)
            if heir is not None:
                # It was seen elsewhere before it could be seen that it is gone.
                heir.id, heir.label, heir.began, track.misses = track.id, track.label, track.began, self._gone_after
                seen.add(heir.id)
        gone = [t for t in self._tracks if t.misses >= self._gone_after]
        self._tracks = [t for t in self._tracks if t.misses < self._gone_after]
        self._lost.extend(gone)
        kept = {t.id for t in self._tracks}
        # No picture has shown it since it was in the hand.
        self._fallen += [t for t in gone if t.seen_at > t.looked_at and t.id not in kept]
        return seen

    def _is_found(self, fallen: Track, seen: set[str]) -> bool:
        """What fell from the hand is seen below it or on the floor: that goes by its id from now on."""
        below = ("", fallen.on)
        fresh = [t for t in self._tracks if t.began > fallen.seen_at and t.id in seen and t.on in below]
        heir = moved_here(fallen, fresh, FALLS, TURNED)
        if heir is not None:
            heir.id = fallen.id
            seen.add(fallen.id)
        return heir is not None

    def _take_near(self, view: View, detections: Sequence[Detection], now: float) -> tuple[set[str], list[Detection]]:
        """Where the hand's own camera shows objects that nobody listed: ids of those; and what is left of its view."""
        seen, left = set(), [d for d in detections if d.known]
        for track in [t for t in self._tracks if not t.held]:
            found = shown(track, view, detections)
            if things := several(track, found):
                self._tracks.remove(track)
                left += things
            elif found:
                aim(track, *found[0], now)
                seen.add(track.id)
        return seen, left

    def carry(self, hand: Vec3, holding: bool, now: float, working: bool = False) -> bool:
        """Follow the hand: what it closes on is held and moves with it until it opens; True when anything is or was.

        What falls while the arm rests lies behind on the base's way, where the hand was. Where the base stands itself,
        while the arm is `working` or the hand over it, what falls is nowhere until it is seen again.
        """
        held = next((t for t in self._tracks if t.held), None)
        if holding and held is None:
            near = [(math.dist(t.position, hand), t.id, t) for t in self._tracks]
            if near and min(near)[0] < HELD_RANGE:
                held = min(near)[2]
                held.held, held.on, held.seen_at = True, "", now
        if held is None:
            return False
        held.looks.points = np.empty((0, 3))
        if holding:
            held.position = hand
            return True
        surface = self._household.surface_at(*hand)
        held.on, height = (surface.name, surface.center[2]) if surface else ("", 0.0)
        held.position = (hand[0], hand[1], height + held.size[2] / 2)
        if working and hand[2] - held.position[2] > FALLEN and not (surface and surface.depth):
            self._tracks.remove(held)
            held.held, held.seen_at = False, now
            self._fallen.append(held)
            return True
        # Where the hand let go; the next look says better.
        held.held, held.misses, held.weight, held.seen_at = False, 0, 0.0, now
        held.yaw_seen = False
        held.looks.set_down()
        return True

    def missed(self, hand: Vec3) -> None:
        """The fingers closed there and hold nothing: any look says better where the object is than those before it."""
        near = [(math.dist(t.position, hand), t.id, t) for t in self._tracks if not t.held]
        if near and min(near)[0] < HELD_RANGE:
            track = min(near)[2]
            track.weight = track.best = 0.0

    def objects(self, since: float = -math.inf) -> list[WorldObject]:
        """What is believed, one place for each object of the household, the newest that was sure.

        `since`: only what a picture has shown at that robot time [s] or later.
        """
        return [_as_object(t, label) for t, label in _labelled(sorted(self._told(since), key=_age))]

    def told_as(self, key: str) -> str:
        """Id of what is told of where the object with that id is, or was until it was seen as another: of two that take
        up the same space one is."""
        told = self._told(-math.inf)
        if not key or any(t.id == key for t in told):
            return key
        meant = [t for t in (*self._tracks, *self._lost) if t.id == key]
        return next((t.id for own in meant for t in told if overlap(t, own) or _is_part(own, t)), key)

    def _told(self, since: float) -> list[Track]:
        sure = [t for t in self._tracks if (t.confidence >= self._min or t.held) and t.looked_at >= since]
        best: dict[str, Track] = {}
        others: list[Track] = []
        for track in sure:
            label = track.name[0]
            if not track.known:
                others.append(track)
                continue
            rival = best.get(label)
            if rival is None or (track.held, track.confidence >= SURE, track.seen_at, track.confidence) > (
                rival.held, rival.confidence >= SURE, rival.seen_at, rival.confidence
            ):  # fmt: skip
                best[label] = track
        chosen = list(best.values())
        for track in sorted(others, key=lambda t: (-t.sightings * t.confidence, t.id)):
            told = track.held or track.sightings > 1 or track.confidence >= CERTAIN
            if told and not any(overlap(track, other) for other in chosen):
                chosen.append(track)
        return [t for t in chosen if t.held or not any(_is_part(t, other) for other in chosen)]

    def doubtful(self) -> set[str]:
        """Ids of objects that nobody listed and that no view has shown whole and near: they may be something else."""
        return {t.id for t in self._tracks if not t.held and not t.known and t.clearest < DOUBT}


def _is_part(track: Track, other: Track) -> bool:
    """What nobody listed and lies flat within the outline of something larger that does so, and not on it, is a part of
    that, seen by itself: the lens of a magnifying glass, its handle."""
    (x, y, z), (length, width, high) = other.position, other.size
    if track.known or other.known or high > LOW or width * length <= track.size[0] * track.size[1]:
        return False
    on_top = track.position[2] + track.size[2] / 2 > z + high / 2 + ABOVE
    return not on_top and Rectangle(x, y, length, width, other.yaw).contains(*track.position[:2])


def _age(track: Track) -> int:
    return int(track.id.rpartition("-")[2])


def _labelled(tracks: Sequence[Track]) -> list[tuple[Track, str]]:
    """Each track with a label that no other has: the household's, or its colour and kind, numbered if need be."""
    taken = {t.name[0] for t in tracks if t.known}
    found = []
    for t in tracks:
        if t.known:
            t.label = t.name[0]
        else:
            kind, main = t.looks.name()
            plain = f"{main} {kind}".strip()
            numbered = (f"{plain} {n}" for n in range(2, len(tracks) + 2))
            kept = t.label if t.label == plain or t.label.startswith(plain + " ") else ""
            t.label = kept if kept and kept not in taken else next(x for x in (plain, *numbered) if x not in taken)
        taken.add(t.label)
        found.append((t, t.label))
    return found


def _top(t: Track) -> End:
    """What the upper end is; of what lies, if it was seen which of them that is."""
    return "open" if t.tilt == LYING and t.yaw_seen and t.looks.opening >= OPENING else t.looks.top


def _as_object(t: Track, label: str) -> WorldObject:
    kind, colour = t.name[1:] if t.known else t.looks.named
    return WorldObject(
        label=label, kind=kind, colour=colour, position=t.position, orientation=yaw_quat(t.yaw), size=t.size, on=t.on,
        confidence=round(t.confidence, 3), seen_at=t.seen_at, held=t.held, id=t.id, tilt=t.tilt, shape=t.looks.shape,
        colours=[colour] if t.known else t.looks.main_colours, kinds=[] if t.known else t.looks.likely_kinds,
        kind_shares={} if t.known else shares(t.looks.kinds), colour_shares={} if t.known else shares(t.looks.colours),
        measured=not t.known, spread=0.0 if t.known else round(t.looks.spread, 4), points=t.looks.packed(),
        top=_top(t),
    )  # fmt: skip
