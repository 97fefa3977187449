"""Fixtures shared by all layers."""

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.support import Site, site

# Keys in the developer's own `run/` have no part in the tests.
os.environ["TIDYBOT_KEYS"] = "off"


@pytest.fixture
def here(tmp_path: Path) -> Iterator[Site]:
    """A router of the test's own on a free port, and a fresh namespace."""
    with site(tmp_path) as opened:
        yield opened
