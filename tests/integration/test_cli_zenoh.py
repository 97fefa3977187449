"""Our decoder inside the real `zenoh` command of zenoh-cli, as the probing cookbook uses it."""

import shutil
import subprocess
import sys
from importlib.metadata import entry_points
from pathlib import Path

import pytest

from common import bus, topics
from common import messages as m
from tests.support import Site


def test_the_plug_in_is_installed_under_its_name() -> None:
    found = {e.name: e for e in entry_points(group="zenoh_cli.codecs.decoders")}
    if "tidybot" not in found:
        pytest.skip("the project itself is not installed in this environment")
    assert found["tidybot"].load()("brain/state", b'{"state": "IDLE"}').startswith('{"state":"IDLE"')


def test_the_zenoh_command_prints_messagepack_through_it(here: Site) -> None:
    command = Path(sys.executable).parent / "zenoh"
    if not command.exists() and shutil.which("zenoh") is None:
        pytest.skip("zenoh-cli is not installed")
    if not entry_points(group="zenoh_cli.codecs.decoders", name="tidybot"):
        pytest.skip("the project itself is not installed in this environment")
    with here.session() as session:
        io_key = topics.ODOMETRY.key
        payload = m.Odometry(t=2.0, x=1.5, y=0.0, theta=0.0)

        def answer(query: object) -> None:
            with query:  # type: ignore[attr-defined]
                query.reply(io_key, bus.codec.encode(topics.ODOMETRY, payload))  # type: ignore[attr-defined]

        kept = session.declare_queryable(io_key, answer)
        words = ["--mode", "client", "--connect", here.connect, "get", "-s", f"{here.namespace}/{io_key}"]
        done = subprocess.run(
            [str(command), *words, "--decoder", "tidybot"], capture_output=True, text=True, timeout=30
        )
        kept.undeclare()
    assert '"x":1.5' in done.stdout, done
