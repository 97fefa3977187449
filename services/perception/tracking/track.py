"""One object in one place: its evidence over time, and what a detection adds to it. Pure."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from common.floor_plan import Vec3
from common.geometry import Array
from services.perception.detection import Detection
from services.perception.tracking.descriptor import Descriptor
from services.perception.tracking.registration import shift
from services.perception.views.view import View

UNLISTED = ("", "", "")
"""Stands for the name of an object that was not listed, in the evidence for names."""
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
SURE = 0.55
"""Confidence from which a detection's name, and with it its position, counts in full."""
TRUST = 4.0
"""Weight of a track's position, in best sightings, beyond which further ones no longer add to it."""
PARTIAL = 0.1
"""Weight of a sighting of a part, of that of the whole; times the squared share that was seen."""
MOUNTED, TURNED = 0.0017, math.radians(0.17)
"""Standard deviations of where a camera sits along an axis [m] and of how it is turned about one [rad]: a bracket that
is up to 3 mm and 0.3 degrees off its drawing. Neither camera knows better than that where a thing is."""
NEAREST = 0.2
"""Distance [m] from which on a nearer view says no more: the least range of a stereo camera."""
POORER = 0.5
"""Weight of a sighting, of the best one, from which it may still turn the object, and have it elsewhere though its
place is not seen to be empty."""


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


def see(track: Track, detection: Detection, now: float, left: bool = True) -> None:
    """Take in a detection of the track's object at robot time `now` [s]; `left`: its place is seen to be empty."""
    d = _turned_over(track, detection)
    weight = weight_from(d.distance) * (0.3 if d.confidence < SURE else 1.0)
    weight *= 1.0 if d.whole else PARTIAL * d.share**2
    shift = math.hypot(d.position[0] - track.position[0], d.position[1] - track.position[1])
    if shift > MOVED and not left and weight < POORER * track.best:
        # Something still stands where a better view has shown it: this one has measured badly.
        track.looked_at = track.seen_at = now
        track.misses = 0
        return
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
    was, new = track.position, np.array(d.position)
    x, y, z = (float(v) for v in was + share * (new - was))
    track.position, track.on = (x, y, z), d.on
    # Close looks count more, slivers less, and old mistakes fade.
    evidence = d.confidence * min(2.0, 1.5 / max(0.3, d.distance)) * (1.0 if d.whole else d.share)
    track.looks.add(d, evidence, fell or shift > MOVED, was, track.position)
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


def shown(track: Track, view: View, detections: Sequence[Detection]) -> list[tuple[Array, Detection]]:
    """What a near view shows of an object that nobody listed, with how far (3,) [m] that is from where it is believed
    to be, the nearest first."""
    if track.known:
        return []
    believed, reach = track.looks.points + np.array(track.position), max(track.size) / 2 + MOVED
    near = [d for d in detections if not d.known and math.dist(d.position, track.position) < reach]
    found = [(by, d) for d in near if (by := shift(believed, d.points, view)) is not None]
    return sorted(found, key=lambda one: float(np.linalg.norm(one[0])))


def several(track: Track, found: Sequence[tuple[Array, Detection]]) -> list[Detection]:
    """The things of which a near view shows that what was taken for one without a shape is; empty where it is one."""
    shaped = [d for _, d in found if d.shape != "irregular"]
    return shaped if track.looks.shape == "irregular" and len(shaped) > 1 else []


def aim(track: Track, by: Array, d: Detection, now: float) -> None:
    """Take from a near view at `now` [s] where an object is, by whatever part of it that shows, and nothing else."""
    x, y, z = track.position
    was, new = mount_error(track.looks.nearest), mount_error(d.distance)
    share = 1.0 / (1.0 + (new / was) ** 2)
    track.position = x + share * float(by[0]), y + share * float(by[1]), z
    # How high it is is told by what it stands on.
    track.looks.points = np.add(track.looks.points, (0.0, 0.0, by[2]))
    track.weight = track.best = max(track.weight, weight_from(d.distance))
    track.seen_at = track.looked_at = now
    track.misses, track.sightings = 0, track.sightings + 1


def mount_error(distance: float) -> float:
    """Standard deviation [m], along an axis, of where a camera sees what is so far away [m]."""
    return math.hypot(MOUNTED, TURNED * distance)


def weight_from(distance: float) -> float:
    """What a whole view from that distance [m] says of where an object is."""
    return float(1.0 / max(NEAREST, distance) ** 2)


def _turned_over(track: Track, d: Detection) -> Detection:
    """What has an opening and shows a closed upper end stands on its mouth."""
    on_its_mouth = not d.tilt and d.end == "closed" and track.looks.opening >= OPENING
    return replace(d, tilt=math.pi) if on_its_mouth else d
