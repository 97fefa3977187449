"""Our decoder inside the real `zenoh` command of zenoh-cli, as the probing cookbook uses it."""

import shutil
import subprocess
import sys
from importlib.metadata import entry_points
from pathlib import Path

import pytest
import zenoh

from common import messages as m
from common import topics
from common.bus import codec
from evaluation.site import Site


def test_the_plug_in_is_installed_under_its_name() -> None:
    found = {e.name: e for e in entry_points(group="zenoh_cli.codecs.decoders")}
    if "tidybot" not in found:
        pytest.skip("the project itself is not installed in this environment")
    assert found["tidybot"].load()("brain/state", b'{"state": "IDLE"}').startswith('{"state":"IDLE"')


def test_the_zenoh_command_prints_messagepack_through_it(here: Site) -> None:
    command = Path(sys.executable).parent / "zenoh"
    if not command.exists() and shutil.which("zenoh") is None:
        pytest.skip("zenoh-cli is not installed")
    if not entry_points(group="zenoh_cli.codecs.decoders", name="tidybot-text"):
        pytest.skip("the project itself is not installed in this environment")
    with here.session() as session:
        odometry = codec.encode(topics.ODOMETRY, m.Odometry(t=2.0, x=1.5, y=0.0, theta=0.0))
        status = codec.encode(topics.SYSTEM_STATUS, m.SystemStatus(state="GROUNDING", mission_id="m1"))
        assert '"x":1.5' in got(here, session, command, topics.ODOMETRY.key, odometry, "tidybot")
        assert '"mission_id":"m1"' in got(here, session, command, topics.SYSTEM_STATUS.key, status, "tidybot")
        bare = got(here, session, command, topics.SYSTEM_STATUS.key, status, "tidybot-text")
    assert "GROUNDING" in bare and "mission_id" not in bare


def got(here: Site, session: zenoh.Session, command: Path, key: str, payload: bytes, decoder: str) -> str:
    """What `zenoh get` prints of a key that answers with this payload."""

    def answer(query: zenoh.Query) -> None:
        with query:
            query.reply(key, payload)

    kept = session.declare_queryable(key, answer)
    words = ["--mode", "client", "--connect", here.connect, "get", "-s", f"{here.namespace}/{key}"]
    done = subprocess.run([str(command), *words, "--decoder", decoder], capture_output=True, text=True, timeout=30)
    kept.undeclare()
    assert done.returncode == 0, done
    return done.stdout
