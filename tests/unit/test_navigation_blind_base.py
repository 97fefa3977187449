"""A base that says that it has arrived before its odometry says so, or whose odometry never does."""

from common.geometry import Pose2
from services.navigation.motion.blind_base import BlindBase

START, SENT, LATER = (0.0, 0.0, 0.0), (0.4, 0.0, 0.0), (0.3, 0.0, 0.0)


def told(start: Pose2 | None = START) -> BlindBase:
    """A base that was sent to `SENT` and has said that it is there."""
    base = BlindBase()
    base.start, base.sent = start, SENT
    base.reached(start)
    return base


def test_where_odometry_stands_still_the_bases_word_is_where_it_is() -> None:
    assert told().where(START) == SENT
    assert told(None).where(None) == SENT


def test_odometry_that_moves_after_all_is_believed_from_then_on() -> None:
    base = told()
    assert base.where(LATER) == LATER
    base.reached(LATER)
    assert base.where(LATER) == LATER
    assert base.where(START) == START, "back where it began, it is not where it once said to be"


def test_before_anything_was_sent_its_word_is_nothing() -> None:
    base = BlindBase()
    base.start = START
    base.reached(START)
    assert base.where(START) == START and base.where(None) is None
