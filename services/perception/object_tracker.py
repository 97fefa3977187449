"""Object tracks over time: seen, seen again, moved, grasped, gone. Pure."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from common.floor_plan import Vec3
from common.geometry import yaw_quat
from common.household import Household
from common.messages import WorldObject, WorldObjects
from services.perception.descriptor import Descriptor, shares
from services.perception.detection import Detection
from services.perception.view import View

SAME = 0.12
"""Distance [m] on the floor plan within which a detection belongs to a track that looks the same. Chosen: below the
spacing of neighbours."""
OVERLAP = 0.6
"""Distance, by the half widths of both, within which a detection is the same object whatever it looks like, and two
tracks are one. Chosen: neighbours that touch are 1 apart."""
ALIKE = 0.3
"""Share of the colours' votes that a detection and a track have in common if they look the same."""
UNLIKE = 0.08
"""Distance [m] that looking different counts as."""
UNLISTED = ("", "", "")
"""Stands for the name of an object that was not listed, in the evidence for names."""
CERTAIN = 0.8
"""Confidence from which an object that was not listed is told of after one sighting."""
MOVED = 0.05
"""Distance [m] from which an object has moved, rather than been measured differently. Chosen: three times the error of
a sighting from 2 m."""
FELL = 0.7
"""A change of the tilt [rad] that is no error of measurement: objects stand, lie (1.57) or are upside down (3.14)."""
LIKELY = 0.4
"""Confidence from which a view may say that an object fell; rendered lying objects get 0.55 and more half hidden by the
arm, and in 37 rendered views of standing objects none was taken for a lying one."""
OPENING = 0.9
"""Votes from which an object has an opening: one whole view from 1.5 m."""
HELD_RANGE = 0.12
"""Distance [m] from the hand within which the object that it closed on was believed to be."""
DOUBT = 0.45
"""Weight of the best sighting [1/m2] below which kind and shape are in doubt: that of a whole view from 1.5 m."""
SURE = 0.55
"""Confidence from which a detection's name, and with it its position, counts in full."""
TRUST = 4.0
"""Weight of a track's position, in best sightings, beyond which further ones no longer add to it."""
PARTIAL = 0.1
"""Weight of a sighting of a part, of that of the whole; times the squared share that was seen."""
POORER = 0.5
"""Weight of a sighting, of the best one, from which it may still turn the object."""
EDGE_PIXELS = 30
"""Distance [pixels] from the picture's edge within which a missing object says nothing."""
LOOK_RANGE = 2.5
"""Distance [m] up to which a missing object says something."""
SEEN_THROUGH = 0.04
"""How far [m] behind an object's centre the camera must see for the object to be gone. Chosen: above its depth noise
there."""
FLAT, FLAT_THROUGH, LEAST_THROUGH = 0.07, 0.3, 0.01
"""Up to which height [m] an object is flat: what it lay on is hardly farther behind, and it is gone where the camera
sees that share of its height behind its centre, [m] at least."""
FRESH = 20.0
"""For how long [s] an object is new. Chosen: from when the hand begins to move one until all of the place is seen."""
PUSHED, SAME_SIZE = 0.35, 0.025
"""How far [m] what is missing is looked for, and the largest difference of extents [m]. Chosen: what is pulled over an
edge moves by 0.2; the error of extents, twice."""


@dataclass
class Track:
    """One object in one place, with the evidence for its name.

    `seen_at` is the time of the newest evidence, be it the hand's; `looked_at` that of the newest picture of it,
    `began` that of the first [s].
    `clearest`: weight of the best view that has shown it whole.
    """

    id: str
    position: Vec3
    yaw: float
    size: Vec3
    on: str
    seen_at: float
    weight: float
    best: float = 0.0
    clearest: float = 0.0
    whole: bool = False
    scores: dict[tuple[str, str, str], float] = field(default_factory=dict)
    misses: int = 0
    sightings: int = 0
    held: bool = False
    tilt: float = 0.0
    yaw_seen: bool = False
    looked_at: float = -math.inf
    began: float = -math.inf
    label: str = ""
    looks: Descriptor = field(default_factory=lambda: Descriptor((0.0, 0.0, 0.0)))

    @property
    def known(self) -> bool:
        """It is an object of the household."""
        return self.name != UNLISTED

    @property
    def half_width(self) -> float:
        """Half of what it takes up on the floor plan [m]."""
        return (self.size[0] + self.size[1]) / 4

    @property
    def name(self) -> tuple[str, str, str]:
        """Label, kind, colour with the most evidence."""
        return max(self.scores, key=lambda key: (self.scores[key], key))

    @property
    def confidence(self) -> float:
        """Share of the evidence that is for the name, and how much of it there is."""
        best = self.scores[self.name]
        return best / max(sum(self.scores.values()), 1e-9) * (1 - math.exp(-3.0 * best))


