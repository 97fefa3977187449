"""What `pipx install` and `uv tool install` get: the wheel has all that a robot needs, and runs far from a checkout."""

import os
import re
import subprocess
import sys
import sysconfig
import tomllib
import venv
import zipfile
from pathlib import Path

import pytest

from cli.processes.ports import free_port
from tests.support import ROOT

PACKAGES = ("common", "services", "cli", "evaluation", "judge")


def run(line: list[str | Path], where: Path, **environment: str) -> "subprocess.CompletedProcess[str]":
    clean = {k: v for k, v in os.environ.items() if not k.startswith(("TIDYBOT", "PYTHON", "XDG_"))}
    return subprocess.run(
        [str(word) for word in line],
        cwd=where,
        env={**clean, **environment},
        capture_output=True,
        text=True,
        timeout=400,
    )


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    pytest.importorskip("hatchling")
    to = tmp_path_factory.mktemp("wheel")
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check"]
    done = run([*pip, "wheel", "--quiet", "--no-deps", "--no-build-isolation", "-w", to, ROOT], to)
    assert done.returncode == 0, done.stderr
    (found,) = to.glob("*.whl")
    return found


def test_the_wheel_has_every_file_of_the_packages_and_what_stands_beside_them(wheel: Path) -> None:
    listed = subprocess.run(["git", "ls-files", *PACKAGES], cwd=ROOT, capture_output=True, text=True, check=True)
    with zipfile.ZipFile(wheel) as packed:
        names = {n for n in packed.namelist() if ".dist-info/" not in n}
    tracked = {name for name in listed.stdout.split() if (ROOT / name).exists()}
    assert tracked <= names
    config = {p.relative_to(ROOT).as_posix() for p in (ROOT / "config").rglob("*") if p.is_file()}
    assert {f"common/shipped/{name}" for name in config} <= names
    assert "common/shipped/audio/yes.wav" in names
    assert not {n for n in names if n.split("/")[0] not in PACKAGES}, "nothing else becomes an importable name"


def test_the_image_s_build_has_every_file_that_the_wheel_wants() -> None:
    """It is installed in place there, from a part of the checkout."""
    copied = re.findall(r"^COPY (\S+) \S+$", (ROOT / "Dockerfile").read_text(), re.MULTILINE)
    wheel = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["hatch"]["build"]["targets"]["wheel"]
    for source in (*wheel["packages"], *wheel["force-include"]):
        assert any(source == part or source.startswith(f"{part}/") for part in copied), source


@pytest.fixture
def installed(wheel: Path, tmp_path: Path) -> Path:
    """An environment with the wheel in it that borrows the dependencies of this one; its `bin`."""
    venv.create(tmp_path / "venv", with_pip=False, symlinks=True)
    python = tmp_path / "venv" / "bin" / "python"
    site = Path(sysconfig.get_path("purelib", vars={"base": str(tmp_path / "venv")}))
    (site / "borrowed.pth").write_text(f"{sysconfig.get_path('purelib')}\n")
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "--python", python]
    done = run([*pip, "install", "--quiet", "--no-deps", "--no-index", "--ignore-installed", wheel], tmp_path)
    assert done.returncode == 0, done.stderr
    return python.parent


def files(directory: Path) -> set[Path]:
    return {p for p in directory.rglob("*") if p.is_file() and p.suffix != ".pyc"}


@pytest.mark.slow
@pytest.mark.timeout(600)
def test_a_mission_outside_of_any_checkout(installed: Path, tmp_path: Path) -> None:
    """The demo speaks, delivers and draws; config, scene, robot, voices and page come out of the wheel."""
    elsewhere, home = tmp_path / "elsewhere", tmp_path / "home"
    elsewhere.mkdir()
    home.mkdir()
    before = files(installed.parent)
    user = {"HOME": str(home), "XDG_RUNTIME_DIR": str(home)}
    where = run([installed / "python", "-c", "import common; print(common.__file__)"], elsewhere, **user)
    assert Path(where.stdout.strip()).is_relative_to(installed.parent), where
    tidybot = installed / "tidybot"
    doctor = run([tidybot, "doctor"], elsewhere, **user)
    assert "installed without a lock file" in doctor.stdout, doctor
    done = run([tidybot, "demo", "--scene", "minimal", "--speed", "max", "--port", str(free_port())], elsewhere, **user)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "DELIVERED" in done.stdout
    assert (elsewhere / "out" / "demo.png").exists(), "pictures are left where the command was given"
    assert files(installed.parent) == before, "nothing is written into the installation"


@pytest.mark.slow
@pytest.mark.timeout(300)
def test_a_scene_and_the_page_from_where_the_user_stands(installed: Path, tmp_path: Path) -> None:
    import urllib.request

    scene = (ROOT / "services" / "sim" / "scenes" / "minimal.toml").read_text()
    (tmp_path / "mine.toml").write_text(scene)
    user = {"HOME": str(tmp_path), "XDG_RUNTIME_DIR": str(tmp_path)}
    port, page = str(free_port()), str(free_port())
    tidybot = installed / "tidybot"
    words = ("--port", port, "--scene", "mine.toml", "--set", f"dashboard.port={page}", "--detach")
    try:
        up = run([tidybot, "up", *words], tmp_path, **user)
        assert up.returncode == 0, up.stdout + up.stderr
        with urllib.request.urlopen(f"http://127.0.0.1:{page}/page/page.js", timeout=20) as answer:
            assert answer.status == 200
        status = run([tidybot, "status", "--json"], tmp_path, **user)
        assert status.returncode == 0, status.stderr
    finally:
        run([tidybot, "down"], tmp_path, **user)
