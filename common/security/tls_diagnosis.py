"""Diagnosis of TLS errors that Zenoh does not report, by a handshake of our own with the router."""

import socket
import ssl
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from common.security.certificate import Identity

PROBE = 1.0
"""Patience with a handshake [s]; chosen: a router in the next room answers in a hundredth of it."""
EXPIRED, WRONG_NAME, WRONG_ADDRESS = 10, 62, 64
"""X509_V_ERR_CERT_HAS_EXPIRED, _HOSTNAME_MISMATCH and _IP_ADDRESS_MISMATCH of OpenSSL's x509_vfy.h."""
REFUSALS = {
    "CERTIFICATE_EXPIRED": "has expired there (is a clock wrong?)",
    "UNKNOWN_CA": "is of another authority",
    "CERTIFICATE_REQUIRED": "was not shown",
    "BAD_CERTIFICATE": "is not accepted",
    "DECRYPT_ERROR": "is of another authority",
    "CERTIFICATE_UNKNOWN": "is not accepted",
}


def trouble(endpoint: str, shown: "Identity | None") -> str:
    """What is wrong between us and the router at one endpoint; "" when nobody listens there or nothing is wrong."""
    protocol, _, address = endpoint.partition("/")
    host, _, port = address.partition("?")[0].partition("#")[0].rpartition(":")
    host = host.strip("[]")
    if protocol not in ("tcp", "tls") or not port.isdigit():
        return ""
    context = shown.context() if shown is not None else _trusting()
    try:
        with socket.create_connection((host, int(port)), PROBE) as raw:
            return _handshake(raw, host, endpoint, context, shown)
    except OSError:
        return ""


def _handshake(raw: socket.socket, host: str, endpoint: str, context: ssl.SSLContext, shown: "Identity | None") -> str:
    try:
        wrapped = context.wrap_socket(raw, server_hostname=host)
    except ssl.SSLCertVerificationError as error:
        if error.verify_code == EXPIRED:
            return f"certificate of the router at {endpoint} expired; run `tidybot keys --force` there"
        if error.verify_code in (WRONG_NAME, WRONG_ADDRESS):
            return f"certificate of the router is not for {host!r}; run `tidybot keys --force --host {host}` there"
        return f"the router at {endpoint} has a certificate of another authority ({error.verify_message})"
    except OSError as error:
        return _refusal(error, endpoint, shown) or ("" if shown is None else f"the router at {endpoint} takes no keys")
    with wrapped:
        if shown is None:
            return f"the router at {endpoint} takes certificates only: use tls/ and TIDYBOT_KEYS (see `tidybot keys`)"
        # With TLS 1.3 our certificate is refused after the handshake; a router that takes it waits for us.
        wrapped.settimeout(PROBE / 2)
        try:
            wrapped.recv(1)
        except OSError as error:
            return _refusal(error, endpoint, shown)
    return ""


def _refusal(error: OSError, endpoint: str, shown: "Identity | None") -> str:
    for mark, words in REFUSALS.items():
        if shown is not None and mark in str(error):
            return f"the router at {endpoint} refuses us: certificate of {shown.common_name} {words}"
    return ""


def _trusting() -> ssl.SSLContext:
    """For finding out whether a router speaks TLS at all; nothing is sent over it."""
    context = ssl.create_default_context()
    context.check_hostname = False
    context.verify_mode = ssl.CERT_NONE
    return context
