"""Cases on a Dask cluster: two machines, one of whose workers is lost in mid-case; other code; nobody there."""

import signal
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

from cli.errors import CliError
from evaluation import runner
from evaluation.case import Result
from evaluation.site import eventually
from evaluation.suites.table import cases
from evaluation.workers import cluster, pool
from tests.network import Machine, Network, network

pytestmark = [
    pytest.mark.slow,
    pytest.mark.timeout(1200),
    pytest.mark.skipif(find_spec("distributed") is None, reason=f"needs Dask: {cluster.INSTALL}"),
]
PORT = 8786
TTL = "10s"
"""Without a heartbeat for so long the scheduler counts a worker as lost; they beat every 0.5 s."""
UNTIMED = {"wall_seconds"}
ENVIRON = {"DASK_DISTRIBUTED__SCHEDULER__WORKER_TTL": TTL, "PYTHONWARNINGS": "ignore"}


@pytest.fixture
def hosts(tmp_path: Path) -> Iterator[Network]:
    with network(tmp_path) as found:
        scheduler = ("scheduler", "--host", "0.0.0.0", "--port", str(PORT), "--no-dashboard", "--no-jupyter")
        found.one.start("dask", *scheduler, label="scheduler", **ENVIRON)
        for machine in (found.one, found.two):
            worker(machine, found.one.address, "worker")
        for machine in (found.one, found.two):
            eventually(lambda m=machine: "Starting established" in m.log("worker"), "the worker joins", patience=120)
        yield found


def worker(machine: Machine, scheduler: str, label: str, **environ: str) -> None:
    words = ("worker", f"tcp://{scheduler}:{PORT}", "--no-nanny", "--nthreads", "1", "--no-dashboard")
    machine.start("dask", *words, label=label, **ENVIRON, **environ)


def rows(results: list[Result]) -> list[Any]:
    """The report without what a clock on the wall says."""
    found = []
    for r in sorted(results, key=lambda r: r.seed):
        evidence = {k: v for k, v in r.evidence.items() if k not in UNTIMED}
        found.append((r.seed, r.command, r.outcome, r.cause, r.spl, r.sim_seconds, evidence))
    return found


@pytest.mark.parametrize("loss", [signal.SIGKILL, signal.SIGSTOP])
def test_a_worker_that_is_lost_costs_a_repeat_and_the_report_is_that_of_the_local_run(
    hosts: Network, loss: signal.Signals
) -> None:
    todo = cases("commands", 4, 21)
    address, lost = f"tcp://{hosts.door}:{PORT}", ""
    results, again, used = [], [], set()
    for said in cluster.evaluate(todo, address, 1, runner.run):
        if isinstance(said, Result):
            results.append(said)
        elif isinstance(said, pool.Repeated):
            again.append(said)
        else:
            used.add(said.worker.split("/")[-1].split(":")[0])
            if not lost and hosts.two.address in said.worker and said.t > 2.0:
                lost = said.worker
                hosts.two.processes["worker"].send_signal(loss)
    assert used == {hosts.one.address, hosts.two.address}
    assert lost and [r.why for r in again] == [f"the worker at {lost} was lost"]
    local = [r for r in pool.evaluate(todo, 2, runner.run) if isinstance(r, Result)]
    for one, two in zip(rows(results), rows(local), strict=True):
        assert one[:6] == two[:6]
        assert {k: (v, two[6].get(k)) for k, v in one[6].items() if v != two[6].get(k)} == {}
    assert all(r.met for r in local)
    hosts.two.processes["worker"].kill()


def test_a_worker_with_other_code_is_named(hosts: Network, tmp_path: Path) -> None:
    (tmp_path / "planner.toml").write_text("max_steps = 7\n")
    worker(hosts.two, hosts.one.address, "other", TIDYBOT_CONFIG_DIR=str(tmp_path))
    eventually(lambda: "Starting established" in hosts.two.log("other"), "the worker joins", patience=120)
    with pytest.raises(CliError, match=rf"worker at tcp://{hosts.two.address}:\d+ runs other code: tidybot"):
        list(cluster.evaluate(cases("commands", 1, 22), f"tcp://{hosts.door}:{PORT}", 1, runner.run))
