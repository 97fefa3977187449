"""Kinds by their looks: ranges of measures for each, and the probability of each kind for a measured object. Pure.

The ranges are those of household goods, not of one home: what lies within them is equally likely, what lies outside
less and less. Several kinds may be about as likely; whoever grounds words decides among them by the words.
"""

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass

from common.messages import ShapeFamily

Range = tuple[float, float]
ANY: Range = (0.0, math.inf)
OUTSIDE = 0.14
"""Standard deviation, as a share, of a measure outside its range. Chosen: 30 % outside is a tenth as likely."""
OTHER_FAMILY = 0.02
"""Likelihood of a shape family that a kind does not have: the fit may have been taken in."""
OTHER, LIKE_NONE = "thing", 0.6
"""What is called so is as likely as the likeliest kind when its extents are so much like that kind's or less: a pear
is no bottle though it has a neck. Chosen: 14 % outside one range."""
LEAST = 0.2
"""Likelihood, of the best kind's, from which a kind may be meant by its word."""


@dataclass(frozen=True)
class Measures:
    """What was measured of an object in its own frame: of round shapes `across` is the diameter, `along` the axis.

    Of others `along` is the longest extent, `across` the shortest [m]; `middle`: the third by the shortest [-].
    `hollow`: open above; `neck`: much narrower at the upper end; `handle`: one was seen. `error` [m]: of the extents.
    """

    family: ShapeFamily
    across: float
    along: float
    middle: float = 1.0
    hollow: bool = False
    neck: bool = False
    handle: bool = False
    error: float = 0.0


@dataclass(frozen=True)
class Look:
    """Ranges of a kind's measures. `families`: likelihood of each; pairs: likelihood when it was seen, and when not.

    `slim`: `along` by `across`, `oblong`: by the third extent [-]; `colours`: words of which one must be seen, none for
    any; `share`: how common.
    """

    families: Mapping[ShapeFamily, float]
    across: Range
    along: Range
    slim: Range = ANY
    middle: Range = ANY
    oblong: Range = ANY
    hollow: tuple[float, float] = (0.05, 1.0)
    neck: tuple[float, float] = (0.05, 1.0)
    handle: tuple[float, float] = (0.1, 1.0)
    colours: frozenset[str] = frozenset()
    share: float = 1.0

    def likelihood(self, m: Measures, colours: Collection[str]) -> float:
        """How likely a kind with these ranges has such measures and colours, 0 to 1."""
        found = self.share * self.families.get(m.family, OTHER_FAMILY) * self.fit(m)
        for seen, pair in ((m.hollow, self.hollow), (m.neck, self.neck), (m.handle, self.handle)):
            found *= pair[0] if seen else pair[1]
        if self.colours and not self.colours & set(colours):
            found *= 0.05
        return found

    def fit(self, m: Measures) -> float:
        """How likely such extents are of this kind, 0 to 1; 1 within its ranges."""
        doubt = m.error / max(m.across, 0.01)
        found = 1.0
        for measured, usual in ((m.across, self.across), (m.along, self.along), (m.along / m.across, self.slim)):
            found *= _within(measured, usual, OUTSIDE + doubt)
        if m.family != "box":
            return found
        oblong = m.along / (m.across * m.middle)
        return found * _within(m.middle, self.middle, OUTSIDE + doubt) * _within(oblong, self.oblong, OUTSIDE + doubt)


def _within(value: float, usual: Range, deviation: float) -> float:
    low, high = usual
    beyond = math.log(low / value) if value < low else math.log(value / high) if value > high else 0.0
    return math.exp(-0.5 * (beyond / deviation) ** 2)


def likely(looks: Mapping[str, Look], m: Measures, colours: Collection[str]) -> dict[str, float]:
    """Probability of each kind that a measured object may be, the likeliest first; empty if it fits none.

    `OTHER` is the first where its extents are none that the likeliest kind has.
    """
    found = {name: look.likelihood(m, colours) for name, look in looks.items()}
    best = max(found.values(), default=0.0)
    if best < 1e-4:
        return {}
    likeliest = max(found, key=lambda name: found[name])
    if looks[likeliest].fit(m) < LIKE_NONE:
        found = {OTHER: 1.01 * best, **found}
    kept = {name: value for name, value in found.items() if value >= LEAST * best}
    total = sum(kept.values())
    return {name: value / total for name, value in sorted(kept.items(), key=lambda item: -item[1])}
