"""A name is taught, outlives perception's process, finds the thing, is forgotten: the whole robot in one process."""

import pytest

from common import topics
from tests.e2e.in_process.at_home import Home

pytestmark = [pytest.mark.slow, pytest.mark.timeout(900)]


def test_a_name_is_taught_outlives_the_process_finds_the_thing_and_is_forgotten(home: Home) -> None:
    assert home.tell("bring me the red mug", 300.0).outcome == "delivered"
    assert home.tell("this is my sunrise", 60.0).outcome == "delivered"
    assert home.names() == {"red mug": ["sunrise"]}
    home.stack.kill("perception")
    home.stack.advance(1.0)
    home.stack.start("perception")
    assert home.tell("put my sunrise on the counter", 300.0).outcome == "delivered"
    assert home.place_of("red mug") == "counter"
    assert home.tell("forget my sunrise", 60.0).outcome == "delivered"
    assert home.names() == {} and home.latest(topics.HOUSEHOLD_NAMES).names == []
