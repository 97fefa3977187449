"""The five scenarios of the VLA contract, in one process, judged by physics."""

import pytest

from evaluation import runner
from evaluation.suites.table import NAMED, cases

ACCEPTED = 4
"""Scenarios of five that the contract wants completed."""


@pytest.mark.slow
@pytest.mark.timeout(3600)
def test_the_contracts_five_scenarios() -> None:
    results = [runner.run(case) for case in cases("seed", len(NAMED), 0)]
    ends = {result.name: (result.outcome, result.cause) for result in results}
    assert set(ends) == set(NAMED)
    assert sum(result.delivered for result in results) >= ACCEPTED, ends
    assert not [result for result in results if result.outcome == "false_success"], ends