class ObjectTracker:
    """What is where, as far as it was seen."""

    def __init__(self, household: Household, gone_after: int, min_confidence: float) -> None:
        self._household, self._gone_after, self._min = household, gone_after, min_confidence
        self._tracks: list[Track] = []
        self._count = 0

    def update(self, view: View, detections: Sequence[Detection], now: float) -> set[str]:
        """Take in what a view shows; ids of the objects that were seen."""
        seen: set[str] = set()
        free = [t for t in self._tracks if not t.held]
        pairs = sorted(
            (apart, n, k)
            for n, d in enumerate(detections)
            for k, t in enumerate(free)
            if (apart := _apart(d, t)) is not None
        )
        matched: dict[int, Track] = {}
        for _, n, k in pairs:
            if n not in matched and free[k].id not in seen:
                matched[n] = free[k]
                seen.add(free[k].id)
        missing = [t for t in free if t.id not in seen and _should_show(t, view)]
        for n, d in enumerate(detections):
            track = matched.get(n) or _moved_here(d, missing)
            if track in missing:
                missing.remove(track)
                seen.add(track.id)
            if track is None:
                self._count += 1
                track = Track(f"object-{self._count}", d.position, d.yaw, d.size, d.on, now, 0.0, tilt=d.tilt)
                track.began = now
                self._tracks.append(track)
                seen.add(track.id)
            _see(track, _turned_over(track, d), now)
        for track in missing:
            track.misses += 1
            fresh = [t for t in self._tracks if t.began > max(track.began, now - FRESH) and t.id in seen]
            heir = _moved_here(track, fresh)
            if heir is not None:
                # It was seen elsewhere before it could be seen that it is gone.
                heir.id, heir.label, heir.began, track.misses = track.id, track.label, track.began, self._gone_after
        self._tracks = [t for t in self._tracks if t.misses < self._gone_after]
        return seen

    def carry(self, hand: Vec3, holding: bool, now: float) -> bool:
        """Follow the hand: what it closes on is held and moves with it until it opens; True when anything is or was."""
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
        # Where the hand let go; the next look says better.
        held.held, held.misses, held.weight, held.seen_at = False, 0, 0.0, now
        held.yaw_seen = False
        surface = self._household.surface_at(*hand)
        held.on, height = (surface.name, surface.center[2]) if surface else ("", 0.0)
        held.position = (hand[0], hand[1], height + held.size[2] / 2)
        return True

    def objects(self, since: float = -math.inf) -> list[WorldObject]:
        """What is believed, one place for each object of the household, the newest that was sure.

        `since`: only what a picture has shown at that robot time [s] or later.
        """
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
            if told and not any(_overlap(track, other) for other in chosen):
                chosen.append(track)
        return [_as_object(t, label) for t, label in _labelled(sorted(chosen, key=_age))]

    def doubtful(self) -> set[str]:
        """Ids of objects that nobody listed and that no view has shown whole and near: they may be something else."""
        return {t.id for t in self._tracks if not t.held and not t.known and t.clearest < DOUBT}

    def report(self, now: float) -> WorldObjects:
        return WorldObjects(t=now, objects=self.objects(), source="perception")


def _age(track: Track) -> int:
    return int(track.id.rpartition("-")[2])


def _alike(d: Detection, track: Track) -> bool:
    """A detection and a track have the same label, or colours in common."""
    if d.known and track.known:
        return d.label == track.name[0]
    total, seen = sum(track.looks.colours.values()), sum(d.colours.values())
    common = sum(min(v / seen, track.looks.colours.get(c, 0.0) / max(total, 1e-9)) for c, v in d.colours.items())
    return common >= ALIKE


def _apart(d: Detection, track: Track) -> float | None:
    """How far [m] a detection is from being a track's object; None when it is another."""
    distance = math.hypot(d.position[0] - track.position[0], d.position[1] - track.position[1])
    if distance < SAME and _alike(d, track):
        return distance
    half = (d.size[0] + d.size[1]) / 4 + track.half_width
    above = abs(d.position[2] - track.position[2]) > (d.size[2] + track.size[2]) / 2
    return distance + UNLIKE if distance < min(SAME, OVERLAP * half) and not above else None


def _one_look(a: Track, b: Track) -> bool:
    """Two tracks of what nobody listed have colours in common."""
    mine, theirs = (shares(t.looks.colours) for t in (a, b))
    return not (a.known or b.known) and sum(min(v, theirs.get(c, 0.0)) for c, v in mine.items()) >= ALIKE


def _moved_here(d: Detection | Track, others: Sequence[Track]) -> Track | None:
    """The nearest of the objects that look the same, and are as large: of those that are not where they were, for what
    is new; of those that are new, for what is not where it was.
    """
    near = []
    for t in others:
        distance = math.hypot(d.position[0] - t.position[0], d.position[1] - t.position[1])
        as_large = all(abs(a - b) < SAME_SIZE for a, b in zip(sorted(d.size), sorted(t.size), strict=True))
        if distance < PUSHED and as_large and (_alike(d, t) if isinstance(d, Detection) else _one_look(d, t)):
            near.append((distance, t.id, t))
    return min(near)[2] if near else None


