"""A Zenoh router: the full routing core of the wheel, with admin space, without REST and storage plugins.

It listens on this machine only, or over TLS to those with a certificate; access control gives each of them the keys of
the topic table and no others.
"""

import argparse
import base64
import ipaddress
import os
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import msgspec
import zenoh

from common import access, keys
from common.certificate import Identity
from common.keys import CA, CERT, KEY
from common.process import SILENCE, StopSignal, die_with_parent, limit_silence

CONFIG = Path(__file__).resolve().parent.parent / "config" / "zenoh" / "router.json5"
SUBJECTS = "subjects.json"
BAD_CONFIGURATION = 2


def main() -> None:
    """Entry point of `python -m services.router`: exit 0 after SIGTERM, 2 when it cannot listen."""
    args = _arguments()
    stop = StopSignal()
    die_with_parent()
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
        default=os.environ.get("TIDYBOT_LISTEN", ""),
        help="endpoints, comma-separated (default: port 7447 of this machine, over TLS when there are keys)",
    )
    parser.add_argument("--connect", default=os.environ.get("TIDYBOT_ROUTERS", ""), help="other routers to link with")
    parser.add_argument("--config", type=Path, default=CONFIG, help="zenoh configuration (default %(default)s)")
    parser.add_argument("--open", action="store_true", help="listen without certificates beyond this machine")
    return parser.parse_args()


def _config(args: argparse.Namespace) -> zenoh.Config:
    config = zenoh.Config.from_file(str(args.config))
    config.insert_json5("listen/endpoints", _json(_endpoints(args.listen)))
    if args.connect:
        config.insert_json5("connect/endpoints", _json(_endpoints(args.connect)))
        config.insert_json5("connect/timeout_ms", "-1")
        config.insert_json5("connect/exit_on_failure", "false")
    if _json_of(config, "access_control/enabled") is True:
        return config  # made by `tidybot keys`: certificates and access control are in it
    found = keys.directory()
    for endpoint in _endpoints(args.listen) + _endpoints(args.connect):
        _check(endpoint, found, args.open)
    if found is not None:
        folder = keys.folder(found, access.ROUTER)
        identity = Identity(folder, access.ROUTER)
        _secure(config, identity.settings(serving=True), subjects(folder))
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


def subjects(folder: Path) -> list[access.Subject]:
    """Who has a certificate, as `tidybot keys` wrote it down beside the router's own.

    Raises:
        KeysError: the list is not there or not readable.
    """
    path = folder / SUBJECTS
    try:
        return msgspec.json.decode(path.read_bytes(), type=list[access.Subject])
    except (OSError, msgspec.DecodeError) as error:
        raise keys.KeysError(f"{path}: {error}; `tidybot keys --missing` writes it") from None


def _secure(config: zenoh.Config, tls: dict[str, Any], allowed: Iterable[access.Subject]) -> None:
    config.insert_json5("transport/link/protocols", _json(["tls"]))
    config.insert_json5("transport/link/tls", _json(tls))
    config.insert_json5("access_control", _json(access.acl(allowed)))


def standalone(folder: Path, allowed: Iterable[access.Subject]) -> str:
    """The router's whole configuration as one file, certificates included, for the official `zenohd`."""
    config = zenoh.Config.from_file(str(CONFIG))
    tls = _inside(folder)
    tls |= {k.replace("connect_", "listen_"): v for k, v in tls.items() if k.startswith("connect_")}
    whole = {name: _json_of(config, name) for name in ("mode", "scouting", "timestamping")}
    link = {"tx": {"lease": _json_of(config, "transport/link/tx/lease")}, "protocols": ["tls"], "tls": tls}
    shared = {"enabled": _json_of(config, "transport/shared_memory/enabled")}
    whole |= {"transport": {"link": link, "shared_memory": shared}, "access_control": access.acl(allowed)}
    return msgspec.json.format(msgspec.json.encode(whole), indent=1).decode() + "\n"


def client(folder: Path, endpoint: str, namespace: str) -> str:
    """A whole configuration for any Zenoh tool (`zenoh --config FILE`), certificate included."""
    config = zenoh.Config.from_file(str(CONFIG.with_name("client.json5")))
    whole = {name: _json_of(config, name) for name in ("mode", "scouting")}
    whole |= {"connect": {"endpoints": [endpoint]}, "namespace": namespace or None}
    whole |= {"transport": {"link": {"protocols": ["tls"], "tls": _inside(folder)}}}
    return msgspec.json.format(msgspec.json.encode(whole), indent=1).decode() + "\n"


def _inside(folder: Path) -> dict[str, Any]:
    """TLS settings with the certificates themselves instead of paths to them."""
    ca, cert, key = (base64.b64encode((folder / n).read_bytes()).decode() for n in (CA, CERT, KEY))
    return {
        "root_ca_certificate_base64": ca,
        "connect_certificate_base64": cert,
        "connect_private_key_base64": key,
        "enable_mtls": True,
        "verify_name_on_connect": True,
    }


def _json_of(config: zenoh.Config, key: str) -> Any:
    return msgspec.json.decode(config.get_json(key))


def _endpoints(text: str) -> list[str]:
    return [e.strip() for e in text.split(",") if e.strip()]


def _json(value: object) -> str:
    return msgspec.json.encode(value).decode()


def _reason(error: Exception, listen: str) -> str:
    text = str(error)
    if isinstance(error, keys.KeysError):
        return text
    if "Address already in use" in text or "os error 98" in text:
        text = "the port is in use (another router? `tidybot down` stops ours)"
    return f"cannot listen on {listen}: {text}"
