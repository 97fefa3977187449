"""A surface is named, the brain is killed, and the name is a place to put things: the whole robot in one process."""

import pytest

from common import topics
from tests.e2e.in_process.at_home import Home

pytestmark = [pytest.mark.slow, pytest.mark.timeout(900)]


def test_a_surface_goes_by_its_new_name_and_a_rule_is_followed(home: Home) -> None:
    assert home.tell("rename the counter to worktop", 60.0).outcome == "delivered"
    assert home.tell("apples go on the worktop", 60.0).outcome == "delivered"
    home.stack.kill("brain")
    home.stack.advance(1.0)
    home.stack.start("brain")
    home.stack.advance(1.0)
    assert [(n.name, n.part) for n in home.latest(topics.HOUSEHOLD_EDITS).names] == [("worktop", "counter")]
    assert home.tell("put the apple away", 300.0).outcome == "delivered"
    assert home.place_of("apple") == "counter"
    assert home.tell("forget that rule", 60.0).outcome == "delivered"
    assert home.latest(topics.HOUSEHOLD_EDITS).rules == []
    seen = {(s.thing, s.part) for s in home.latest(topics.SIGHTINGS).sightings}
    assert ("apple", "counter") in seen
