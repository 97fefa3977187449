"""The clocks of a goal: its time limit, time without progress, time that its path is blocked, meetings with people."""

import math
from collections.abc import Sequence

from common.geometry import Point
from services.navigation.config import NavigationConfig
from services.navigation.ended import Ended
from services.navigation.motion.obstacle_tracker import Obstacle

PERSON = "PERSON_IN_WAY"
"""What navigation does, and why it fails, where people are all that keeps it from getting on."""
TICK = 0.1
"""Longest time between two steps that are one wait [s]: two periods."""
STEP = 0.05
"""What counts as progress [m]; chosen: more than the play of the pose estimate."""
NEAR = 3.0
"""Who is within this of the robot may be what blocks the path [m]: as far as collision avoidance looks."""
CLOSE = 1.5
"""Who is within this of the robot that waits is asked to let it pass [m]; chosen: a doorway and a step."""
PASSING = 60.0
"""Time that a goal waits for people before its waiting counts again [s]; chosen: two who talk in a door have been asked
several times by then. Who stays is reported as PERSON_IN_WAY."""
PASSING_BY = 20.0
"""The same of a goal that is one of several, as the views of a search are [s]; chosen: one crosses a room by then."""
HELD_UP = 90.0
"""By how much people put off the time limit of a goal at most [s]: both kinds of waiting and the ways aside."""
STANDOFF, LATER, MEETINGS = 2.5, 8.0, 3
"""Time [s] after which a person who stands before the waiting robot is given room, and the time after so many meetings
of one goal [count]; chosen: who comes again and again has no other way. From then on a robot that has none either
stands its ground as somebody comes, as people in a narrow place do, and goes on behind who turns round."""


class Progress:
    """Time limit and progress of one goal; `deadline` is the robot time [s] at which it fails, inf before it is set."""

    def __init__(self, config: NavigationConfig, now: float) -> None:
        self._config, self._started = config, now
        self.deadline = math.inf
        self._best, self._best_at = math.inf, now
        self._held_up, self._held_at = 0.0, now

    def check(self, now: float) -> None:
        """Check the time limit; raises `Ended` TIMEOUT after it."""
        if now > self.deadline:
            raise Ended("failed", "TIMEOUT", f"not there after {now - self._started:.0f} s")

    def extend(self, now: float) -> None:
        """Extend the time limit, by HELD_UP at most; call in each step in which people keep the robot waiting."""
        self._best_at = now
        lost = min(now - self._held_at, TICK)
        self._held_at = now
        if self._held_up < HELD_UP:
            self._held_up += lost
            self.deadline += lost

    def set_limit(self, seconds: float, now: float) -> None:
        """Set the time limit of a goal for which there is no path."""
        self.deadline = now + seconds

    def begin_path(self, length: float, now: float) -> None:
        """Begin a path of `length` [m]: the time limit is put off until it can be driven, never brought forward."""
        self._best, self._best_at = length, now
        limit = now + length / self._config.min_average_speed + self._config.timeout_margin
        self.deadline = max(limit, self.deadline if math.isfinite(self.deadline) else 0.0)

    def advanced(self, remaining: float, now: float) -> bool:
        """True when less path remains [m] than at any time before; notes it as progress."""
        if remaining >= self._best - STEP:
            return False
        self._best, self._best_at = remaining, now
        return True

    def restart_clock(self, now: float) -> None:
        """Count the time without progress from now on: there was a known reason for it."""
        self._best_at = now

    def restart(self, now: float) -> None:
        """Forget the progress so far, as for another path."""
        self._best, self._best_at = math.inf, now

    def stuck(self, now: float) -> bool:
        """True when there has been no progress for longer than `navigation.no_progress`."""
        return now - self._best_at > self._config.no_progress


class BlockedTimer:
    """Measures how long a path has been blocked, less `patience` seconds in which people may be passing by."""

    def __init__(self, patience: float = PASSING) -> None:
        self._since: float | None = None
        self._at = 0.0
        self._left = patience

    def blocked(self, by_people: bool, now: float) -> float:
        """How long the path has been blocked [s]; call in each step while it is."""
        if self._since is None:
            self._since = self._at = now
        elif self._left > 0.0 and by_people:
            self._left -= now - self._at
            self._since += now - self._at
        self._at = now
        return now - self._since

    def clear(self) -> None:
        """Start anew: the path is free, or another one is tried."""
        self._since = None


def anybody_near(here: Point, people: Sequence[Obstacle]) -> bool:
    """True when somebody is within NEAR of the robot, and so may be what blocks the path."""
    return any(math.dist((o.x, o.y), here) < NEAR + o.radius for o in people)


def waiting_for(here: Point, people: Sequence[Obstacle], by_people: bool = False) -> str:
    """What is reported of a robot at `here` that cannot go on: PERSON_IN_WAY with somebody within CLOSE, else WAITING.

    `by_people`: they are known to be all that blocks its way, near or not.
    """
    near = any(math.dist((o.x, o.y), here) < CLOSE + o.radius for o in people)
    return PERSON if near or by_people else "WAITING"


class Standoff:
    """Detects that a person and the robot wait for each other, and counts how often they have met."""

    def __init__(self) -> None:
        self._since = self._at = -math.inf
        self._met, self._met_at = 0, -math.inf

    @property
    def again(self) -> bool:
        """True when they have met so often that giving room has not helped."""
        return self._met >= MEETINGS

    def met(self, now: float) -> None:
        """Count a meeting, unless the last one was within LATER; call in each step in which the robot makes room."""
        if now - self._met_at > LATER:
            self._met, self._met_at = self._met + 1, now

    def with_whom(self, here: Point, people: Sequence[Obstacle], now: float) -> Point | None:
        """Where the nearest person stands once that has lasted, else None; call in each step with a person near."""
        if now - self._at > TICK:
            self._since = now
        self._at = now
        near = min(people, key=lambda o: math.dist((o.x, o.y), here), default=None)
        if near is None or now - self._since < (LATER if self.again else STANDOFF):
            return None
        self._since, self._met, self._met_at = now, self._met + 1, now
        return near.x, near.y
