"""Which detection belongs to which track, which tracks are one object, and which should have been seen. Pure."""

import math
from collections.abc import Sequence

import numpy as np

from common.approach import FOOTPRINT
from common.geometry import Pose2
from common.kinds import kind_of
from common.messages import WorldObject
from services.perception.detection import Detection
from services.perception.tracking.descriptor import shares
from services.perception.tracking.track import SURE, Track
from services.perception.views.view import View

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
PUSHED, SAME_SIZE = 0.35, 0.025
"""How far [m] what is missing is looked for, and the largest difference of extents [m]. Chosen: what is pulled over an
edge moves by 0.2; the error of extents, twice."""

REFINED = 0.05
"""Most [m] that the wrist camera's sighting may be off the believed position of the object that it refines. Chosen:
less than the distance to a neighbour."""


def refines(d: Detection, believed: Sequence[WorldObject]) -> bool:
    """Whether the wrist camera may say where a listed object is more exactly: of round ones by any part of them."""
    near = [o for o in believed if math.dist(o.position, d.position) < REFINED and not o.held]
    whole = kind_of(d.kind).straight or (d.whole and d.confidence >= SURE)
    return whole and any(o.label == d.label for o in near)


def lies_on_base(d: Detection, base: Pose2) -> bool:
    """What seems to be on the floor where the robot's base stands lies on that, and goes where it goes."""
    return not d.on and math.dist(d.position[:2], base[:2]) < FOOTPRINT


def separation(d: Detection, track: Track) -> float | None:
    """How far [m] a detection is from being a track's object; None when it is another."""
    distance = math.hypot(d.position[0] - track.position[0], d.position[1] - track.position[1])
    if distance < SAME and _alike(d, track):
        return distance
    half = (d.size[0] + d.size[1]) / 4 + track.half_width
    above = abs(d.position[2] - track.position[2]) > (d.size[2] + track.size[2]) / 2
    return distance + UNLIKE if distance < min(SAME, OVERLAP * half) and not above else None


def overlap(a: Track, b: Track) -> bool:
    """Two tracks take up the same space: they are one object."""
    distance = math.hypot(a.position[0] - b.position[0], a.position[1] - b.position[1])
    high = (a.size[2] + b.size[2]) / 2
    return distance < OVERLAP * (a.half_width + b.half_width) and abs(a.position[2] - b.position[2]) < 0.8 * high


def moved_here(
    d: Detection | Track, others: Sequence[Track], reach: float = PUSHED, turned: float = 0.0
) -> Track | None:
    """The nearest of the objects that look the same, and are as large: of those that are not where they were, for what
    is new; of those that are new, for what is not where it was. None farther than `reach` [m] is, and none whose
    extents differ by more than SAME_SIZE or that share which another side of it may be off, `turned`.
    """
    near = []
    for t in others:
        distance = math.hypot(d.position[0] - t.position[0], d.position[1] - t.position[1])
        pairs = zip(sorted(d.size), sorted(t.size), strict=True)
        as_large = all(abs(a - b) < max(SAME_SIZE, turned * max(a, b)) for a, b in pairs)
        if distance < reach and as_large and (_alike(d, t) if isinstance(d, Detection) else _one_look(d, t)):
            near.append((distance, t.id, t))
    return min(near)[2] if near else None


def _alike(d: Detection, track: Track) -> bool:
    """A detection and a track have the same label, or colours in common."""
    if d.known and track.known:
        return d.label == track.name[0]
    total, seen = sum(track.looks.colours.values()), sum(d.colours.values())
    common = sum(min(v / seen, track.looks.colours.get(c, 0.0) / max(total, 1e-9)) for c, v in d.colours.items())
    return common >= ALIKE


def _one_look(a: Track, b: Track) -> bool:
    """Two tracks of what nobody listed have colours in common."""
    mine, theirs = (shares(t.looks.colours) for t in (a, b))
    return not (a.known or b.known) and sum(min(v, theirs.get(c, 0.0)) for c, v in mine.items()) >= ALIKE


def should_show(track: Track, view: View) -> bool:
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
