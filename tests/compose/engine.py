"""A Docker engine of our own, for a machine that has none: packages, daemon, base image. Root on Debian or Ubuntu."""

import json
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path

PACKAGES = ("docker.io", "containerd", "runc", "docker-compose", "debootstrap")
NEEDED = ("dockerd", "containerd", "runc", "docker-compose", "debootstrap")
SUITE = "bookworm"
MIRROR = "http://deb.debian.org/debian"


def note(text: str) -> None:
    print(f"--- {text}", flush=True)


def run(command: Sequence[str | Path], timeout: float = 900, quiet: bool = False, **options: object) -> str:
    """Run to the end; its output when that is an error."""
    words = [str(w) for w in command]
    done = subprocess.run(
        words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=timeout, errors="replace", **options
    )  # type: ignore[call-overload]
    if done.returncode:
        raise RuntimeError(f"{' '.join(words)} ended with {done.returncode}:\n{done.stdout[-4000:]}")
    return str(done.stdout)


def install() -> None:
    """The engine's packages, when they are missing."""
    if all(shutil.which(n) for n in NEEDED):
        return
    note(f"installing {', '.join(PACKAGES)}")
    environment = {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}
    run(["apt-get", "update", "-qq"], env=environment)
    run(["apt-get", "install", "-y", "-qq", "--no-install-recommends", *PACKAGES], env=environment)


class Engine:
    """dockerd with its own data, socket and network settings; nothing of it is left running after `stop`."""

    def __init__(self, cache: Path, work: Path) -> None:
        self._data, self._work = cache / "docker", work
        self.cache = cache
        self.host = f"unix://{work}/docker.sock"
        self._process: subprocess.Popen[bytes] | None = None

    @property
    def environ(self) -> dict[str, str]:
        return {**os.environ, "DOCKER_HOST": self.host, "DOCKER_BUILDKIT": "0", "COMPOSE_DOCKER_CLI_BUILD": "0"}

    def start(self) -> None:
        note("starting dockerd")
        log = (self._work / "dockerd.log").open("wb")
        self._process = subprocess.Popen(
            [
                "dockerd",
                f"--data-root={self._data}",
                f"--exec-root={self._work}/exec",
                f"--pidfile={self._work}/docker.pid",
                f"--host={self.host}",
                "--iptables=false",
                "--ip-masq=false",
                "--bridge=none",
                "--storage-driver=overlay2",
            ],
            stdout=log,
            stderr=log,
            stdin=subprocess.DEVNULL,
            start_new_session=True,
        )
        log.close()
        end = time.monotonic() + 60
        while subprocess.run(["docker", "info"], env=self.environ, capture_output=True).returncode:
            if self._process.poll() is not None or time.monotonic() > end:
                words = (self._work / "dockerd.log").read_text(errors="replace")[-3000:]
                raise RuntimeError(f"dockerd does not start:\n{words}")
            time.sleep(0.3)

    def docker(self, *words: str | Path, timeout: float = 900) -> str:
        return run(["docker", *words], timeout, env=self.environ)

    def inspect(self, container: str) -> dict[str, object]:
        found: dict[str, object] = json.loads(self.docker("inspect", container))[0]
        return found

    def base_image(self, tag: str) -> None:
        """A minimal Debian with Python, made once and kept."""
        if self.docker("images", "-q", tag).strip():
            return
        archive = self.cache / "base.tar"
        if not archive.exists():
            note("debootstrap of the base image (once)")
            root = self.cache / "base"
            shutil.rmtree(root, ignore_errors=True)
            include = "--include=python3,python3-venv,ca-certificates"
            run(["debootstrap", "--variant=minbase", include, SUITE, root, MIRROR], 1800)
            run(["tar", "-C", root, "-cf", f"{archive}.part", "."])
            Path(f"{archive}.part").rename(archive)
            shutil.rmtree(root)
        self.docker("import", archive, tag)

    def stop(self) -> None:
        if self._process is not None and self._process.poll() is None:
            self._process.terminate()
            try:
                self._process.wait(30)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
        # dockerd leaves the network namespaces of its containers mounted.
        for left in (self._work / "exec" / "netns").glob("*"):
            subprocess.run(["umount", str(left)], capture_output=True)


def download_wheels(lock: Path, wheels: Path) -> None:
    """Everything the image needs, for the Python of the base image, as this machine's pip is set up to get it."""
    stamp = wheels / ".for"
    wanted = lock.read_text()
    if stamp.exists() and stamp.read_text() == wanted:
        return
    note("downloading wheels")
    shutil.rmtree(wheels, ignore_errors=True)
    wheels.mkdir(parents=True)
    pip = [sys.executable, "-m", "pip", "download", "--quiet", "--only-binary=:all:", "--no-deps"]
    run([*pip, "--python-version=3.11", "--implementation=cp", "--dest", wheels, "-r", lock])
    stamp.write_text(wanted)
