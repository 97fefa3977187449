"""The command line: typos, options, plans, generated configuration."""

import argparse
import configparser
import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from cli import main
from cli.errors import CliError, checked
from cli.processes import plan as plans
from cli.processes import ports, programs, supervision
from cli.processes.services import NAMES, OPTIONAL, SERVICES
from cli.processes.up import comes_to_life
from tests.support import ROOT


def plan(*words: str) -> plans.Plan:
    return plans.Plan(main.parser().parse_args(["up", *words]))


@pytest.mark.parametrize(
    ("words", "hint"),
    [
        (["stauts"], "status"),
        (["up", "--spede", "3"], "--speed"),
        (["up", "--speed", "fast"], "realtime, max or a positive factor"),
        (["up", "--speed", "-1"], "positive factor"),
        (["up", "--only", "navgation"], "'navigation'"),
        (["up", "--set", "navgation.x=1"], "'navigation'"),
        (["up", "--set", "nonsense"], "section.key=value"),
        (["say"], "say what?"),
        (["topic", "echo", "brain/sate", "--connect", "tcp/127.0.0.1:1"], "brain/state"),
        (["topic", "pub", "base/target_pose", "x=1", "y=0", "teta=0"], "'theta'"),
        (["topic", "pub", "base/target_pose", "x=1"], "missing required field"),
        (["topic", "pub", "base/target_pose", "x=far", "y=0", "theta=0"], "base/target_pose carries BaseTarget"),
        (["topic", "pub", "brain/**", "x"], "not one topic"),
        (["demo", "--object", "red mugg"], "'red mug'"),
        (["up", "--pipeline", "fecth"], "'fetch', 'vla'"),
        (["status", "--wait", "NAVIGATNG"], "'NAVIGATING'"),
        (["up", "--namespace", "a/*"], "letters, digits"),
        (["status", "--namespace", "my robot", "--connect", "tcp/127.0.0.1:1"], "letters, digits"),
        (["topic", "echo", "nope", "--connect", "tcp/127.0.0.1:1"], "more"),
        (["keys", "--dir", "/dev/null/keys"], "/dev/null/keys"),
        (["map", "--out", "/dev/null/home"], "/dev/null/home"),
        (["mcp", "--http", "256.1.1.1:80"], "--http 256.1.1.1:80"),
    ],
)
def test_a_mistake_is_one_line_that_names_the_remedy(
    words: list[str], hint: str, capsys: pytest.CaptureFixture[str]
) -> None:
    try:
        code = main.main(words)
    except SystemExit as exit_:
        code = int(str(exit_.code))
    said = capsys.readouterr()
    assert code in (1, 2)
    assert hint in said.err
    assert len(said.err.strip().splitlines()) == 1
    assert said.out == ""


