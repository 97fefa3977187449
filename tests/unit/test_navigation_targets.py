"""A base that says that it has arrived before its odometry says so, or whose odometry never does."""

import pytest

from common import messages as m
from common.geometry import Pose2
from services.navigation.ended import Ended
from services.navigation.motion.targets import Targets

START, SENT, LATER = (0.0, 0.0, 0.0), (0.4, 0.0, 0.0), (0.3, 0.0, 0.0)


def begun(start: Pose2 | None = START) -> Targets:
    """The targets of a goal that was begun at `start`."""
    targets = Targets("bench/1/1")
    targets.start = start
    return targets


def told(start: Pose2 | None = START) -> Targets:
    """A base that was sent to `SENT` and has said that it is there."""
    targets = begun(start)
    sent = targets.ahead(SENT, final=False)
    targets.where(start, [m.GoalReached(reached=True, target_id=sent.id)])
    return targets


def test_where_odometry_stands_still_the_bases_word_is_where_it_is() -> None:
    assert told().where(START, []) == SENT
    assert told(None).where(None, []) == SENT


def test_odometry_that_moves_after_all_is_believed_from_then_on() -> None:
    targets = told()
    assert targets.where(LATER, []) == LATER
    said = [m.GoalReached(reached=True, target_id=targets.ahead(SENT, final=False).id)]
    assert targets.where(LATER, said) == LATER
    assert targets.where(START, []) == START, "back where it began, it is not where it once said to be"


def test_before_anything_was_sent_its_word_is_nothing() -> None:
    targets = begun()
    said = [m.GoalReached(reached=True, target_id="bench/1/1#0")]
    assert targets.where(START, said) == START and targets.where(None, []) is None


def test_its_word_on_an_older_target_or_on_one_aside_is_nothing() -> None:
    targets = begun()
    old = targets.ahead(SENT, final=False)
    targets.ahead(LATER, final=False)
    assert targets.where(START, [m.GoalReached(reached=True, target_id=old.id)]) == START
    aside = targets.aside(SENT)
    assert targets.where(START, [m.GoalReached(reached=True, target_id=aside.id)]) == START


def test_the_goal_itself_bears_its_name_and_ends_when_the_base_is_there() -> None:
    targets = begun()
    end = targets.ahead(SENT, final=True)
    assert targets.where(START, [m.GoalReached(reached=False, target_id=end.id)]) == START
    with pytest.raises(Ended) as ended:
        targets.where(START, [m.GoalReached(reached=True, target_id=end.id)])
    assert ended.value.status == "arrived"
