"""The compose file's own commands and environment, as local processes, through a mission with a broken node."""

import os
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml

from cli.link import Link
from cli.processes.ports import free_port
from cli.processes.services import NAMES, OPTIONAL
from common.bus.session import open_session
from evaluation.site import PATIENCE, end, eventually
from tests.compose.mission import carry_out
from tests.support import ROOT

NODES = tuple(name for name in NAMES if name != "router" and name not in OPTIONAL)
SHELL = {
    "TIDYBOT_SPEED": "8",
    "TIDYBOT_LOCKSTEP": "true",
    "TIDYBOT_WAIT_FOR": '["camera", "navigation", "manipulation", "speech", "planner", "perception", "brain"]',
}


def filled(value: Any, shell: dict[str, str]) -> Any:
    """`${NAME:-default}` as docker compose fills it."""
    if isinstance(value, dict):
        return {k: filled(v, shell) for k, v in value.items()}
    if isinstance(value, list):
        return [filled(v, shell) for v in value]
    if isinstance(value, str):
        return re.sub(r"\$\{(\w+):-([^}]*)\}", lambda found: shell.get(found[1]) or found[2], value)
    return value


@pytest.fixture
def compose() -> dict[str, Any]:
    services: dict[str, Any] = filled(yaml.safe_load((ROOT / "docker-compose.yml").read_text()), SHELL)["services"]
    return services


def test_each_node_is_a_container_with_a_healthcheck_and_comes_back(compose: dict[str, Any]) -> None:
    started = {name: service for name, service in compose.items() if "profiles" not in service}
    assert set(started) == {"keys", "router", *NODES}
    for name in OPTIONAL:
        assert compose[name]["profiles"] == [name]
    for name, service in {**started, **{name: compose[name] for name in OPTIONAL}}.items():
        if name == "keys":
            continue
        assert service["restart"] == "unless-stopped"
        for port in service.get("ports", []):
            assert port.startswith("127.0.0.1:"), f"{name} publishes {port} beyond this machine"
        if name != "router":
            assert service["command"] == ["python", "-m", f"services.{name}"]
            assert service["healthcheck"]["test"] == ["CMD", "python", "-m", "cli.healthcheck", name]
            assert service["environment"]["TIDYBOT_CONNECT"] == "tls/router:7447"


def test_each_container_sees_its_own_certificate_only(compose: dict[str, Any]) -> None:
    for name in ("router", *NODES, *OPTIONAL):
        keys = [v for v in compose[name]["volumes"] if v.split(":")[1].startswith("/keys")]
        folder = name if name == "router" else f"./{name}"
        assert keys == [f"./run/keys/{folder}:/keys:ro"]
        assert compose[name]["depends_on"]["keys"] == {"condition": "service_completed_successfully"}
    assert compose["keys"]["network_mode"] == "none", "the authority's key is out of reach"


def test_the_router_is_of_the_version_of_our_wheel(compose: dict[str, Any]) -> None:
    wheel = re.search(r"^eclipse-zenoh==(\S+)", (ROOT / "requirements.lock").read_text(), re.MULTILINE)
    assert wheel is not None
    assert compose["router"]["image"] == f"eclipse/zenoh:{wheel[1]}"


def test_the_language_model_is_a_profile_that_only_the_planner_reaches(compose: dict[str, Any]) -> None:
    model, planner = compose["llm"], compose["planner"]["environment"]
    assert model["profiles"] == ["llm"] and "ports" not in model
    port = model["command"][model["command"].index("--port") + 1]
    assert planner["TIDYBOT__PLANNER__LLM_URL"] == f"http://llm:{port}/v1"
    assert planner["TIDYBOT__PLANNER__BACKEND"] == "auto"


def test_no_variable_is_left_unfilled(compose: dict[str, Any]) -> None:
    assert "${" not in str(compose)