@pytest.mark.parametrize(
    "command", [[], *[[c] for c in ("up", "ps", "say", "status", "topic", "doctor", "demo", "logs")]]
)
def test_every_command_has_help(command: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main.main([*command, "--help"])
    assert ended.value.code == 0
    assert "usage" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("variable", "path"), [("TIDYBOT_CONFIG_DIR", "/dev/null/config"), ("TIDYBOT_STATE_DIR", "/dev/null/state")]
)
def test_a_folder_that_cannot_be_used_is_said_before_anything_starts(
    variable: str, path: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    monkeypatch.setenv("TIDYBOT_RUN_DIR", str(tmp_path))
    monkeypatch.setenv(variable, path)
    assert main.main(["up", "--only", "router", "--port", str(ports.free_port())]) == 1
    said = capsys.readouterr()
    assert path in said.err and said.out == ""


def test_the_help_of_a_command_says_what_it_does(capsys: pytest.CaptureFixture[str]) -> None:
    for words, what in ((["teach"], "Give the thing"), (["places", "rename"], "Give a part another name.")):
        with pytest.raises(SystemExit):
            main.main([*words, "--help"])
        assert what in capsys.readouterr().out


def test_no_router_is_said_with_the_remedy(capsys: pytest.CaptureFixture[str]) -> None:
    port = ports.free_port()
    assert main.main(["status", "--connect", f"tcp/127.0.0.1:{port}"]) == 1
    said = capsys.readouterr().err
    assert "tidybot up" in said and len(said.splitlines()) == 1


def test_another_speed_than_realtime_means_lockstep_with_every_paced_service() -> None:
    fast = plan("--speed", "max", "--without", "camera").environ
    assert fast["TIDYBOT__RUNTIME__LOCKSTEP"] == "true"
    assert fast["TIDYBOT__SIM__SPEED"] == "max"
    expected = [s.name for s in SERVICES if s.paced and s.name not in ("camera", *OPTIONAL)]
    assert json.loads(fast["TIDYBOT__SIM__WAIT_FOR"]) == expected
    assert "brain" in expected and "sim" not in expected and "dashboard" not in expected
    assert "TIDYBOT__RUNTIME__LOCKSTEP" not in plan().environ


def test_who_is_waited_for_in_lockstep_and_comes_later_is_not_waited_for_by_up() -> None:
    fast = plan("--speed", "max")
    assert comes_to_life(fast) and comes_to_life(plan())
    fast.pace(fast.services, "examiner")
    assert json.loads(fast.environ["TIDYBOT__SIM__WAIT_FOR"])[-1] == "examiner"
    assert not comes_to_life(fast)
    assert not comes_to_life(plan("--speed", "max", "--set", 'sim.wait_for=["brain", "mine"]'))
    assert not comes_to_life(plan("--without", "planner"))


def test_options_become_the_environment_of_the_services() -> None:
    words = ("--scene", "minimal", "--seed", "7", "--set", "brain.settle=2.5", "--port", "7999", "--namespace", "kit",
             "--pipeline", "fetch")  # fmt: skip
    environ = plan(*words).environ
    assert environ["TIDYBOT__RUNTIME__SCENE"] == "minimal"
    assert environ["TIDYBOT__RUNTIME__SEED"] == "7"
    assert environ["TIDYBOT__BRAIN__SETTLE"] == "2.5"
    assert environ["TIDYBOT_CONNECT"] == "tcp/127.0.0.1:7999"
    assert environ["TIDYBOT_NAMESPACE"] == "kit"
    assert environ["TIDYBOT__BRAIN__PIPELINE"] == "fetch"
    assert "TIDYBOT__BRAIN__PIPELINE" not in plan().environ


def test_only_and_without_choose_in_the_order_of_the_table() -> None:
    assert plan("--only", "brain,router").names == ["router", "brain"]
    assert plan("--without", "sim").names == [n for n in NAMES if n not in ("sim", *OPTIONAL)]


def test_optional_services_are_started_when_asked_for_and_their_package_is_there(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("cli.processes.plan.importlib.util.find_spec", lambda name: object())
    assert not {*plan().names} & {*OPTIONAL}
    gateways = [n for n in OPTIONAL if n != "mapping"]
    for name in gateways:
        assert plan(f"--{name}").names == [n for n in NAMES if n == name or n not in OPTIONAL]
        assert plan("--only", "router", f"--{name}").names == ["router", name]
    assert plan("--only", "router,mapping").names == ["router", "mapping"], "started by `tidybot map`"
    monkeypatch.setattr("cli.processes.plan.importlib.util.find_spec", lambda name: None)
    for name in OPTIONAL:
        with pytest.raises(CliError, match=rf"pip install 'tidybot-zenoh\[{name}\]'"):
            plan("--only", name)


def test_the_generated_configuration_has_one_program_a_service(tmp_path: Path) -> None:
    directory = tmp_path / "100% run"
    text = programs.render_config(directory, SERVICES, "tcp/127.0.0.1:7001")
    parsed = configparser.RawConfigParser()
    parsed.read_string(text)
    assert [s for s in parsed.sections() if s.startswith("program:")] == [f"program:{n}" for n in (*NAMES, "watchdog")]
    assert "--listen tcp/127.0.0.1:7001" in parsed["program:router"]["command"]
    assert "--listen" not in parsed["program:brain"]["command"]
    assert "100%% run" in parsed["program:brain"]["stdout_logfile"]


def test_the_processes_of_a_run_reach_its_router_through_a_socket_where_that_can_be(tmp_path: Path) -> None:
    def endpoints(directory: Path, connect: str = "tcp/127.0.0.1:7001", services: Any = SERVICES) -> str:
        return programs.endpoints(directory, services, connect)

    near = Path("/run/tidybot")
    assert endpoints(near) == "unixsock-stream//run/tidybot/router.sock,tcp/127.0.0.1:7001"
    assert near.name in programs.render_config(near, SERVICES, "tcp/127.0.0.1:7001").split("--listen")[1].split()[0]
    # Keys need TLS, another router has no socket of ours, Zenoh cuts a path at # and ?, and a long one is no address.
    assert endpoints(near, "tls/127.0.0.1:7001") == "tls/127.0.0.1:7001"
    assert endpoints(near, services=[s for s in SERVICES if s.name != "router"]) == "tcp/127.0.0.1:7001"
    assert endpoints(near / "a#b") == endpoints(near / ("x" * 120)) == "tcp/127.0.0.1:7001"


@pytest.mark.parametrize("port", ["0", "-1", "65536", "http"])
def test_a_port_that_is_none_is_refused_at_once(port: str, capsys: pytest.CaptureFixture[str]) -> None:
    for command in (["up"], ["demo"]):
        with pytest.raises(SystemExit):
            main.main([*command, f"--port={port}"])
        assert "expected 1 to 65535" in capsys.readouterr().err


def test_a_long_run_directory_still_has_a_usable_socket(tmp_path: Path) -> None:
    deep = tmp_path / ("x" * 120)
    assert len(str(programs.socket_path(deep))) <= programs.SOCKET_PATH_LIMIT
    assert programs.socket_path(deep) != programs.socket_path(tmp_path / ("y" * 120))
    assert programs.socket_path(Path("/run/x")).parent == Path("/run/x")


def test_the_run_directory_can_be_named() -> None:
    assert supervision.run_dir({"TIDYBOT_RUN_DIR": "/somewhere/else"}) == Path("/somewhere/else")


def test_a_command_without_a_run_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("TIDYBOT_RUN_DIR", str(tmp_path))
    for words in (["ps"], ["restart", "brain"], ["logs"]):
        assert main.main(words) == 1
        assert "tidybot up" in capsys.readouterr().err
    assert main.main(["down"]) == 0


def declared(parser: argparse.ArgumentParser) -> list[str]:
    (commands,) = (a for a in parser._actions if isinstance(a, argparse._SubParsersAction))
    return list(commands.choices)


def test_each_command_is_declared_where_the_table_says_and_alone_when_it_is_asked_for() -> None:
    assert declared(main.parser()) == [c for known in main.COMMANDS.values() for c in known]
    for known in main.COMMANDS.values():
        for command in known:
            assert declared(main.parser(command)) == list(known)


def test_a_command_that_asks_the_supervisor_does_not_load_the_simulator() -> None:
    asked = "import sys, cli.main; cli.main.parser('ps'); print({'mujoco', 'scipy', 'cryptography'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", asked], capture_output=True, text=True, cwd=ROOT, check=True)
    assert done.stdout == "set()\n"


def test_checked_words() -> None:
    with pytest.raises(CliError, match="known: a, b"):
        checked("zzz", ("a", "b"), "letter")
