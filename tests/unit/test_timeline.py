"""A mission of the log as an HTML page: its bands of states, what is escaped, and what is not loaded."""

import itertools
import re
from typing import Any

import pytest

from common.mission_log import timeline
from common.mission_log.states import spans


def entry(t: float, state: str, cause: str = "", kind: str = "state") -> dict[str, Any]:
    return {"t": t, "state": state, "cause": cause, "evidence": "", "kind": kind}


def record(*entries: dict[str, Any], outcome: str | None = None) -> dict[str, Any]:
    return {
        "id": "m-1", "command": "bring me the <mug>", "started": 5.0, "outcome": outcome, "reason": "",
        "ended": 20.0 if outcome else 0.0, "steps": 0, "entries": list(entries),
    }  # fmt: skip


FAILED = record(
    entry(5.0, "PLANNING", "heard “bring me the <mug>”", "heard"), entry(5.0, "PLANNING"), entry(8.0, "NAVIGATING"),
    entry(10.0, "NAVIGATING", "said “here I come”", "note"), entry(12.0, "NAVIGATING", "base: BLOCKED", "failed"),
    entry(20.0, "ERROR"), outcome="failed",
)  # fmt: skip


def test_bands_cover_the_mission_without_gaps() -> None:
    bands = spans(FAILED["entries"], 5.0, 20.0)
    assert [b[0] for b in bands] == ["PLANNING", "NAVIGATING", "ERROR"][: len(bands)]
    assert bands[0][1] == 0.0 and bands[-1][2] == 15.0
    assert all(a[2] == b[1] for a, b in itertools.pairwise(bands))


def test_a_mission_that_was_stopped_and_gone_on_with_has_a_band_for_the_pause() -> None:
    entries = [entry(5.0, "NAVIGATING"), entry(8.0, "IDLE"), entry(20.0, "NAVIGATING")]
    assert spans(entries, 5.0, 30.0) == [("NAVIGATING", 0.0, 3.0), ("IDLE", 3.0, 15.0), ("NAVIGATING", 15.0, 25.0)]


def test_the_timeline_escapes_words_and_loads_nothing() -> None:
    page = timeline.page(FAILED, [(3.0, "the mug", "/9j/")])
    assert "<mug>" not in page and "&lt;mug&gt;" in page
    assert "base: BLOCKED" in page
    links = re.findall(r'(?:src|href)="([^"]*)"', page)
    assert links and all(link.startswith("data:") for link in links)


@pytest.mark.parametrize("entries", [[], [entry(5.0, "PLANNING")]])
def test_a_mission_that_just_began_has_a_timeline(entries: list[Any]) -> None:
    assert "under way" in timeline.page(record(*entries))
