"""Goals by (id, attempt): begun once, answered from memory, pre-empted by newer ones, forgotten in their order."""

from common import messages as m
from common import topics
from common.bus.memory import MemoryBus, MemoryIo
from common.goal_inbox import GoalInbox
from common.household import load_household

SCENE = load_household("minimal")


class Receiver:
    """A service that writes down what its inbox does."""

    def __init__(self, capacity: int = 8) -> None:
        self.bus = MemoryBus()
        self.io = io = MemoryIo(self.bus, "navigation", (topics.NAVIGATION_GOAL, topics.NAV_GOAL), (), household=SCENE)
        self.told: list[tuple[str, ...]] = []
        self.inbox: GoalInbox[m.NavigationGoal, str] = GoalInbox(
            io,
            (topics.NAVIGATION_GOAL, topics.NAV_GOAL),
            begin=lambda goal: self.told.append(("begin", goal.id)),
            repeat=lambda goal, answer: self.told.append(("repeat", goal.id, answer or "-")),
            preempt=lambda old, new: self.told.append(("preempt", old.id, new.id)),
            capacity=capacity,
        )

    def send(self, goal_id: str, attempt: int = 1) -> m.NavigationGoal:
        goal = m.NavigationGoal(goal="stop", id=goal_id, attempt=attempt)
        self.bus.send(topics.NAVIGATION_GOAL, goal)
        self.receive()
        return goal

    def receive(self) -> None:
        self.io.begin(None, 1.0)
        self.inbox.receive()

    def news(self) -> list[tuple[str, ...]]:
        told, self.told = self.told, []
        return told


def test_a_goal_begins_once_and_another_attempt_is_another_goal() -> None:
    receiver = Receiver()
    first = receiver.send("g1")
    assert receiver.news() == [("begin", "g1")]
    receiver.send("g1")
    assert receiver.news() == [("repeat", "g1", "-")]
    receiver.inbox.end(first, "done")
    receiver.send("g1")
    assert receiver.news() == [("repeat", "g1", "done")]
    receiver.send("g1", attempt=2)
    assert receiver.news() == [("begin", "g1")]


def test_a_newer_goal_preempts_the_one_under_way_only() -> None:
    receiver = Receiver()
    first = receiver.send("g1")
    second = receiver.send("g2")
    assert receiver.news() == [("begin", "g1"), ("preempt", "g1", "g2"), ("begin", "g2")]
    receiver.inbox.end(first, "preempted")
    assert receiver.inbox.active is not None and receiver.inbox.active.id == "g2"
    receiver.inbox.end(second, "done")
    receiver.send("g3")
    assert receiver.news() == [("begin", "g3")]


def test_a_goal_without_an_id_gets_one_and_pose_goals_are_goals_too() -> None:
    receiver = Receiver()
    receiver.send("")
    receiver.bus.send(topics.NAV_GOAL, m.NavGoal(x=1.0, y=1.0))
    receiver.receive()
    named = [words[1] for words in receiver.news() if words[0] == "begin"]
    assert len(set(named)) == 2 and all(name.startswith("navigation-") for name in named)


def test_the_oldest_is_forgotten_with_its_answer() -> None:
    receiver = Receiver(capacity=2)
    goals = [receiver.send("g", n) for n in (1, 2, 3)]
    for goal in goals:
        receiver.inbox.end(goal, f"answer {goal.attempt}")
    receiver.news()
    receiver.send("g", 3)
    receiver.send("g", 1)
    assert receiver.news() == [("repeat", "g", "answer 3"), ("begin", "g")]
