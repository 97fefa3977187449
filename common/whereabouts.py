"""Where a thing usually is: an estimate from what was seen over the days. Pure.

The share of each surface is the mean of a Dirichlet distribution with three levels: visits on which the thing itself
was seen there, over those on which others of its kind were, over what is known without having seen any: how much room
there is, and where things of the kind belong. Older visits count less. (Gelman et al., Bayesian Data Analysis, ch. 5.)
"""

import math
from collections.abc import Mapping, Sequence

import numpy as np

from common.floor_plan import Receptacle
from common.furniture_tops import seats
from common.geometry import Array, Mask
from common.household import Household
from common.messages import Sighting
from common.naming.names import normalise
from common.viewpoints import Viewpoints

HALF_LIFE = 30 * 86400.0
"""Time [s] after which a visit counts half; chosen: habits of a household change over weeks."""
STAYS = 86400.0
"""Time [s] after which it is half as likely that a thing is still where it was seen last; chosen: a day."""
LAST = 0.25
"""Share of the place where a thing was seen just now, beside where it usually is; chosen: a search begins because it
was not found there, or because somebody came by."""
OF_ITS_KIND = 2.0
"""Visits that others of its kind count as, for a thing [count]; chosen: two own sightings weigh as much."""
UNSEEN = 3.0
"""Visits that room and rules count as, for a kind [count]; chosen."""
BELONGS = 2.0
"""How much likelier a thing is on a surface where its kind belongs, per area [-]; chosen."""
LEAST = 0.15
"""Least likelihood of a point, of the mean one [-]: what nobody expects is looked at late, not never."""


def decayed(s: Sighting, now: float) -> float:
    """The number of visits of a sighting, decayed with their age."""
    return float(s.weight * 0.5 ** (max(0.0, now - s.last) / HALF_LIFE))


def of_thing(phrase: str, sightings: Sequence[Sighting]) -> list[Sighting]:
    """The sightings of the thing that a phrase names: those with all of its words, as they stand or in the singular."""
    wanted = set(normalise(phrase).split())
    found = [s for s in sightings if wanted and wanted <= {*s.thing.split(), s.kind, s.colour}]
    if not found and phrase.endswith("s"):
        return of_thing(phrase[:-1], sightings)
    return found


def kind_of_phrase(phrase: str, household: Household, sightings: Sequence[Sighting]) -> str:
    """The kind that a phrase names or that the thing was seen to have; "" if nobody knows."""
    words = household.words
    for word in reversed(normalise(phrase).split()):
        if kind := words.kind(word) or words.kind(word.removesuffix("s")):
            return kind
    seen = [s.kind for s in of_thing(phrase, sightings) if s.kind]
    return max(set(seen), key=seen.count) if seen else ""


def shares(phrase: str, household: Household, sightings: Sequence[Sighting], now: float) -> dict[str, float]:
    """Probability that the thing is on each surface, by the surface's name; they add up to 1."""
    surfaces = [r for r in household.receptacles if r.kind != "bin"]
    if not surfaces:
        return {}
    kind = kind_of_phrase(phrase, household, sightings)
    own = of_thing(phrase, sightings)
    kin = [s for s in sightings if kind and s.kind == kind and s not in own]
    prior = _prior(kind, household, surfaces)
    of_kind = _mean(_counts(kin, household, surfaces, now), prior, UNSEEN)
    usual = _mean(_counts(own, household, surfaces, now), of_kind, OF_ITS_KIND)
    latest = max(own, key=lambda s: s.last, default=None)
    last = household.receptacle(latest.part) if latest is not None and latest.part else None
    if latest is not None and last in surfaces:
        still = LAST * 0.5 ** (max(0.0, now - latest.last) / STAYS)
        usual *= 1 - still
        usual[surfaces.index(last)] += still
    return {r.name: float(share) for r, share in zip(surfaces, usual, strict=True)}


def likelihood(
    phrase: str, household: Household, sightings: Sequence[Sighting], now: float, viewpoints: Viewpoints
) -> Array:
    """Likelihood (p,) of the thing at each point of a search, of mean 1."""
    found = shares(phrase, household, sightings, now)
    return spread(found, household, viewpoints)


def spread(found: Mapping[str, float], household: Household, viewpoints: Viewpoints) -> Array:
    """Likelihood (p,) of each point of a search from the probability of its surface: at least LEAST, of mean about 1.

    On sofas and beds, which have no share, it is LEAST.
    """
    likely = np.full(len(viewpoints.points), LEAST)
    surfaces = [r for r in household.receptacles if r.kind != "bin"]
    count = int(viewpoints.listed.sum())
    for n, r in enumerate(surfaces):
        of_it = viewpoints.surface == n
        if of_it.any():
            likely[of_it] = max(LEAST, found.get(r.name, 0.0) * count / int(of_it.sum()))
    return likely


def points_at(place: str, household: Household, viewpoints: Viewpoints) -> Mask:
    """Which of a search's points (p,) are on the surface or seat of that name, or in the room."""
    surfaces = [*(r for r in household.receptacles if r.kind != "bin"), *seats(household)]
    rooms = (household.room_at(*r.center[:2]) for r in surfaces)
    there = [
        r.name == place or (room is not None and room.name == place) for r, room in zip(surfaces, rooms, strict=True)
    ]
    return np.array(there, bool)[viewpoints.surface]


def _prior(kind: str, household: Household, surfaces: Sequence[Receptacle]) -> Array:
    """Weights of surfaces before any sighting: by room for things, and by where the kind is put away."""
    rule = next((d for d in household.words.tidy if not d.names and not d.colours and kind in d.kinds), None)
    # A small surface is as good for putting things down: the root of its area.
    weights = np.array([math.sqrt(r.size[0] * r.size[1]) for r in surfaces])
    if kind and rule is not None:
        goes = {r.name for to in rule.to if (r := household.receptacle(to)) is not None} | set(rule.to)
        weights *= [BELONGS if r.name in goes or r.kind in goes else 1.0 for r in surfaces]
    total: Array = weights / weights.sum()
    return total


def _counts(found: Sequence[Sighting], household: Household, surfaces: Sequence[Receptacle], now: float) -> Array:
    counts = np.zeros(len(surfaces))
    number = {r.name: n for n, r in enumerate(surfaces)}
    for s in found:
        r = household.receptacle(s.part) if s.part else None
        if r is not None and r.name in number:
            counts[number[r.name]] += decayed(s, now)
    return counts


def _mean(counts: Array, prior: Array, strength: float) -> Array:
    mean: Array = (counts + strength * prior) / (counts.sum() + strength)
    return mean


def ago(seconds: float) -> str:
    """`2 hours ago`, as people say it."""
    for name, length, upto in (("minute", 60.0, 60), ("hour", 3600.0, 24), ("day", 86400.0, 14)):
        number = math.floor(seconds / length + 0.5)
        if seconds < 90 and name == "minute":
            return "just now"
        if number < upto:
            return f"{number} {name}{'s' if number != 1 else ''} ago"
    return f"{math.floor(seconds / (7 * 86400) + 0.5)} weeks ago"
