"""Thinning of a robot's traffic over a radio link: its router's configuration, generated from the topic table."""

from typing import Any

import msgspec
import zenoh

from cli.errors import CliError
from common import topics
from common.security.zenoh_config import ROUTER_CONFIG, value_of

RATES = {topics.POSE.key: 2.0, topics.JOINT_STATES.key: 5.0, topics.BATTERY.key: 0.2, topics.DRIVE_INTENT.key: 5.0}
"""Messages a second [Hz] of what a fleet's desk and people's tools look at; chosen: what the eye follows. By the last
of them robots keep out of each other's way."""
OTHERS = 1.0
"""The same of every other stream; chosen."""
LINKS = ("tcp", "tls", "quic", "udp", "ws")
"""Protocols that leave the machine; the robot's own processes are on its router's Unix socket."""
KEPT = ("mode", "scouting", "timestamping")


def thinning(others: float = OTHERS) -> list[dict[str, Any]]:
    """Zenoh's `downsampling`: streams, of which only the newest counts, and clocks. Goals, statuses, events and sound
    pass as they are, and so does what comes in."""
    streams = [t for t in topics.TABLE if t.keep == "latest" or t in topics.CLOCKS]
    rates = {t.key: min(RATES.get(t.key, others), t.rate or others) for t in streams}
    rules = [{"key_expr": f"**/{key}", "freq": rate} for key, rate in sorted(rates.items())]
    return [{"id": "radio", "messages": ["put"], "flows": ["egress"], "link_protocols": list(LINKS), "rules": rules}]


def router_config(to: list[str], others: float = OTHERS) -> str:
    """A whole configuration for `python -m services.router --config`: linked with the routers `to`, thinned on the way.

    Raises:
        CliError: a rate that is none.
    """
    if not 0 < others <= 100:
        raise CliError(f"--hz {others:g}: expected messages a second, above 0 and at most 100")
    config = zenoh.Config.from_file(str(ROUTER_CONFIG))
    whole: dict[str, Any] = {name: value_of(config, name) for name in KEPT}
    lease, shared = value_of(config, "transport/link/tx/lease"), value_of(config, "transport/shared_memory/enabled")
    whole["transport"] = {"link": {"tx": {"lease": lease}}, "shared_memory": {"enabled": shared}}
    # A link that is away is tried again for as long as the robot is up, and never keeps it from working.
    whole["connect"] = {"endpoints": to, "timeout_ms": -1, "exit_on_failure": False}
    whole["downsampling"] = thinning(others)
    return msgspec.json.format(msgspec.json.encode(whole), indent=1).decode() + "\n"
