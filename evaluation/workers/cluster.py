"""Cases on a Dask cluster: each task runs its case in a lane of its worker, as the local pool does.

Dask gives the case of a worker that is lost to another one; after `allowed-failures` of them (3 by its default) the
case is `crashed`. A worker whose heartbeat stops for `worker-ttl` counts as lost. What hangs inside a worker is the
lane's business. The traffic is Dask's own, pickles included: a cluster is for machines that trust each other.
"""

import atexit
import logging
import signal
import uuid
from asyncio import CancelledError
from collections.abc import Generator, Iterator
from contextlib import contextmanager
from queue import SimpleQueue
from threading import Lock
from typing import Any

import msgspec

from cli.errors import CliError
from evaluation.case import Case, Observed, Result
from evaluation.verdict import judge
from evaluation.workers.fingerprint import difference, fingerprint
from evaluation.workers.lane import Lane, LaneClosed, Run, name_of
from evaluation.workers.pool import Progressed, Repeated, Said

INSTALL = "pip install 'tidybot-zenoh[cluster]'"
REACH = 15.0
"""Time [s] to reach the scheduler before the address counts as wrong."""
LOCAL = {
    "distributed.scheduler.worker-ttl": "60s",
    "distributed.worker.preload": ["evaluation.workers.cluster"],
    "distributed.nanny.pre-spawn-environ.DASK_LOGGING__DISTRIBUTED": "critical",
}
"""Dask's settings for `--cluster local`: a worker is lost after 60 s without a heartbeat (one comes every 0.5 s, later
on an overloaded machine); `dask_setup` runs in it; it prints nothing, for the client says what becomes of cases."""


class Mismatch(RuntimeError):
    """A worker runs other code than the client."""


def evaluate(cases: list[Case], address: str, jobs: int, run: Run) -> Generator[Said, None, None]:
    """Run cases on the workers of the scheduler at `address`, as `pool.evaluate`; `local` starts `jobs` of them here.

    Raises:
        CliError: Dask is missing, nobody answers at the address, no worker, or one with other code.
    """
    with _client(address, jobs) as client:
        _check(client)
        yield from _evaluate(client, cases, run)


@contextmanager
def _client(address: str, jobs: int) -> Iterator[Any]:
    try:
        import dask
        import distributed
    except ImportError:
        raise CliError(f"--cluster needs Dask: {INSTALL}") from None
    # What it warns of is told as repeats of cases.
    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    if address == "local":
        with (
            dask.config.set(LOCAL),
            distributed.LocalCluster(
                n_workers=jobs, threads_per_worker=1, host="127.0.0.1", dashboard_address=None, memory_limit=None
            ) as cluster,
            distributed.Client(cluster) as client,
        ):
            yield client
        return
    try:
        client = distributed.Client(address, timeout=REACH, set_as_default=False)
    except (OSError, TimeoutError, ValueError) as error:
        why = str(error).partition("\n")[0] or type(error).__name__
        raise CliError(f"no Dask scheduler at {address} ({why}); start one: dask scheduler --host HOST") from None
    try:
        yield client
    finally:
        client.close()


