"""Hostile payloads on every key that the running processes subscribe to: `python -m bench.fuzz --payloads 200000`.

Every process must live on without a stack trace, count what it refuses in its health, and still do its job: at the
end the robot is reset and has to fetch something. Exit 1 otherwise.
"""

import argparse
import sys
import tempfile
import time
from collections.abc import Iterable
from pathlib import Path

from bench.fuzz.storm import TRUSTED, Storm
from cli.processes.services import SERVICES
from common import messages as m
from evaluation.site import site
from evaluation.stack import service_class


def table(storm: Storm, health: dict[str, m.Health]) -> Iterable[str]:
    """Print a line for each process."""
    yield f"{'process':14} {'payloads':>9} {'refused':>9} {'Hz':>6} {'MB':>6}  keys refused on"
    for name in storm.names:
        reads = {t.key for t in service_class(name).READS} | TRUSTED
        h = health[name]
        keys = sorted(k for k in h.by_key if k in reads)
        sent = sum(n for k, n in storm.sent.items() if k in reads)
        yield f"{name:14} {sent:9} {h.drops:9} {h.hz:6.1f} {h.rss_mb:6.0f}  {len(keys)} of {len(reads)}"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--payloads", type=int, default=20_000)
    parser.add_argument("--rate", type=float, default=2000.0, help="payloads a second (default %(default)s)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--item", default="red mug", help="what to fetch afterwards; empty: nothing")
    parser.add_argument("--services", default=",".join(s.name for s in SERVICES if s.token), metavar="A,B")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as logs, site(Path(logs)) as here, here.session() as session:
        storm = Storm(here, session, [n for n in args.services.split(",") if n], args.seed)
        storm.start()
        storm.learn()
        began, shown = time.monotonic(), [0.0]

        def watch(sent: int) -> None:
            if time.monotonic() - shown[0] > 10.0:
                shown[0] = time.monotonic()
                print(f"  {sent} payloads, {sent / (shown[0] - began + 1e-9):.0f}/s", file=sys.stderr, flush=True)

        try:
            storm.throw(args.payloads, args.rate, watch)
            health = storm.settle()
        except AssertionError as error:
            print(error)
            return 1
        print(f"{sum(storm.sent.values())} payloads on {len(storm.sent)} keys in {time.monotonic() - began:.0f} s")
        print("\n".join(table(storm, health)))
        troubles = storm.troubles()
        print(f"errors in the logs: {len(troubles)}", *troubles[:20], sep="\n  ")
        outcome = "not asked"
        if args.item:
            storm.recover()
            outcome = storm.fetch(args.item)
            print(f"afterwards, bring me the {args.item}: {outcome}")
        silent = [n for n in storm.names if health[n].drops == 0]
        print(f"nobody died; refused nothing: {', '.join(silent) or 'none'}")
        return int(bool(troubles or silent) or not outcome.startswith(("delivered", "not asked")))


if __name__ == "__main__":
    sys.exit(main())