class Containers:
    """The services of the compose file as processes of this machine; the host `router` is our own."""

    def __init__(self, compose: dict[str, Any], logs: Path) -> None:
        self._compose, self._logs = compose, logs
        self.port = free_port()
        self.connect = f"tls/127.0.0.1:{self.port}"
        self.keys = logs / "keys"
        self.running: dict[str, subprocess.Popen[bytes]] = {}

    def environment(self, name: str) -> dict[str, str]:
        clean = {k: v for k, v in os.environ.items() if not k.startswith("TIDYBOT")}
        declared = {k: str(v).lower() if isinstance(v, bool) else str(v) for k, v in self._declared(name).items()}
        return {**clean, "PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1", **declared}

    def _declared(self, name: str) -> dict[str, Any]:
        here = f"127.0.0.1:{self.port}"
        declared = self._compose[name].get("environment", {})
        mounted = {k: v.replace("router:7447", here) if isinstance(v, str) else v for k, v in declared.items()}
        ours = {"TIDYBOT_KEYS": self.keys / name, "TIDYBOT_STATE_DIR": self._logs / "data" / name}
        return {**mounted, **{k: str(path) for k, path in ours.items() if k in mounted}}

    def make_keys(self) -> None:
        """What the container `keys` does, for the user that the tests run as."""
        words = [w.replace("=/keys", f"={self.keys}") for w in self._compose["keys"]["command"]]
        words = [w.replace("=10001", f"={os.getuid()}") for w in words]
        command = [sys.executable, *words[1:]]
        subprocess.run(command, env=self.environment("keys"), cwd=ROOT, check=True, capture_output=True)

    def start(self, name: str) -> None:
        service = self._compose[name]
        words = list(service["command"])
        if name == "router":
            # The image's entry point is a router; its files are ours, mounted.
            words = [w.replace("/keys/", f"{self.keys / name}/") for w in words]
            words = [w.replace("0.0.0.0:7447", f"127.0.0.1:{self.port}") for w in words]
            words = ["python", "-m", "services.router", *words]
        log = (self._logs / f"{name}.log").open("ab")
        command = [sys.executable, *words[1:]]
        self.running[name] = subprocess.Popen(
            command, env=self.environment(name), stdout=log, stderr=subprocess.STDOUT, cwd=ROOT
        )
        log.close()

    def healthy(self, name: str) -> bool:
        words = self._compose[name]["healthcheck"]["test"]
        command = [sys.executable, *words[2:]]
        return subprocess.run(command, env=self.environment(name), cwd=ROOT, capture_output=True).returncode == 0

    def kill(self, name: str) -> None:
        """What `restart: unless-stopped` makes of a crash."""
        self.running[name].send_signal(signal.SIGKILL)
        self.running[name].wait()
        self.start(name)

    def restart(self, name: str) -> None:
        self.running[name].terminate()
        assert self.running[name].wait(PATIENCE) == 0
        self.start(name)

    def close(self) -> None:
        end(reversed(self.running.values()))


@pytest.fixture
def containers(compose: dict[str, Any], tmp_path: Path) -> Iterator[Containers]:
    opened = Containers(compose, tmp_path)
    try:
        yield opened
    finally:
        opened.close()


@pytest.mark.slow
@pytest.mark.timeout(400)
def test_a_mission_survives_a_killed_and_a_restarted_navigation(
    containers: Containers, monkeypatch: pytest.MonkeyPatch
) -> None:
    containers.make_keys()
    monkeypatch.setenv("TIDYBOT_KEYS", str(containers.keys))
    # A node may come before the router, as containers do.
    for name in ("brain", "router", *(n for n in NODES if n != "brain")):
        containers.start(name)
    with open_session(containers.connect, patience=60) as session:
        link = Link(session, containers.connect)
        eventually(lambda: set(NODES) <= link.alive(), f"all of {NODES} are alive", 120)
        disturb = {
            "NAVIGATING": lambda: containers.kill("navigation"),
            "RETURNING": lambda: containers.restart("navigation"),
        }
        verdict = carry_out(link, "red mug", disturb, timeout=240)
        assert verdict.delivered, verdict.why
    for name in NODES:
        assert containers.healthy(name), name
    containers.kill("camera")
    containers.running["camera"].kill()
    containers.running["camera"].wait()
    assert not containers.healthy("camera")
