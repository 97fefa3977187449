"""The course of an exploration: look around, drive to the next view, look, until nothing is left; then home. Pure."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from common import messages as m
from common.geometry import Pose2, wrap
from services.mapping.config import MappingConfig
from services.mapping.views import Survey

FIRST_LOOKS = 8
"""Headings of the first look around [count]: the camera sees 77 degrees."""
PATIENCE = 3.0
"""Time [s] that pictures of a view may take; after it the view counts as seen."""
EMPTY = 2
"""Surveys in a row that must find nothing before the exploration ends [count]."""

Wanted = Literal["", "picture", "survey", "save"] | m.NavGoal
State = Literal["choose", "driving", "settling", "looking", "surveying", "saving", "over"]
NOTHING_KNOWN = Survey(frontiers=0, area=0.0, view=None)


@dataclass
class Drive:
    """A goal of navigation; `ended` is its final status, "" until then."""

    goal: m.NavGoal
    ended: str = ""


class Exploration:
    """State machine of an exploration: `step` gives the next action, `take_feedback` and `take_survey` its outcome."""

    def __init__(self, config: MappingConfig, new_id: Callable[[str], str]) -> None:
        self._config, self._new_id = config, new_id
        self.phase: m.MappingPhase = "exploring"
        self.barred: list[tuple[float, float]] = []
        self.pictures = 0
        self.detail = ""
        self._state: State = "choose"
        self._drive: Drive | None = None
        self._since = 0.0
        self._turns: list[float] | None = None
        self._survey = NOTHING_KNOWN
        self._surveyed = False
        self._empty = 0
        self._tried_again = False

    @property
    def frontiers(self) -> int:
        """Number of places still to be looked at that can be reached, by the newest survey."""
        return self._survey.frontiers

    @property
    def area(self) -> float:
        """Area of known floor [m2], by the newest survey."""
        return self._survey.area

    @property
    def driving(self) -> bool:
        """True while a goal of navigation is under way."""
        return self._state == "driving"

    def finish(self) -> None:
        """End the exploration: drive home and save."""
        if self.phase == "exploring":
            self.phase = "returning"

    def take_feedback(self, feedback: m.NavigationFeedback, now: float) -> None:
        """Take navigation's feedback."""
        drive = self._drive
        if drive is not None and feedback.goal_id == drive.goal.id and feedback.status in ("arrived", "failed"):
            drive.ended = feedback.status
            self.detail = f"{feedback.code} {feedback.detail}".strip() if feedback.status == "failed" else ""

    def take_survey(self, survey: Survey) -> None:
        """Take the result of a survey."""
        self._survey, self._surveyed = survey, True

    def step(self, pose: Pose2, now: float, busy: bool) -> Wanted:
        """The next action, with the robot at `pose` [map]; `busy`: the worker has not taken in all measurements yet."""
        if self._state == "driving":
            return self._watch_drive(now)
        if self._state == "settling":
            if now - self._since >= self._config.settle:
                self._state, self._since, self.pictures = "looking", now, 0
            return ""
        if self._state == "looking":
            if self.pictures >= self._config.view_pictures or now - self._since > PATIENCE:
                self._state = "choose"
                return ""
            return "picture"
        if busy or self._state == "over":
            return ""
        if self._state == "surveying":
            return self._choose(pose, now)
        if self._state == "saving":
            self._state = "over"
            return ""
        return self._next(pose, now)

    def _next(self, pose: Pose2, now: float) -> Wanted:
        if self._turns is None:
            self._turns = [wrap(pose[2] + 2 * math.pi * k / FIRST_LOOKS) for k in range(FIRST_LOOKS)]
        if self.phase == "returning":
            if math.hypot(pose[0], pose[1]) < 0.15 or self._empty > 50:
                return self._end()
            self._empty = 51
            return self._go((0.0, 0.0, 0.0), now)
        if self._turns:
            heading = self._turns.pop(0)
            if len(self._turns) == FIRST_LOOKS - 1:
                self._state, self._since = "settling", now
                return ""
            return self._go((pose[0], pose[1], heading), now)
        self._state, self._surveyed = "surveying", False
        return "survey"

    def _choose(self, pose: Pose2, now: float) -> Wanted:
        if not self._surveyed:
            return ""
        view = self._survey.view
        if view is None:
            self._empty += 1
            self._state = "choose"
            if self._empty >= EMPTY:
                # Where a way was blocked for a while there may be one now.
                if self.barred and not self._tried_again:
                    self.barred, self._tried_again = [], True
                else:
                    self.phase = "returning"
            return ""
        self._empty = 0
        return self._go(view.pose, now)

    def _go(self, pose: Pose2, now: float) -> m.NavGoal:
        self._drive = Drive(m.NavGoal(x=pose[0], y=pose[1], theta=pose[2], id=self._new_id("mapping")))
        self._state, self._since = "driving", now
        return self._drive.goal

    def _watch_drive(self, now: float) -> Wanted:
        drive = self._drive
        assert drive is not None
        if not drive.ended and now - self._since < self._config.goal_timeout:
            return ""
        if drive.ended != "arrived":
            self.barred.append((drive.goal.x, drive.goal.y))
        self._state, self._since = "settling", now
        return ""

    def _end(self) -> Wanted:
        self.phase, self._state = "saving", "saving"
        return "save"
