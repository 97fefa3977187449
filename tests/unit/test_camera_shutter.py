"""Rolling shutter and age: what moves is seen where it was, row by row; what rests as it is."""

import numpy as np
import pytest

from common import messages as m
from services.camera.shutter import AGE, READOUT, SLICES, moved, rolling


def state(t: float, *values: float, epoch: str = "e") -> m.SimState:
    return m.SimState(t=t, tick=round(100 * t), epoch=epoch, qpos=np.array(values).tobytes())


def test_what_moves_is_seen_where_it_was() -> None:
    seen = moved([state(1.0, 0.0, 5.0), state(1.1, 0.1, 5.0)], 0.05, SLICES)
    assert [q[0] for q in seen] == pytest.approx([0.05, 0.06, 0.07, 0.08])
    assert [q[1] for q in seen] == [5.0] * SLICES
    assert min(AGE) >= READOUT, "a picture is never of the future"


@pytest.mark.parametrize(
    "before",
    [
        state(1.0, 0.1 - 1e-5), state(0.5, 0.0), state(1.1, 0.0), state(1.2, 0.0), state(1.0, 0.0, epoch="other"),
        state(1.0, 0.0, 0.0),
    ],
    ids=["at rest", "long ago", "the same", "of the future", "of another world", "of another model"],
)  # fmt: skip
def test_without_a_motion_that_is_known_there_is_one_moment(before: m.SimState) -> None:
    seen = moved([before, state(1.1, 0.1)], 0.05, SLICES)
    assert len(seen) == 1 and seen[0][0] == 0.1
    assert len(moved([state(1.1, 0.1)], 0.05, SLICES)) == 1


def test_rows_go_from_the_first_moment_to_the_last() -> None:
    drawn = [np.full((60, 4, 3), level, np.uint8) for level in (0, 100, 200)]
    rows = rolling(drawn)[:, 0, 0].astype(int)
    assert rows[0] == 0 and rows[30] == 100 and rows[-1] == pytest.approx(200 * 59 / 60, abs=2)
    assert (np.diff(rows) >= 0).all() and np.diff(rows).max() <= 4
    assert rolling(drawn[:1]) is drawn[0]
