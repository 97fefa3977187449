"""Zenoh configurations with certificates and access control in them, for our router, the official one, and clients."""

import base64
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import msgspec
import zenoh

from common.installation import shipped
from common.security import access
from common.security.keys import CA, CERT, KEY, KeysError

ROUTER_CONFIG = shipped("config") / "zenoh" / "router.json5"
SUBJECTS = "subjects.json"
"""File beside the router's certificate that lists who else has one."""


def subjects(folder: Path) -> list[access.Subject]:
    """Who has a certificate, as `tidybot keys` wrote it down beside the router's own.

    Raises:
        KeysError: the list is not there or not readable.
    """
    path = folder / SUBJECTS
    try:
        return msgspec.json.decode(path.read_bytes(), type=list[access.Subject])
    except (OSError, msgspec.DecodeError) as error:
        raise KeysError(f"{path}: {error}; `tidybot keys --missing` writes it") from None


def secure(config: zenoh.Config, tls: dict[str, Any], allowed: Iterable[access.Subject]) -> None:
    """Have a router take mutual TLS only, and give each certificate its own keys."""
    config.insert_json5("transport/link/protocols", as_json(["tls"]))
    config.insert_json5("transport/link/tls", as_json(tls))
    config.insert_json5("access_control", as_json(access.acl(allowed)))


def standalone(folder: Path, allowed: Iterable[access.Subject]) -> str:
    """The router's whole configuration as one file, certificates included, for the official `zenohd`."""
    config = zenoh.Config.from_file(str(ROUTER_CONFIG))
    tls = _inside(folder)
    tls |= {k.replace("connect_", "listen_"): v for k, v in tls.items() if k.startswith("connect_")}
    whole = {name: value_of(config, name) for name in ("mode", "scouting", "timestamping")}
    link = {"tx": {"lease": value_of(config, "transport/link/tx/lease")}, "protocols": ["tls"], "tls": tls}
    shared = {"enabled": value_of(config, "transport/shared_memory/enabled")}
    whole |= {"transport": {"link": link, "shared_memory": shared}, "access_control": access.acl(allowed)}
    return msgspec.json.format(msgspec.json.encode(whole), indent=1).decode() + "\n"


def client(folder: Path, endpoint: str, namespace: str) -> str:
    """A whole configuration for any Zenoh tool (`zenoh --config FILE`), certificate included."""
    config = zenoh.Config.from_file(str(ROUTER_CONFIG.with_name("client.json5")))
    whole = {name: value_of(config, name) for name in ("mode", "scouting")}
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


def value_of(config: zenoh.Config, key: str) -> Any:
    """A value of a configuration, decoded."""
    return msgspec.json.decode(config.get_json(key))


def as_json(value: object) -> str:
    """A value as Zenoh's configuration takes it."""
    return msgspec.json.encode(value).decode()
