"""Location of the certificates: a directory, made by `tidybot keys`, with one folder for each.

`<keys>/<service>/{ca,cert,key}.pem`, and `<keys>/<namespace>/<service>/` for a robot with a namespace. A process may
also be given its own folder alone. With keys only `tls/` endpoints are used, and both sides show a certificate.
"""

import os
from collections.abc import Mapping
from pathlib import Path

from common.installation import workspace

OFF = "off"
CA, CERT, KEY = "ca.pem", "cert.pem", "key.pem"


class KeysError(ValueError):
    """A certificate that cannot be used; the message says which and what to do."""


def directory(environ: Mapping[str, str] = os.environ) -> Path | None:
    """Where the keys are: TIDYBOT_KEYS ("off": none), or `default_directory` when that is there.

    Raises:
        KeysError: TIDYBOT_KEYS names nothing.
    """
    given = environ.get("TIDYBOT_KEYS", "")
    if given == OFF:
        return None
    if given:
        found = Path(given).resolve()
        if not found.is_dir():
            raise KeysError(f"TIDYBOT_KEYS={given}: no such directory; `tidybot keys --dir {given}` makes it")
        return found
    default = default_directory(environ)
    return default if default.is_dir() and any(default.iterdir()) else None


def default_directory(environ: Mapping[str, str] = os.environ) -> Path:
    """`keys` in the run directory: TIDYBOT_KEYS_DIR, or below TIDYBOT_RUN_DIR, the checkout's `run/`, or the user's."""
    if environ.get("TIDYBOT_KEYS_DIR"):
        return Path(environ["TIDYBOT_KEYS_DIR"]).resolve()
    if environ.get("TIDYBOT_RUN_DIR"):
        return Path(environ["TIDYBOT_RUN_DIR"]).resolve() / "keys"
    ours = workspace()
    return ours / "run" / "keys" if ours is not None else Path.home() / ".config" / "tidybot" / "keys"


def folder(keys: Path, name: str, namespace: str = "") -> Path:
    """The folder of one certificate: in the whole directory, or the process's own that it was given.

    Raises:
        KeysError: not there.
    """
    found = keys / namespace / name if namespace else keys / name
    try:
        if (keys / CERT).exists():
            return keys
        there = found.is_dir()
    except PermissionError:
        raise KeysError(f"{keys} cannot be read by this user") from None
    if not there:
        who = f"{name} of the robot {namespace}" if namespace else name
        make = f"tidybot keys --missing{f' --namespace {namespace}' if namespace else ''}"
        raise KeysError(f"no certificate of {who} in {keys}; `{make}` makes what is missing")
    return found
