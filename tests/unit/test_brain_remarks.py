"""What the robot says by itself while it drives."""

from common import messages as m
from common import topics
from services.brain.mission.remarks import FOUND, MAP_AGED, PAUSE, PERSON, SAID, Remarks
from tests.unit.brain_bench import Bench
from tests.unit.test_brain_vla import SPEECH, planned


class Listener:
    """Remarks with a clock."""

    def __init__(self) -> None:
        self.said: list[str] = []
        self.remarks = Remarks(self.said.append)
        self.now = 0.0

    def told(self, code: str, seconds: float = 0.0, status: m.NavStatus = "navigating") -> list[str]:
        """Navigation says `code` every second for so long; what was said since the beginning."""
        until = self.now + seconds
        while True:
            self.remarks.hear(m.NavigationFeedback(goal_id="a", status=status, code=code), self.now)
            self.remarks.step(self.now)
            if self.now >= until:
                return self.said
            self.now += 0.5


def test_somebody_in_the_way_is_asked_and_not_at_once_nor_all_the_time() -> None:
    listener = Listener()
    assert listener.told(PERSON, 1.0) == []
    assert listener.told(PERSON, PAUSE - 1.0) == [SAID[PERSON]]
    assert listener.told(PERSON, 4.0) == 2 * [SAID[PERSON]]


def test_who_walks_by_is_not_spoken_to() -> None:
    listener = Listener()
    for _ in range(10):
        listener.told(PERSON, 1.0)
        assert listener.told("", 1.0) == []


def test_it_says_that_it_is_lost_and_that_it_is_no_more() -> None:
    listener = Listener()
    assert listener.told("LOST", 4.0) == [SAID["LOST"]]
    assert listener.told("") == [SAID["LOST"], FOUND]
    assert listener.told("", 3.0) == [SAID["LOST"], FOUND]


def test_a_goal_that_fails_is_reported_by_others() -> None:
    listener = Listener()
    listener.told("LOST", 4.0)
    assert listener.told("LOST", 20.0, "failed") == [SAID["LOST"]]


def test_a_map_that_has_aged_is_told_once_when_it_has_arrived() -> None:
    listener = Listener()
    for status in ("navigating", "arrived", "navigating", "arrived"):
        feedback = m.NavigationFeedback(goal_id="a", status=status, map_fit=0.5)
        listener.remarks.hear(feedback, 1.0)
        listener.remarks.step(1.0)
    assert listener.said == [MAP_AGED]
    listener.remarks.hear(m.NavigationFeedback(goal_id="b", status="arrived", map_fit=0.7), 9999.0)
    listener.remarks.step(9999.0)
    assert listener.said == [MAP_AGED]


def test_it_is_said_aloud_beside_the_mission() -> None:
    bench: Bench = planned()
    goal = m.NavigationFeedback(goal_id="somebody's", status="navigating", code=PERSON)
    bench.send(topics.NAVIGATION_FEEDBACK, goal)
    bench.step(2.0)
    assert bench.texts(SPEECH)[-1] == f"say {SAID[PERSON]}"
