"""Goals by (id, attempt): taken once, answered from memory, forgotten in the order they came."""

from common.goal_register import GoalRegister


def test_a_goal_is_new_once_and_another_attempt_is_another_goal() -> None:
    goals: GoalRegister[str] = GoalRegister()
    assert goals.is_new("g1", 1)
    assert not goals.is_new("g1", 1)
    assert goals.is_new("g1", 2)
    assert goals.is_new("g2", 1)


def test_the_answer_stays_with_its_goal() -> None:
    goals: GoalRegister[str] = GoalRegister()
    goals.is_new("g1", 1)
    assert goals.answered("g1", 1) is None
    goals.answer("g1", 1, "done")
    assert goals.answered("g1", 1) == "done"
    assert goals.answered("g1", 2) is None


def test_the_oldest_is_forgotten_with_its_answer() -> None:
    goals: GoalRegister[str] = GoalRegister(capacity=2)
    for n in (1, 2, 3):
        goals.is_new("g", n)
        goals.answer("g", n, f"answer {n}")
    assert goals.answered("g", 1) is None
    assert goals.answered("g", 2) == "answer 2"
    goals.answer("g", 1, "late")
    assert goals.answered("g", 1) is None
    assert goals.is_new("g", 1)
    assert goals.is_new("g", 2), "it was the oldest then"
