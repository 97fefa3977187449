"""Rolling shutter and age: what moves is seen where it was, row by row; what rests as it is."""

import numpy as np
import pytest

from common import messages as m
from services.camera.shutter import AGE, READOUT, SLICES, exposed, moved, rolling


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
    drawn = [np.full((end - first, 4, 3), 100 * k, np.uint8) for k, (first, end) in enumerate(exposed(60, 3))]
    rows = rolling(drawn, 60)[:, 0, 0].astype(int)
    assert rows[0] == 0 and rows[30] == 100 and rows[-1] == pytest.approx(200 * 59 / 60, abs=2)
    assert (np.diff(rows) >= 0).all() and np.diff(rows).max() <= 4
    assert rolling(drawn[:1], 30) is drawn[0]


@pytest.mark.parametrize(("height", "count"), [(480, 1), (480, 4), (61, 4), (7, 3)])
def test_a_moment_is_drawn_where_it_has_a_share(height: int, count: int) -> None:
    rows = exposed(height, count)
    assert (rows[0][0], rows[-1][1]) == (0, height)
    at = np.arange(height) * (count - 1) / height
    for k, (first, end) in enumerate(rows):
        has_a_share = np.flatnonzero(np.abs(at - k) < 1)
        assert first <= has_a_share[0] <= first + 1 and has_a_share[-1] + 1 == end
