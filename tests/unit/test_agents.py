"""The parts of `tidybot mcp` that need neither protocol nor robot."""

import argparse

import pytest

from cli.agents.command import PORT, address
from cli.agents.missions import LONGEST, phrase, sentence
from cli.errors import CliError
from common import topics
from common.security import access
from common.security.access import Subject


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("8765", ("127.0.0.1", 8765)),
        ("0.0.0.0", ("0.0.0.0", PORT)),
        ("robot:80", ("robot", 80)),
        ("[::1]:90", ("::1", 90)),
        ("::1", ("::1", PORT)),
    ],
)
def test_addresses(text: str, expected: tuple[str, int]) -> None:
    assert address(text) == expected


@pytest.mark.parametrize("text", ["", "0", "host:99999", ":80"])
def test_what_is_no_address(text: str) -> None:
    with pytest.raises(argparse.ArgumentTypeError, match="expected"):
        address(text)


@pytest.mark.parametrize("text", ["the red mug", "  The  red\n mug. ", "red mug", "a red mug!"])
def test_a_phrase_has_no_article(text: str) -> None:
    assert phrase(text, "object") == "red mug"


def test_an_article_alone_is_a_phrase_that_the_planner_refuses() -> None:
    assert phrase("the", "object") == "the"


@pytest.mark.parametrize("text", ["", " \n", "x" * (LONGEST + 1), "bell\x07", "\u202eabc"])
def test_what_is_no_sentence(text: str) -> None:
    with pytest.raises(CliError, match="printable"):
        sentence(text, "command")


def test_an_agent_speaks_stops_and_looks_and_no_more() -> None:
    granted = access.grants(Subject(name="agent", role="agent"))
    assert set(granted.puts) == {"voice_command", "robot/stop", "camera/request"}
    assert granted.answers == granted.tokens == ()
    assert {k for k in (*granted.reads, *granted.asks) if "*" in k} == {access.ALL_HEALTH, access.ALL_ALIVE}
    assert not {topics.SIM_TRUTH, topics.SIM_CONTACTS.key, *access.CHANGING} & {*granted.reads, *granted.asks}
    assert {"voice_command", "audio/pcm", "audio/out"}.isdisjoint(granted.reads)
