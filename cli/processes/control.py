"""`tidybot down`, `ps`, `restart`, `logs`: the processes of a run."""

import argparse
import sys
from collections.abc import Iterator
from pathlib import Path

from cli.errors import CliError, checked
from cli.link import Link, use_keys
from cli.output import show
from cli.processes.services import NAMES
from cli.processes.supervision import WORLD, Supervision, run_dir
from common.bus.session import BusError, open_session
from common.security.keys import OFF
from common.time.clock import monotonic, sleep


def down(args: argparse.Namespace) -> int:
    if Supervision(run_dir()).stop():
        print("stopped")
    else:
        print("nothing was up")
    return 0


def rows(supervision: Supervision) -> list[dict[str, object]]:
    """What `tidybot ps --json` prints.

    Raises:
        CliError: nothing is up.
    """
    processes = supervision.processes()
    info = supervision.info()
    alive, health = set[str](), {}
    try:
        use_keys(info.keys or OFF)
        with open_session(info.connect, info.namespace, patience=1.0) as session:
            link = Link(session, info.connect)
            # The router has no token of its own: this session shows that it is alive.
            alive, health = link.alive() | {"router"}, link.health()
    except BusError:
        pass
    found: list[dict[str, object]] = []
    for p in processes:
        record = health.get(p.name)
        record = record if record is not None and record.pid == p.pid else None
        present = p.name in alive and p.pid > 0
        state = "running" if present and p.state == "starting" else p.state
        rss, pss = memory(p.pid)
        row = {"name": p.name, "pid": p.pid, "state": state, "restarts": p.restarts, "alive": present, "rss_mb": rss}
        found.append({**row, "pss_mb": pss, "epoch": record.epoch if record else "", "detail": p.detail})
    return found


def memory(pid: int) -> tuple[float, float]:
    """Resident memory of a process [MB], and in proportion, where what n processes share counts 1/n; 0 of none."""
    try:
        text = Path(f"/proc/{pid}/smaps_rollup").read_text(encoding="ascii")
    except OSError:
        return 0.0, 0.0
    sizes = {line.partition(":")[0]: line.split()[1] for line in text.splitlines()[1:]}
    return round(float(sizes.get("Rss", 0)) / 1024, 1), round(float(sizes.get("Pss", 0)) / 1024, 1)


def ps(args: argparse.Namespace) -> int:
    found = rows(Supervision(run_dir()))
    show(args, found, _table(found))
    return 0


def _table(found: list[dict[str, object]]) -> Iterator[str]:
    yield f"{'name':13} {'pid':>7}  {'state':9} {'restarts':>8}  {'alive':5} {'MB':>7}  epoch"
    for r in found:
        alive = "yes" if r["alive"] else "no"
        tail = r["detail"] or r["epoch"]
        yield f"{r['name']:13} {r['pid']:>7}  {r['state']:9} {r['restarts']:>8}  {alive:5} {r['pss_mb']:>7}  {tail}"
    yield f"{'':42} total {sum(float(str(r['pss_mb'])) for r in found):>7.1f}"


def restart(args: argparse.Namespace) -> int:
    supervision = Supervision(run_dir())
    checked(args.service, supervision.info().services, "service")
    before = next((r["epoch"] for r in rows(supervision) if r["name"] == args.service), "")
    if args.fresh and args.service != "sim":
        raise CliError(f"--fresh begins a new world: it goes with sim, not with {args.service}")
    supervision.restart(args.service, forget=supervision.directory / WORLD if args.fresh else None)
    end = monotonic() + args.timeout
    while monotonic() < end:
        row = next(r for r in rows(supervision) if r["name"] == args.service)
        if row["state"] == "failed":
            break
        if row["pid"] and (args.service == "router" or (row["alive"] and row["epoch"] not in ("", before))):
            print(f"{args.service} restarted, pid {row['pid']}")
            return 0
        sleep(0.1)
    lines = "\n".join(f"    {line}" for line in supervision.tail(args.service))
    raise CliError(f"{args.service} did not come back within {args.timeout:.0f} s; its last words:\n{lines}")


def logs(args: argparse.Namespace) -> int:
    supervision = Supervision(run_dir())
    names = [checked(args.service, (*NAMES, "supervisord"), "service")] if args.service else list(NAMES)
    files = {n: supervision.log_path(n) for n in names}
    present = {n: p for n, p in files.items() if p.exists()}
    if not present:
        raise CliError(f"no logs in {supervision.directory / 'logs'}; start with `tidybot up`")
    lines: list[tuple[float, str]] = []
    for name in present:
        lines += [(_time(line), line) for line in supervision.tail(name, args.lines)]
    if len(present) > 1:
        lines.sort(key=lambda one: one[0])
    for _, line in lines[-args.lines :]:
        print(line)
    if args.follow:
        _follow(files)
    return 0


def _time(line: str) -> float:
    """Robot time at the start of a log line; lines without one (a traceback) sort first."""
    try:
        return float(line[:10])
    except ValueError:
        return -1.0


def _follow(files: dict[str, Path]) -> None:
    """Print what is appended, through rotation, until interrupted."""
    at = {name: path.stat().st_size if path.exists() else 0 for name, path in files.items()}
    while True:
        for name, path in files.items():
            size = path.stat().st_size if path.exists() else 0
            if size < at[name]:
                at[name] = 0
            if size > at[name]:
                with path.open("rb") as log:
                    log.seek(at[name])
                    text = log.read()
                at[name] += len(text)
                sys.stdout.write(text.decode(errors="replace"))
                sys.stdout.flush()
        sleep(0.1)


def register(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = commands.add_parser("down", help="stop everything that `up` started")
    parser.set_defaults(run=down)
    parser = commands.add_parser("ps", help="the processes: state, restarts, memory")
    parser.add_argument("--json", action="store_true", help="as JSON")
    parser.set_defaults(run=ps)
    parser = commands.add_parser("restart", help="restart one service; the others go on")
    parser.add_argument("service")
    parser.add_argument("--fresh", action="store_true", help="sim: begin a new world instead of going on with this one")
    parser.add_argument("--timeout", type=float, default=20.0, metavar="S", help="how long it may take [s]")
    parser.set_defaults(run=restart)
    parser = commands.add_parser("logs", help="what the services wrote")
    parser.add_argument("service", nargs="?")
    parser.add_argument("--follow", "-f", action="store_true", help="go on with what is appended")
    parser.add_argument("--lines", "-n", type=int, default=40, help="how many of the last lines (default %(default)s)")
    parser.set_defaults(run=logs)
