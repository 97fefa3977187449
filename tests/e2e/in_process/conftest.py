"""What the whole robot in one process starts from."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.e2e.in_process.at_home import Home


@pytest.fixture
def home(tmp_path: Path) -> Iterator[Home]:
    opened = Home(tmp_path)
    try:
        yield opened
    finally:
        opened.stack.close()