def dask_setup(worker: Any) -> None:
    """Dask calls this in a worker of `--cluster local`: Ctrl-C at the terminal is for the client alone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _check(client: Any) -> None:
    """Every worker has the client's code.

    Raises:
        CliError: which one has not, or that there is none.
    """
    workers = client.scheduler_info(n_workers=-1)["workers"]
    if not workers:
        address = client.scheduler.address
        raise CliError(f"the scheduler at {address} has no worker; start some: dask worker {address}")
    ours = fingerprint()
    for address, theirs in client.run(fingerprint, on_error="return").items():
        if isinstance(theirs, Exception):
            raise CliError(f"the worker at {address} cannot load tidybot ({theirs}); install the same version there")
        if theirs != ours:
            raise CliError(f"the worker at {address} {difference(ours, theirs)}; install the same version there")


def _evaluate(client: Any, cases: list[Case], run: Run) -> Generator[Said, None, None]:
    import distributed

    name = f"tidybot-eval-{uuid.uuid4().hex[:12]}"
    arrived = SimpleQueue[Any]()
    client.subscribe_topic(name, lambda event: arrived.put(event[1]))
    where, ours, encode = name_of(run), fingerprint(), msgspec.msgpack.encode
    futures = {}
    for number, case in enumerate(cases):
        words = (name, number, encode(case), where, ours)
        future = client.submit(work, *words, key=f"{name}-{number}", pure=False)
        future.add_done_callback(lambda done, number=number: arrived.put((number, done)))
        futures[number] = future
    owner: dict[int, str] = {}
    try:
        while futures:
            said = arrived.get()
            if isinstance(said, dict):
                number = said["number"]
                if number not in futures:
                    continue
                before = owner.get(number, said["worker"])
                owner[number] = said["worker"]
                if before != said["worker"]:
                    yield Repeated(cases[number], f"the worker at {before} was lost")
                if "lost" in said:
                    yield Repeated(cases[number], said["lost"])
                else:
                    yield Progressed(said["worker"], cases[number], said["t"], said["state"])
                continue
            number, future = said
            if futures.pop(number, None) is None:
                continue
            yield _outcome(future, cases[number], distributed.KilledWorker)
    finally:
        client.unsubscribe_topic(name)
        if futures:
            client.cancel(list(futures.values()), force=True)
        if client.status == "running":
            client.run(abandon, name, on_error="ignore")


def _outcome(future: Any, case: Case, killed: type[Exception]) -> Result:
    try:
        error = future.exception()
    except CancelledError as cancelled:
        error = cancelled
    if error is None:
        return msgspec.msgpack.decode(future.result(), type=Result)
    if isinstance(error, Mismatch):
        raise CliError(str(error))
    if isinstance(error, killed):
        return judge(case, Observed(crash="the case was lost with every worker that tried it"), 0.0)
    if isinstance(error, (CancelledError, OSError)):
        raise CliError("the scheduler was lost; the cases that came back are in the report") from error
    raise error


# --- on the workers
_lanes: dict[str, list[Lane]] = {}
_running: dict[str, list[Lane]] = {}
_lock = Lock()


def work(name: str, number: int, case: bytes, run: str, ours: dict[str, str]) -> bytes:
    """Run one case in a lane of this worker: encoded case in, encoded result out.

    Raises:
        Mismatch: this worker joined with other code than the client's.
    """
    from distributed import get_worker

    here = get_worker()
    if (own := fingerprint()) != ours:
        raise Mismatch(f"the worker at {here.address} {difference(ours, own)}; install the same version there")

    def tell(**words: Any) -> None:
        here.log_event(name, {"number": number, "worker": here.address, **words})

    lane = _take(name, run)
    try:
        found = lane.run(
            msgspec.msgpack.decode(case, type=Case),
            lambda t, state: tell(t=t, state=state),
            lambda why: tell(lost=why),
        )
    except LaneClosed:
        raise RuntimeError("the run was given up") from None
    finally:
        _give_back(name, lane)
    return msgspec.msgpack.encode(found)


def _take(name: str, run: str) -> Lane:
    """A lane for one thread of this worker; idle ones of earlier runs are ended."""
    with _lock:
        old = [lane for other in list(_lanes) if other != name for lane in _lanes.pop(other)]
        idle = _lanes.setdefault(name, [])
        lane = idle.pop() if idle else Lane(run)
        _running.setdefault(name, []).append(lane)
    for each in old:
        each.close()
    return lane


def _give_back(name: str, lane: Lane) -> None:
    with _lock:
        _running[name].remove(lane)
        if not lane.closed:
            _lanes.setdefault(name, []).append(lane)


def abandon(name: str) -> None:
    """End the lanes of a run that nobody waits for any more."""
    with _lock:
        lanes = _lanes.pop(name, []) + _running.get(name, [])
    for lane in lanes:
        lane.close()


@atexit.register
def _end() -> None:
    for name in {*_lanes, *_running}:
        abandon(name)
