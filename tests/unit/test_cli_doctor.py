"""`tidybot doctor` with things missing: each finding that is not well says what to type."""

import argparse
import importlib.util
import json
import shutil
import socket
from importlib import metadata
from pathlib import Path
from types import SimpleNamespace

import pytest

from cli import doctor
from cli.errors import CliError
from cli.keys.authority import Authority
from common.rendering import backend


@pytest.fixture(autouse=True)
def own_run_directory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TIDYBOT_RUN_DIR", str(tmp_path / "run"))
    for name in ("TIDYBOT_KEYS", "TIDYBOT_KEYS_DIR", "MENAGERIE_ROOT"):
        monkeypatch.delenv(name, raising=False)


def test_everything_that_is_not_well_has_a_fix(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A machine that lacks whatever a machine can lack."""
    version = metadata.version
    monkeypatch.setattr(doctor.ctypes.util, "find_library", lambda name: None)
    monkeypatch.setattr(backend, "best", lambda: "raycast")
    monkeypatch.setattr(shutil, "which", lambda name: None)
    monkeypatch.setattr(shutil, "disk_usage", lambda path: SimpleNamespace(free=10e6))
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    monkeypatch.setattr(doctor.os, "sched_getaffinity", lambda pid: {0})

    def absent(name: str) -> str:
        if name == "mink":
            raise metadata.PackageNotFoundError(name)
        return "0.0" if name == "numpy" else version(name)

    monkeypatch.setattr(metadata, "version", absent)
    monkeypatch.setenv("TIDYBOT_KEYS", "/no/such/place")
    with pytest.raises(CliError, match="packages, keys"):
        doctor.doctor(argparse.Namespace(json=True))
    findings = json.loads(capsys.readouterr().out)
    unwell = {f["what"]: f for f in findings if f["level"] != "ok"}
    assert {"packages", "camera GL", "microphone, speakers", "keys", "cores", "disk", "docker", "official model"} <= {
        *unwell
    }
    assert all(f["fix"] for f in unwell.values())
    assert unwell["keys"]["fix"] == "tidybot keys --dir /no/such/place"


def test_a_busy_port_is_told_with_who_has_it(monkeypatch: pytest.MonkeyPatch) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        found = doctor.busy(port, "tidybot up --port 7448")
    assert "in use by" in found.state
    assert found.fix.startswith("kill ") and found.fix.endswith("tidybot up --port 7448")


def test_keys_that_cannot_be_read_are_an_error_and_the_fix_mends_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from cli import main

    folder = tmp_path / "keys"
    monkeypatch.setenv("TIDYBOT_KEYS", str(folder))
    assert main.main(["keys", "--dir", str(folder)]) == 0
    assert [f.level for f in doctor.certificates()] == ["ok"]
    (folder / Authority(folder).subjects()[0].common_name / "cert.pem").write_text("torn")
    (found,) = doctor.certificates()
    assert found.level == "error" and "cannot be read" in found.state
    assert main.main(found.fix.split()[1:]) == 0
    assert [f.level for f in doctor.certificates()] == ["ok"]


@pytest.mark.parametrize(("there", "level"), [(True, "ok"), (False, "note")])
def test_the_official_model_is_looked_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, there: bool, level: str
) -> None:
    monkeypatch.setenv("MENAGERIE_ROOT", str(tmp_path))
    (tmp_path / doctor.ROBOT).mkdir()
    if there:
        (tmp_path / doctor.ROBOT / "tidybot.xml").write_text("<mujoco/>")
    monkeypatch.setenv("TIDYBOT__SIM__ROBOT", "official")
    robot, model = doctor.robots()
    assert (robot.level, robot.state) == ("ok", "sim.robot = official: TidyBot, drawn as the official meshes")
    assert model.level == level
