"""Commands that refer to what was done before: the whole robot in one process."""

from pathlib import Path

import pytest

from tests.e2e.in_process.test_names import Home

pytestmark = [pytest.mark.slow, pytest.mark.timeout(600)]


def test_what_was_brought_is_put_back_where_it_was(tmp_path: Path) -> None:
    home = Home(tmp_path)
    try:
        assert "red mug" in home.tell("take a look around", 90.0).reason
        assert home.tell("bring me the red mug", 300.0).outcome == "delivered"
        assert home.place_of("red mug") == "delivery tray"
        assert "bring you the red mug" in home.tell("what did you just do", 30.0).reason
        assert home.tell("put it back where it was", 300.0).outcome == "delivered"
        assert home.place_of("red mug") == "living table"
    finally:
        home.stack.close()
