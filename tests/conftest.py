"""Fixtures shared by all layers; the order in which the files are begun, and what stays together."""

from collections.abc import Iterator
from itertools import chain, groupby, zip_longest
from pathlib import Path
from typing import Any

import pytest
from xdist.scheduler import LoadFileScheduling

from evaluation.site import Site, site

IN_PROCESS = ("unit", "in_process")
"""Directories of the tests that start no processes."""
APART = "/in_process/", "test_sentences_are_understood"
"""Of tests that share nothing with the others of their file and take long: whole missions, and lists of sentences."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Files marked `long` first; files that start processes, which mostly wait, in turn with those that compute."""
    files = [list(found) for _, found in groupby(items, lambda item: item.path)]
    files.sort(key=lambda found: found[0].get_closest_marker("long") is None)
    apart = [found for found in files if found[0].path.parent.name not in IN_PROCESS]
    together = [found for found in files if found[0].path.parent.name in IN_PROCESS]
    in_turn = chain.from_iterable(zip_longest(apart, together, fillvalue=[]))
    items[:] = chain.from_iterable(in_turn)


class SomeApart(LoadFileScheduling):
    """Files stay together, for the robots they share, but for those of `APART`."""

    def _split_scope(self, nodeid: str) -> str:
        return nodeid if any(part in nodeid for part in APART) else super()._split_scope(nodeid)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> SomeApart | None:
    return SomeApart(config, log) if config.getoption("dist") == "loadfile" else None


@pytest.fixture
def here(tmp_path: Path) -> Iterator[Site]:
    """A router of the test's own on a free port, and a fresh namespace."""
    with site(tmp_path) as opened:
        yield opened