def _overlap(a: Track, b: Track) -> bool:
    """Two tracks take up the same space: they are one object."""
    distance = math.hypot(a.position[0] - b.position[0], a.position[1] - b.position[1])
    high = (a.size[2] + b.size[2]) / 2
    return distance < OVERLAP * (a.half_width + b.half_width) and abs(a.position[2] - b.position[2]) < 0.8 * high


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


def _turned_over(track: Track, d: Detection) -> Detection:
    """What has an opening and shows a closed upper end stands on its mouth."""
    on_its_mouth = not d.tilt and d.end == "closed" and track.looks.opening >= OPENING
    return replace(d, tilt=math.pi) if on_its_mouth else d


def _see(track: Track, d: Detection, now: float) -> None:
    weight = 1.0 / max(0.2, d.distance) ** 2 * (0.3 if d.confidence < SURE else 1.0)
    weight *= 1.0 if d.whole else PARTIAL * d.share**2
    shift = math.hypot(d.position[0] - track.position[0], d.position[1] - track.position[1])
    key = (d.label, d.kind, d.colour) if d.known else UNLISTED
    fell = abs(d.tilt - track.tilt) > FELL and d.confidence >= LIKELY and (not track.scores or key == track.name)
    if fell:
        # It does not rest as it did: what was known of its pose is of no use.
        track.tilt, track.size, track.whole, track.weight = d.tilt, d.size, d.whole, 0.0
    if shift > MOVED and not d.whole and track.whole:
        # Seen in part it seems to stand elsewhere; only a whole view moves what was seen whole.
        share = 0.0
    elif shift > MOVED or track.weight == 0.0 or weight > track.weight:
        track.whole = d.whole
        track.weight = track.best = weight
        share = 1.0
    else:
        track.weight = min(track.weight + weight, TRUST * track.best)
        share = weight / track.weight
    if d.whole:
        track.clearest = max(track.clearest, weight)
    old, new = np.array(track.position), np.array(d.position)
    x, y, z = (float(v) for v in old + share * (new - old))
    track.position, track.on = (x, y, z), d.on
    # Close looks count more, slivers less, and old mistakes fade.
    evidence = d.confidence * min(2.0, 1.5 / max(0.3, d.distance)) * (1.0 if d.whole else d.share)
    track.looks.add(d, evidence, fell or shift > MOVED)
    guess = track.yaw_seen and not d.yaw_seen and shift <= MOVED
    if fell or (share and weight >= POORER * track.best and not guess):
        track.yaw, track.yaw_seen = d.yaw if d.known else track.looks.turned(d), d.yaw_seen
    elif guess and share and weight >= POORER * track.best and track.tilt and d.tilt:
        # Its axis is seen, which end is the upper one is not: that stays.
        track.yaw += math.remainder(d.yaw - track.yaw, math.pi)
    track.seen_at, track.misses, track.sightings = now, 0, track.sightings + 1
    track.looked_at = now
    track.scores = {k: v * 0.9 for k, v in track.scores.items()}
    track.scores[key] = track.scores.get(key, 0.0) + evidence
    if track.name == key and abs(d.tilt - track.tilt) <= FELL:
        track.size, track.tilt = (d.size if d.known else track.looks.size), d.tilt


def _should_show(track: Track, view: View) -> bool:
    """True when the view looks at the track's place and sees through it."""
    u, v, z = (float(a) for a in view.project(np.array([track.position]))[0])
    h, w = view.shape
    if not (0.3 < z < LOOK_RANGE and EDGE_PIXELS < u < w - EDGE_PIXELS and EDGE_PIXELS < v < h - EDGE_PIXELS):
        return False
    around = view.depth[int(v) - 2 : int(v) + 3, int(u) - 2 : int(u) + 3]
    seen = around[around > 0]
    flat = track.size[2] < FLAT
    through = max(LEAST_THROUGH, FLAT_THROUGH * track.size[2]) if flat else SEEN_THROUGH
    return bool(len(seen) > 12 and float(np.median(seen)) > z + through)


def _as_object(t: Track, label: str) -> WorldObject:
    kind, colour = t.name[1:] if t.known else t.looks.named
    return WorldObject(
        label=label, kind=kind, colour=colour, position=t.position, orientation=yaw_quat(t.yaw), size=t.size, on=t.on,
        confidence=round(t.confidence, 3), seen_at=t.seen_at, held=t.held, id=t.id, tilt=t.tilt, shape=t.looks.shape,
        colours=[colour] if t.known else t.looks.main_colours, kinds=[] if t.known else t.looks.likely_kinds,
        kind_shares={} if t.known else shares(t.looks.kinds), colour_shares={} if t.known else shares(t.looks.colours),
        measured=not t.known, spread=0.0 if t.known else round(t.looks.spread, 4), points=t.looks.packed(t.position),
    )  # fmt: skip
