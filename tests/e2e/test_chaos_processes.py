"""Real processes killed, stopped and cut off in the middle of a mission: twenty cells of the matrix, by a seed."""

import numpy as np
import pytest

from evaluation import processes
from evaluation.case import TimedFault
from evaluation.suites.chaos import CELLS, CHAOS_STATES, EVERY, MOMENTS, PARAMETERS, Cell
from evaluation.suites.table import cases

pytestmark = [pytest.mark.slow, pytest.mark.long, pytest.mark.timeout(900)]
REAL = ("kill", "hang", "router loss", "disk full", "disk full, kill")
NUMBER, TOGETHER, SEED = 20, 4, 13


def missions() -> list[list[Cell]]:
    """The sample, up to four cells to a mission, each in a state of its own."""
    pool = [c for c in CELLS if c.fault in REAL and c.state != EVERY]
    rng = np.random.default_rng(SEED)
    packed: list[list[Cell]] = []
    for cell in (pool[int(i)] for i in rng.permutation(len(pool))[:NUMBER]):
        fitting = (p for p in packed if len(p) < TOGETHER and cell.state not in {c.state for c in p})
        room = next(fitting, None)
        if room is None:
            packed.append([cell])
        else:
            room.append(cell)
    return [sorted(p, key=lambda c: CHAOS_STATES.index(c.state)) for p in packed]


def test_the_sample_is_twenty_cells() -> None:
    assert sum(map(len, missions())) == NUMBER
    assert {"kill", "hang"} <= {c.fault for p in missions() for c in p}


@pytest.mark.parametrize("cells", missions(), ids=lambda p: ", ".join(f"{c.fault} {c.service} {c.state}" for c in p))
def test_a_mission_survives_what_befalls_its_processes(cells: list[Cell]) -> None:
    """Each cell strikes once its state is reached; the mission is delivered or fails honestly, with nothing dropped."""
    rng = np.random.default_rng([SEED, len(cells)])
    case = cases("chaos", 1, CELLS.index(cells[0]))[0]
    case.spoken = any(c.service == "speech" or c.state == "CONFIRMING" for c in cells)
    case.timed_faults = tuple(
        TimedFault(c.service, c.state, after=float(rng.uniform(0, MOMENTS[c.state])), **PARAMETERS.get(c.fault, {}))
        for c in cells
    )
    result = processes.run(case)
    evidence = result.evidence
    assert result.outcome in ("delivered", "reported"), (result.cause, evidence)
    assert not result.false_claims
    things, states, strikes = evidence["things"], evidence["states"], evidence["strikes"]
    assert isinstance(things, list) and isinstance(states, list) and isinstance(strikes, list)
    assert not any(t["drops"] for t in things), evidence
    struck = " ".join(s["what"] for s in strikes)
    reached = [c for c in cells if c.state in states and c.service != "host"]
    assert all(f"in {c.state}" in struck for c in reached) and (result.delivered or strikes), evidence
