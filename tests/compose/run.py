"""`make test-compose`: the compose file as it is, under a real engine, through a mission with two broken nodes."""

import os
import shutil
import signal
import socket
import sys
import tempfile
import time
import urllib.error
import urllib.request
from collections.abc import Callable
from pathlib import Path

from cli.link import Link
from cli.processes.services import NAMES, OPTIONAL
from common.bus.session import open_session
from tests.compose.engine import Engine, download_wheels, install, note, run
from tests.compose.mission import carry_out

ROOT = Path(__file__).resolve().parent.parent.parent
PROJECT, IMAGE, BASE = "tidybot-test", "tidybot-zenoh:dev", "tidybot-base"
NODES = tuple(name for name in NAMES if name != "router" and name not in OPTIONAL)
SPEED = "2"
TOKEN = "a-token-for-this-test"


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


class Stack:
    """The compose file, up."""

    def __init__(self, engine: Engine, port: int, keys: Path) -> None:
        self.engine, self.port, self.keys = engine, port, keys
        self.page = free_port()
        paced = ", ".join(f'"{n}"' for n in NODES if n not in ("sim", "dashboard"))
        self._environ = {
            **engine.environ,
            "ZENOH_IMAGE": IMAGE,
            "TIDYBOT_IMAGE": IMAGE,
            "TIDYBOT_PORT": str(port),
            "TIDYBOT_KEYS_DIR": str(keys),
            "TIDYBOT_SPEED": SPEED,
            "TIDYBOT_LOCKSTEP": "true",
            "TIDYBOT_WAIT_FOR": f"[{paced}]",
            "TIDYBOT_PAGE_PORT": str(self.page),
            "TIDYBOT_PAGE_TOKEN": TOKEN,
        }

    def compose(self, *words: str, timeout: float = 300) -> str:
        files = ["-f", ROOT / "docker-compose.yml", "-f", ROOT / "tests" / "compose" / "override.yml"]
        return run(["docker-compose", "-p", PROJECT, *files, *words], timeout, env=self._environ, cwd=ROOT)

    def container(self, name: str) -> str:
        # Not by docker-compose, which takes seconds to start.
        labels = (f"label=com.docker.compose.project={PROJECT}", f"label=com.docker.compose.service={name}")
        return self.engine.docker("ps", "-aq", *(w for label in labels for w in ("--filter", label))).split()[-1]

    def state(self, name: str) -> dict[str, object]:
        found = self.engine.inspect(self.container(name))["State"]
        assert isinstance(found, dict)
        return found

    def kill(self, name: str) -> None:
        """-9 from outside, as the kernel does when memory runs out."""
        before = self.state(name)["Pid"]
        note(f"kill -9 of {name} (pid {before})")
        os.kill(int(str(before)), signal.SIGKILL)
        wait_until(
            lambda: self.state(name)["Running"] and self.state(name)["Pid"] not in (0, before), f"{name} is back"
        )
        note(f"{name} was restarted by the engine")

    def restart(self, name: str) -> None:
        note(f"docker-compose restart {name}")
        self.compose("restart", name)

    def healthy(self) -> bool:
        return all(dict(self.state(n).get("Health", {}) or {}).get("Status") == "healthy" for n in NODES)  # type: ignore[call-overload]

    def logs(self) -> str:
        return self.compose("logs", "--no-color", "--tail=60")


def wait_until(done: Callable[[], object], what: str, patience: float = 90) -> None:
    end = time.monotonic() + patience
    while not done():
        if time.monotonic() > end:
            raise AssertionError(f"not within {patience:.0f} s: {what}")
        time.sleep(0.5)


def build(engine: Engine) -> None:
    engine.base_image(BASE)
    download_wheels(ROOT / "requirements.image.lock", ROOT / "build" / "wheels")
    note("docker build")
    began = time.monotonic()
    arguments = ["--build-arg", f"BASE_IMAGE={BASE}", "--build-arg", "APT_PACKAGES="]
    engine.docker("build", "--network", "host", *arguments, "-t", IMAGE, ROOT, timeout=1500)
    size = int(engine.docker("image", "inspect", "--format", "{{.Size}}", IMAGE))
    base = int(engine.docker("image", "inspect", "--format", "{{.Size}}", BASE))
    note(f"built in {time.monotonic() - began:.0f} s, {size / 1e6:.0f} MB, {base / 1e6:.0f} MB of it the base image")


def confined(stack: Stack) -> None:
    """No node is root, can become it, or can change its image."""
    for name in NODES:
        script = "id -u; touch /app/x || touch /opt/x || touch /var/x || echo refused"
        told = stack.engine.docker("exec", stack.container(name), "sh", "-c", f"{{ {script}; }} 2>/dev/null").split()
        assert told == ["10001", "refused"], f"{name}: {told}"
    note("every node is user 10001 on a read-only file system")


def page_is_served(stack: Stack) -> None:
    """With the token only."""
    address = f"http://127.0.0.1:{stack.page}/"
    opener = urllib.request.build_opener(urllib.request.HTTPCookieProcessor())
    with opener.open(f"{address}?token={TOKEN}", timeout=20) as answer:
        assert b"<html" in answer.read().lower()
    try:
        urllib.request.urlopen(address, timeout=20).close()
    except urllib.error.HTTPError as error:
        assert error.code in (401, 403), error.code
    else:
        raise AssertionError("the page is served without its token")
    note("the page is served")


def mission(stack: Stack) -> None:
    note("docker-compose up")
    began = time.monotonic()
    stack.compose("up", "-d", "--no-build")
    connect = f"tls/127.0.0.1:{stack.port}"
    os.environ["TIDYBOT_KEYS"] = str(stack.keys)
    with open_session(connect, patience=60) as session:
        link = Link(session, connect)
        wait_until(lambda: set(NODES) <= link.alive(), "every node is alive")
        note(f"every node alive {time.monotonic() - began:.1f} s after `up`")
        disturb = {"NAVIGATING": lambda: stack.kill("navigation"), "RETURNING": lambda: stack.restart("navigation")}
        verdict = carry_out(link, "red mug", disturb, timeout=600)
        assert verdict.delivered, verdict.why
        note(f"delivered: {verdict.why}")
    wait_until(stack.healthy, "every healthcheck says healthy", 180)
    note("every container healthy")
    confined(stack)
    page_is_served(stack)


def main() -> int:
    if os.geteuid() != 0 or shutil.which("apt-get") is None:
        print("test-compose needs root on Debian or Ubuntu: it starts a Docker engine of its own", file=sys.stderr)
        return 1
    cache = Path(os.environ.get("TIDYBOT_CACHE", "/var/cache/tidybot"))
    cache.mkdir(parents=True, exist_ok=True)
    install()
    work = Path(tempfile.mkdtemp(prefix="tidybot-engine-"))
    engine = Engine(cache, work)
    try:
        engine.start()
        (work / "keys").mkdir()
        stack = Stack(engine, free_port(), work / "keys")
        stack.compose("down", "--volumes", "--remove-orphans", "--timeout", "2")
        build(engine)
        try:
            mission(stack)
        except BaseException:
            print(stack.logs(), flush=True)
            raise
        finally:
            note("docker-compose down")
            stack.compose("down", "--volumes", "--remove-orphans")
        print("compose: passed")
    finally:
        engine.stop()
        shutil.rmtree(work, ignore_errors=True)
    return 0


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, lambda number, frame: sys.exit(143))
    sys.exit(main())
