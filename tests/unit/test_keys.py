"""Certificates on disk: made once, read back, and refused with the reason when something is wrong with them."""

import json
import os
import stat
from pathlib import Path

import pytest

from cli.keys.authority import Authority
from cli.main import main as tidybot
from cli.processes.services import NAMES
from common.security import keys
from common.security.access import Subject
from common.security.certificate import Identity
from common.security.keys import KeysError


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    directory = tmp_path_factory.mktemp("made") / "keys"
    assert tidybot(["keys", "--dir", str(directory), "--host", "robot.local", "--host", "10.1.2.3"]) == 0
    return directory


def identity(directory: Path, name: str, namespace: str = "") -> Identity:
    return Identity(keys.folder(directory, name, namespace), name, namespace)


def test_there_is_one_for_every_process_and_only_its_owner_reads_them(made: Path) -> None:
    for name in (*NAMES, "operator"):
        assert identity(made, name).common_name == name
    for folder, _, files in os.walk(made):
        for file in files:
            assert stat.S_IMODE((Path(folder) / file).stat().st_mode) == 0o600, file
        if Path(folder) != made:
            assert stat.S_IMODE(Path(folder).stat().st_mode) == 0o700, folder


def test_the_folder_of_one_process_is_enough_for_it(made: Path) -> None:
    assert identity(made / "navigation", "navigation").common_name == "navigation"
    with pytest.raises(KeysError, match="is the certificate of navigation, not of brain"):
        identity(made / "navigation", "brain")


def test_nothing_is_overwritten_unasked(made: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = {p: p.read_bytes() for p in made.rglob("*.pem")}
    assert tidybot(["keys", "--dir", str(made)]) == 1
    assert "--force" in capsys.readouterr().err
    assert tidybot(["keys", "--dir", str(made), "--missing"]) == 0
    assert {p: p.read_bytes() for p in made.rglob("*.pem")} == before


def test_clients_robots_and_what_is_missing_are_added(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    directory = tmp_path / "keys"
    base = ["keys", "--dir", str(directory)]
    assert tidybot(base) == 0
    assert tidybot([*base, "--client", "alice", "--days", "30"]) == 0
    assert tidybot([*base, "--client", "bob", "--observer"]) == 0
    assert tidybot([*base, "--client", "bob"]) == 1, "bob is there already"
    assert tidybot([*base, "--namespace", "kitchen-bot"]) == 0
    for file in (directory / "camera").iterdir():
        file.unlink()
    (directory / "camera").rmdir()
    with pytest.raises(KeysError, match=r"no certificate of camera in .*tidybot keys --missing"):
        identity(directory, "camera")
    capsys.readouterr()
    assert tidybot([*base, "--missing", "--json"]) == 0
    assert [r["name"] for r in json.loads(capsys.readouterr().out)["made"]] == ["camera"]
    assert identity(directory, "camera").common_name == "camera"
    assert identity(directory, "brain", "kitchen-bot").common_name == "kitchen-bot/brain"
    roles = {s.common_name: s.role for s in Authority(directory).subjects()}
    assert roles["alice"] == "operator"
    assert roles["bob"] == "observer"
    assert roles["kitchen-bot/operator"] == "operator"


def test_force_renews_everybody(tmp_path: Path) -> None:
    base = ["keys", "--dir", str(tmp_path)]
    assert tidybot(base) == 0
    assert tidybot([*base, "--client", "alice"]) == 0
    before = (tmp_path / "ca" / "cert.pem").read_bytes()
    assert tidybot([*base, "--force", "--days", "10"]) == 0
    assert (tmp_path / "ca" / "cert.pem").read_bytes() != before
    for name in ("alice", "router", "speech"):
        identity(tmp_path, name)


def test_the_list_tells_until_when(made: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert tidybot(["keys", "--dir", str(made), "--list", "--json"]) == 0
    rows = {r["name"]: r for r in json.loads(capsys.readouterr().out)}
    assert rows["router"]["role"] == "router"
    assert rows["brain"]["expires"].startswith("20")


def test_an_expired_certificate_says_so(tmp_path: Path) -> None:
    authority = Authority(tmp_path)
    authority.found(1)
    authority.issue(Subject(name="navigation"), days=-0.5)
    with pytest.raises(KeysError, match=r"certificate of navigation expired on 20\d\d-.*tidybot keys --force"):
        identity(tmp_path, "navigation")


def test_an_expired_authority_says_so(tmp_path: Path) -> None:
    authority = Authority(tmp_path)
    authority.found(-0.5)
    authority.issue(Subject(name="navigation"), days=1)
    with pytest.raises(KeysError, match="authority of navigation's certificate expired"):
        identity(tmp_path, "navigation")


@pytest.mark.parametrize("file", ["ca.pem", "cert.pem", "key.pem"])
def test_a_missing_or_mixed_up_file_says_which(tmp_path: Path, file: str) -> None:
    for part in ("ours", "theirs"):
        authority = Authority(tmp_path / part)
        authority.found(1)
        authority.issue(Subject(name="brain"), days=1)
    ours, theirs = tmp_path / "ours" / "brain", tmp_path / "theirs" / "brain"
    (ours / file).write_bytes((theirs / file).read_bytes())
    with pytest.raises(KeysError, match="does not belong" if file == "key.pem" else "was not signed by"):
        Identity(ours, "brain")
    (ours / file).write_bytes(b"nonsense")
    with pytest.raises(KeysError, match=file):
        Identity(ours, "brain")
    (ours / file).unlink()
    with pytest.raises(KeysError, match=f"{file}.* is missing"):
        Identity(ours, "brain")


@pytest.mark.parametrize(
    ("words", "hint"),
    [
        (["--client", "speech"], "speech is a service"),
        (["--client", "a/b"], "letters, digits"),
        (["--observer"], "--client NAME"),
        (["--days", "0"], "positive"),
        (["--list"], "no keys in"),
        (["--host", "not a host"], "neither a name nor an address"),
    ],
)
def test_a_mistake_is_one_line(words: list[str], hint: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert tidybot(["keys", "--dir", str(tmp_path / "keys"), *words]) == 1
    said = capsys.readouterr().err
    assert hint in said
    assert len(said.strip().splitlines()) == 1


def test_where_keys_are_looked_for(tmp_path: Path) -> None:
    (tmp_path / "keys").mkdir()
    run = {"TIDYBOT_RUN_DIR": str(tmp_path)}
    assert keys.directory(run) is None, "an empty directory is no keys"
    (tmp_path / "keys" / "ca").mkdir()
    assert keys.directory(run) == tmp_path / "keys"
    assert keys.directory({**run, "TIDYBOT_KEYS": "off"}) is None
    assert keys.directory({"TIDYBOT_KEYS": str(tmp_path)}) == tmp_path
    assert keys.default_directory({**run, "TIDYBOT_KEYS_DIR": "/elsewhere"}) == Path("/elsewhere")
    with pytest.raises(KeysError, match="no such directory"):
        keys.directory({"TIDYBOT_KEYS": str(tmp_path / "nowhere")})
