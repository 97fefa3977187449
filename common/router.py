"""A Zenoh router: the full routing core of the wheel, with admin space, without REST and storage plugins."""

import argparse
import os
import sys
from pathlib import Path

import msgspec
import zenoh

from common.process import StopSignal, die_with_parent

CONFIG = Path(__file__).resolve().parent.parent / "config" / "zenoh" / "router.json5"


def main() -> None:
    """Entry point of `python -m services.router`: exit 0 after SIGTERM, 2 when it cannot listen."""
    parser = argparse.ArgumentParser(prog="python -m services.router", description=__doc__)
    parser.add_argument(
        "--listen",
        default=os.environ.get("TIDYBOT_LISTEN", "tcp/127.0.0.1:7447"),
        help="endpoints, comma-separated (default %(default)s)",
    )
    parser.add_argument("--connect", default=os.environ.get("TIDYBOT_ROUTERS", ""), help="other routers to link with")
    parser.add_argument("--config", type=Path, default=CONFIG, help="zenoh configuration (default %(default)s)")
    args = parser.parse_args()
    stop = StopSignal()
    die_with_parent()
    try:
        config = zenoh.Config.from_file(str(args.config))
        config.insert_json5("listen/endpoints", _endpoints(args.listen))
        if args.connect:
            config.insert_json5("connect/endpoints", _endpoints(args.connect))
            config.insert_json5("connect/timeout_ms", "-1")
            config.insert_json5("connect/exit_on_failure", "false")
        opened = zenoh.open(config)
    except zenoh.ZError as error:
        print(f"router: cannot listen on {args.listen}: {_reason(error)}", file=sys.stderr)
        sys.exit(2)
    with opened:
        print(f"router: listening on {args.listen}", file=sys.stderr, flush=True)
        while not stop.wait(1.0):
            pass


def _endpoints(text: str) -> str:
    return msgspec.json.encode([e.strip() for e in text.split(",") if e.strip()]).decode()


def _reason(error: Exception) -> str:
    text = str(error)
    if "Address already in use" in text or "os error 98" in text:
        return "the port is in use (another router? `tidybot down` stops ours)"
    return text
