"""Publishes the status of the newest goal, and feedback while it is under way."""

import math

from common import messages as m
from common import topics
from common.bus.port import Io
from services.navigation.localisation.state_estimation import StateEstimator
from services.navigation.motion.navigator import Navigator

FEEDBACK_PERIOD = 1.0
"""Time between two feedbacks without news [s]; chosen: often enough for a person who watches."""


class Reports:
    """Publishes `status` of the newest goal, and feedback; goals that came on `nav_goal` get feedback alone."""

    def __init__(self, io: Io, state: StateEstimator) -> None:
        self._io, self._state = io, state
        self._in_words = True
        self._recoveries = 0
        self._shown, self._feedback_at = (0, ""), -math.inf
        self.status = m.NavigationStatus(status="idle")
        io.publish(topics.NAVIGATION_STATUS, self.status)

    def begin(self, goal: m.NavigationGoal | m.NavGoal) -> None:
        """Begin to report on a goal that has just arrived."""
        self._in_words, self._recoveries = isinstance(goal, m.NavigationGoal), 0
        self.status = m.NavigationStatus(status="navigating", goal_id=goal.id, attempt=goal.attempt)

    def begin_leg(self) -> None:
        """Begin to report on another navigator that works for the same goal."""
        self._shown, self._feedback_at = (0, ""), -math.inf

    def end_leg(self, navigator: Navigator | None) -> None:
        """Add a navigator's recoveries to those of the goal: its part is done."""
        self._recoveries += navigator.recoveries if navigator else 0

    def tell(self, status: m.NavStatus, code: str, detail: str, navigator: Navigator | None) -> None:
        """Publish a new status of the newest goal."""
        self.status = m.NavigationStatus(
            status=status, goal_id=self.status.goal_id, attempt=self.status.attempt, code=code, detail=detail
        )
        self.publish(self.status, navigator)

    def publish(self, status: m.NavigationStatus, navigator: Navigator | None) -> None:
        """Publish a status, with feedback."""
        if self._in_words:
            self._io.publish(topics.NAVIGATION_STATUS, status)
        self.feedback(navigator)

    def under_way(self, navigator: Navigator, path: bool, now: float) -> None:
        """Publish feedback when something has changed, and every FEEDBACK_PERIOD."""
        shown = (navigator.recoveries, navigator.doing)
        if shown != self._shown:
            self._shown = shown
            self._io.log.info("under way", doing=navigator.doing or "driving", recoveries=navigator.recoveries)
            self.feedback(navigator)
        elif path:
            self.feedback(navigator)
        elif now - self._feedback_at >= FEEDBACK_PERIOD:
            self._feedback_at = now
            self.feedback(navigator)

    def feedback(self, navigator: Navigator | None, doing: str = "") -> None:
        """Publish feedback; `doing`: what holds the goal up, taken from the navigator where it is ""."""
        status = self.status
        feedback = m.NavigationFeedback(
            goal_id=status.goal_id,
            status=status.status,
            distance_remaining=navigator.remaining if navigator else 0.0,
            eta=navigator.eta if navigator else 0.0,
            recoveries=self._recoveries + (navigator.recoveries if navigator else 0),
            code=status.code or doing or (navigator.doing if navigator else ""),
            attempt=status.attempt,
            detail=status.detail,
            map_fit=round(self._state.map_fit.share, 3),
            met=list(navigator.met) if navigator and navigator.met else [],
        )
        self._io.publish(topics.NAVIGATION_FEEDBACK, feedback)
