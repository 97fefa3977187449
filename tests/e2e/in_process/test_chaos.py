"""A mission with the brain killed in every state; the slow ones: with any other service, and a tenth of the matrix."""

import pytest

from evaluation import runner
from evaluation.case import Result
from evaluation.suites.chaos import CELLS, CHAOS_SERVICES, EVERY, Cell
from evaluation.suites.table import cases

pytestmark = [pytest.mark.long, pytest.mark.timeout(1800)]


def harmed(seed: int) -> Result:
    return runner.run(cases("chaos", 1, seed)[0])


def check(result: Result) -> None:
    """Recovered or honestly reported; nothing dropped, no success claimed that is none."""
    evidence = result.evidence
    things = evidence["things"]
    assert result.outcome in ("delivered", "reported"), (result.cause, evidence)
    assert isinstance(things, list) and not any(t["drops"] for t in things), evidence
    assert result.outcome == "delivered" or evidence["reason"], evidence


@pytest.mark.slow
def test_a_brain_killed_in_every_state_of_one_mission_delivers() -> None:
    result = harmed(CELLS.index(Cell("brain", EVERY, "kill")))
    check(result)
    assert result.delivered and isinstance(result.evidence["recovery"], float)


@pytest.mark.slow
@pytest.mark.parametrize("service", [s for s in CHAOS_SERVICES if s != "brain"])
def test_each_service_killed_in_every_state_of_one_mission(service: str) -> None:
    check(harmed(CELLS.index(Cell(service, EVERY, "kill"))))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3, len(CELLS), 10))
def test_a_tenth_of_the_matrix(seed: int) -> None:
    check(harmed(seed))
