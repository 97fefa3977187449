"""A Zenoh router: the full routing core of the wheel, with admin space, without REST and storage plugins.

It listens on this machine only, or over TLS to those with a certificate; access control gives each of them the keys of
the topic table and no others.
"""

import argparse
import ipaddress
import sys
from pathlib import Path

import zenoh

from common.bus.session import endpoints
from common.process.host import BAD_CONFIGURATION, SILENCE, StopSignal, limit_silence
from common.security import access, keys
from common.security.certificate import Identity
from common.security.zenoh_config import ROUTER_CONFIG, as_json, secure, subjects, value_of


def main() -> None:
    """Entry point of `python -m services.router`: exit 0 after SIGTERM, 2 when it cannot listen."""
    args = _arguments()
    stop = StopSignal()
    try:
        args.listen = args.listen or f"{'tls' if keys.directory() else 'tcp'}/127.0.0.1:7447"
        opened = zenoh.open(_config(args))
    except (keys.KeysError, zenoh.ZError) as error:
        print(f"router: {_reason(error, args.listen)}", file=sys.stderr)
        sys.exit(BAD_CONFIGURATION)
    with opened:
        print(f"router: listening on {args.listen}", file=sys.stderr, flush=True)
        while not stop.wait(1.0):
            limit_silence(SILENCE)


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m services.router", description=__doc__)
    parser.add_argument(
        "--listen",
        default="",
        help="endpoints, comma-separated (default: port 7447 of this machine, over TLS when there are keys)",
    )
    parser.add_argument("--connect", default="", help="other routers to link with")
    parser.add_argument("--config", type=Path, default=ROUTER_CONFIG, help="zenoh configuration (default %(default)s)")
    parser.add_argument("--open", action="store_true", help="listen without certificates beyond this machine")
    return parser.parse_args()


def _config(args: argparse.Namespace) -> zenoh.Config:
    config = zenoh.Config.from_file(str(args.config))
    config.insert_json5("listen/endpoints", as_json(endpoints(args.listen)))
    if args.connect:
        config.insert_json5("connect/endpoints", as_json(endpoints(args.connect)))
        config.insert_json5("connect/timeout_ms", "-1")
        config.insert_json5("connect/exit_on_failure", "false")
    if value_of(config, "access_control/enabled") is True:
        return config  # made by `tidybot keys`: certificates and access control are in it
    found = keys.directory()
    for endpoint in endpoints(args.listen) + endpoints(args.connect):
        _check(endpoint, found, args.open)
    if found is not None:
        folder = keys.folder(found, access.ROUTER)
        identity = Identity(folder, access.ROUTER)
        secure(config, identity.settings(serving=True), subjects(folder))
    return config


def _check(endpoint: str, found: Path | None, open_to_all: bool) -> None:
    """Plain endpoints are for this machine, and only while there are no keys."""
    secure = endpoint.startswith("tls/")
    if secure and found is None:
        raise keys.KeysError(f"{endpoint} needs certificates; `tidybot keys` makes them")
    if not secure and found is not None:
        raise keys.KeysError(f"{endpoint}: there are keys in {found}, so only tls/ is used (TIDYBOT_KEYS=off: none)")
    if not secure and not open_to_all and not _local(endpoint):
        raise keys.KeysError(
            f"{endpoint} would let in everybody on the network; make certificates with `tidybot keys` and use tls/ "
            "(or --open, where the network itself is closed)"
        )


def _local(endpoint: str) -> bool:
    protocol, _, address = endpoint.partition("/")
    host = address.rpartition(":")[0].strip("[]")
    if protocol not in ("tcp", "udp", "ws", "quic") or host == "localhost":
        return True  # unix sockets and pipes
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def _reason(error: Exception, listen: str) -> str:
    text = str(error)
    if isinstance(error, keys.KeysError):
        return text
    if "Address already in use" in text or "os error 98" in text:
        text = "the port is in use (another router? `tidybot down` stops ours)"
    return f"cannot listen on {listen}: {text}"
