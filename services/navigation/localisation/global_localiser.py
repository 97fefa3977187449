"""From a pose in doubt, or none, to one that is sure: hypotheses from one scan, weighed by those that follow.

Source: Jensfelt and Kristensen, "Active global localization for a mobile robot using multiple hypothesis tracking",
IEEE Trans. Robotics and Automation 17(5), 2001.
"""

import copy
import math

from common.bus.port import Io, Job
from common.geometry import Array, Pose2
from services.navigation.localisation.distance_field import DistanceField
from services.navigation.localisation.hypotheses import Hypothesis, distinct, hypotheses, plausibility, same
from services.navigation.localisation.localise import Localiser

BAD_FIT = 0.5
"""Share of rays that the map explains [-] below which the pose is in doubt; chosen: people and boxes hide less than
half of the walls. In 134 places of 20 drawn homes with boxes about, the true pose had 0.66 at least, wrong ones 0.43 at
most."""
SUDDEN = 0.6
"""Share of the usual fit below which a scan is a break [-]: the robot was carried away, nobody walked up to it."""
USUAL_GAIN = 0.05
"""Share of a scan in the usual fit [-]: the last two seconds."""
MIN_RAYS = 60
"""Rays without which nothing is looked for [count]: as many as the coarse search uses."""
BREAK, DOUBT, MAX_DOUBT = 0.3, 1.0, 16.0
"""Time of doubt after which the pose is looked for [s]: after a break, otherwise, and what the latter is doubled up to
as long as nothing better is found."""
SURE, MARGIN = 0.45, 0.15
"""Plausibility of a pose that is believed, and by how much it must be above every other [-]. In the 134 places the
true pose had 0.66 at least and was 0.2 above the next."""
UNFIT = 0.35
"""Plausibility that no pose reaches where the map does not fit [-]: above that of wrong poses, of which 98 % have 0.13
at most."""
GIVEN_UP = 0.25
"""A hypothesis that is this much less plausible than the best is dropped [-]."""
MOST = 8
"""Hypotheses that are followed [count]: the computer's time."""
GAIN = 0.2
"""Share of a scan in a hypothesis's plausibility [-]: five scans, half a second."""
AGAIN, MAX_AGAIN = 2.0, 16.0
"""Time after which the whole map is searched again while nothing is sure [s], doubled up to the second."""


class GlobalLocaliser:
    """Tracks hypotheses while the pose is unknown (`lost`); `broken`: the last scan contradicts the pose of before.

    `hypotheses`: where a lost robot may be, the most plausible first.
    """

    def __init__(self, io: Io, field: DistanceField, known: bool) -> None:
        self._io, self._field = io, field
        self._low, self._high = io.household.low, io.household.high
        self._job: Job[list[Hypothesis]] | None = None
        self._asked_at: Pose2 = (0.0, 0.0, 0.0)
        self._good_at, self._doubt_after = -math.inf, DOUBT
        self._usual = 1.0
        self._search_at, self._again = 0.0, AGAIN
        self._kept: Localiser | None = None
        self._searched = False
        self.hypotheses: list[Hypothesis] = []
        self.lost = not known
        self.broken = False

    @property
    def map_fits(self) -> bool:
        """False when the whole map was searched and no pose explains what the lost robot sees."""
        return not self._searched or (bool(self.hypotheses) and self.hypotheses[0].score >= UNFIT)

    @property
    def searching(self) -> bool:
        """True while the worker searches the whole map."""
        return self._job is not None

    def watch(self, localiser: Localiser, points: Array, now: float) -> bool:
        """Decide whether the pose has been lost; call once per scan (n, 2) [base] while it is known."""
        fit, limit = localiser.fit, BAD_FIT
        broken = self.broken = fit < SUDDEN * self._usual
        if fit > limit and not broken:
            self._usual += USUAL_GAIN * (fit - self._usual)
            self._good_at, self._doubt_after = now, DOUBT
            return False
        if self._good_at == -math.inf and len(points) <= MIN_RAYS:
            self._good_at = now
        patience = min(BREAK, self._doubt_after) if broken and self._doubt_after == DOUBT else self._doubt_after
        if now - self._good_at > patience and len(points) > MIN_RAYS:
            self._io.log.warning("lost", fit=round(fit, 2), usual=round(self._usual, 2))
            self.lost, self._kept, self.hypotheses = True, copy.copy(localiser), []
            self._search_at, self._again, self._searched = now, AGAIN, False
        return self.lost

    def step(self, points: Array, odometry: Pose2, elapsed: float, now: float) -> Pose2 | None:
        """The pose [map] as soon as it is sure, else None; call once per scan (n, 2) [base] while the robot is lost."""
        if self._kept is not None:
            self._kept.predict(odometry, elapsed)
        for one in self.hypotheses:
            one.localiser.predict(odometry, elapsed)
            one.localiser.correct(points)
            one.score += GAIN * (plausibility(self._field, one.pose, points) - one.score)
        if self._job is not None:
            if self._job.poll(now):
                self._take(self._job.result(), points, odometry)
                self._job, self._searched = None, True
        elif now >= self._search_at and len(points) > MIN_RAYS:
            self._asked_at = odometry
            self._job = self._io.submit(hypotheses, self._field, points, self._low, self._high, seconds=0.3)
            self._search_at, self._again = now + self._again, min(2 * self._again, MAX_AGAIN)
        self._weed()
        return self._decide(now)

    def _take(self, found: list[Hypothesis], points: Array, odometry: Pose2) -> None:
        """Hypotheses from a scan of a while ago join those that are followed."""
        for one in found[:MOST]:
            one.localiser.anchor(self._asked_at)
            one.localiser.predict(odometry, math.inf)
        if self._kept is not None:
            found.append(Hypothesis(copy.copy(self._kept), plausibility(self._field, self._kept.pose, points)))
        self.hypotheses = distinct(self.hypotheses + found)

    def _weed(self) -> None:
        """Drop what is much less plausible than the best, and what has run into the same pose."""
        if self.hypotheses:
            found = distinct(self.hypotheses)
            self.hypotheses = [h for h in found if h.score > found[0].score - GIVEN_UP][:MOST]

    def _decide(self, now: float) -> Pose2 | None:
        if self._job is not None or not self.hypotheses:
            return None
        best, *others = self.hypotheses
        ahead = best.score - (others[0].score if others else -1.0)
        if best.score >= SURE and ahead >= MARGIN:
            self._io.log.warning("localised anew", score=round(best.score, 2), ahead=round(ahead, 2))
            return self._found(best, now, DOUBT)
        if self._kept is not None:
            # Crowded in: where it was is as plausible as anything else, and nothing speaks against it.
            pose = self._kept.pose
            kept = next((h for h in self.hypotheses if same(h.pose, pose)), None)
            if kept is not None and kept.score > best.score - MARGIN:
                return self._found(kept, now, min(2 * self._doubt_after, MAX_DOUBT))
        return None

    def _found(self, one: Hypothesis, now: float, doubt_after: float) -> Pose2:
        self.lost, self.broken, self.hypotheses, self._kept = False, False, [], None
        self._good_at, self._doubt_after = now, doubt_after
        self._usual = one.localiser.fit
        return one.pose
