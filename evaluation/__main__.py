"""`python -m evaluation`, which `tidybot eval` becomes: the options are declared in `cli/evaluate.py`."""

import argparse
import sys
from collections import Counter
from collections.abc import Generator
from contextlib import closing
from pathlib import Path

import msgspec
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TaskID, TextColumn, TimeElapsedColumn

from cli.errors import CliError, checked
from cli.main import FAILED, INTERRUPTED, parser
from cli.processes.plan import machine
from cli.processes.up import Stopped, interruptible
from common.config import ConfigError
from common.time.clock import monotonic
from evaluation import processes, runner
from evaluation.case import Case, Result
from evaluation.faults.processes import unavailable
from evaluation.report import html as html_report
from evaluation.report import text as report
from evaluation.stack import replacement
from evaluation.suites import worlds
from evaluation.suites.table import SUITES, WORLD_BAR, cases, dressed
from evaluation.workers import cluster, pool
from evaluation.workers.lane import Run
from evaluation.workers.pool import Progressed, Repeated, Said

PERIOD = 30.0
"""Seconds between lines of progress where there is no terminal to draw a bar on."""


class Board:
    """One bar for the run and one line for what each worker is at."""

    def __init__(self, console: Console, total: int) -> None:
        columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
        self._bar = Progress(*columns, TextColumn("{task.fields[now]}"), console=console, transient=True)
        self._task: TaskID = self._bar.add_task("scenarios", total=total, now="")
        self._at: dict[str, str] = {}
        self._console, self._due = console, monotonic() + PERIOD

    def __enter__(self) -> "Board":
        self._bar.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._bar.stop()

    def show(self, at: Progressed) -> None:
        self._at[at.worker] = f"{at.case.seed}: {at.state} {at.t:.0f} s"
        now = "  ".join(self._at.values())
        self._bar.update(self._task, now=now)
        if not self._console.is_terminal and monotonic() >= self._due:
            self._due = monotonic() + PERIOD
            self._console.print(f"  ... {now}", highlight=False)

    def repeated(self, lost: Repeated) -> None:
        self._bar.print(f"[yellow]{lost.case.seed:>5} is run again: {lost.why}[/]", highlight=False)

    def finished(self, result: Result, timeline: bool) -> None:
        self._at = {w: at for w, at in self._at.items() if not at.startswith(f"{result.seed}:")}
        self._bar.advance(self._task)
        self._bar.print(report.line(result), highlight=False)
        if timeline:
            rows = result.evidence.get("timeline", [])
            for row in rows if isinstance(rows, list) else []:
                self._bar.print(f"[dim]        {row}[/]", highlight=False)


def main(argv: list[str]) -> int:
    """Exit status 0 when the bar is met, 1 when fewer did as expected or a claim was false, 130 after Ctrl-C."""
    args = parser("eval").parse_args(["eval", *argv])
    if args.list:
        for name, suite in SUITES.items():
            print(f"{name:9} {100 * suite.bar:3.0f} %  {(suite.make.__doc__ or '').splitlines()[0]}")
        return 0
    args.suite = "world" if args.world else args.suite
    console = Console(stderr=bool(args.json == "-"), soft_wrap=True)
    for target in (args.json, args.html):
        if target and target != "-" and not Path(target).resolve().parent.is_dir():
            print(f"tidybot: {target}: no such directory", file=sys.stderr)
            return FAILED
    settings = (*machine(args), *args.set)
    try:
        bar = WORLD_BAR if args.world else SUITES[checked(args.suite, SUITES, "suite")].bar
        for entry in args.replace:
            replacement(entry)
        todo = _cases(args, settings)
        count = len(todo)
        if args.processes:
            todo = _available(todo, console)
            count = len(todo)
        results, seconds = _run(todo, args, console)
    except (CliError, ConfigError, LookupError) as error:
        print(f"tidybot: {error}", file=sys.stderr)
        return FAILED
    bar = bar if args.at_least is None else args.at_least
    found = report.record(args.suite, results, seconds, bar)
    report.show(console, found, results)
    if args.json:
        text = msgspec.json.format(msgspec.json.encode(found), indent=2).decode()
        if args.json == "-":
            print(text)
        else:
            Path(args.json).write_text(text + "\n", encoding="utf-8")
    if args.html:
        Path(args.html).write_text(html_report.render(found, results), encoding="utf-8")
        console.print(f"report: {args.html}")
    if len(results) < count:
        console.print(f"[yellow]interrupted after {len(results)} of {count} scenarios[/]")
        return INTERRUPTED
    return 0 if found["passed"] else FAILED


def _cases(args: argparse.Namespace, settings: tuple[str, ...]) -> list[Case]:
    """The cases of the suite, or of the worlds in a directory."""
    replaced = tuple(args.replace)
    if args.world:
        found = worlds.cases(args.world, args.scenarios, args.seed)
        return [dressed(case, settings, args.pipeline, replaced) for case in found]
    count = args.scenarios or SUITES[args.suite].scenarios
    return cases(args.suite, count, args.seed, settings, args.pipeline, args.voices, args.snr, replaced)


def _available(todo: list[Case], console: Console) -> list[Case]:
    """The cases that processes can run; the others are listed with the reason.

    Raises:
        CliError: none of them can.
    """
    left = Counter(why for case in todo if (why := unavailable(case)))
    for why, number in left.items():
        console.print(f"[yellow]{number} of {len(todo)} scenarios not available as processes:[/] {why}")
    if left.total() == len(todo):
        raise CliError("no scenario of the run can be run as processes; leave --processes out")
    return [case for case in todo if not unavailable(case)]


def _run(todo: list[Case], args: argparse.Namespace, console: Console) -> tuple[list[Result], float]:
    """The results so far, also after an interruption, and the wall time [s]."""
    results: list[Result] = []
    began = monotonic()
    run = processes.run if args.processes else runner.run
    timeline = args.timeline or args.suite == "seed"
    with Board(console, len(todo)) as board:
        try:
            with interruptible(), closing(_evaluate(todo, args, run)) as running:
                for said in running:
                    if isinstance(said, Progressed):
                        board.show(said)
                    elif isinstance(said, Repeated):
                        board.repeated(said)
                    else:
                        results.append(said)
                        board.finished(said, timeline)
        except Stopped:
            pass
    return results, monotonic() - began


def _evaluate(todo: list[Case], args: argparse.Namespace, run: Run) -> Generator[Said, None, None]:
    if not args.cluster:
        return pool.evaluate(todo, args.jobs, run)
    return cluster.evaluate(todo, args.cluster, args.jobs, run)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
