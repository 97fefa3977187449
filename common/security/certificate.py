"""A certificate with its key: read, checked, and as settings for Zenoh and for Python's TLS."""

import ssl
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from cryptography import x509
from cryptography.exceptions import InvalidSignature
from cryptography.hazmat.primitives import serialization
from cryptography.x509.oid import NameOID

from common.security.keys import CA, CERT, KEY, KeysError
from common.time.clock import unix_time


class Identity:
    """A certificate with its key and the authority that signed it.

    Raises:
        KeysError: missing, unreadable, expired, not yet valid, another's, or not of this authority.
    """

    def __init__(self, directory: Path, name: str, namespace: str = "") -> None:
        self.directory, self.name = directory, name
        wanted = f"{namespace}/{name}" if namespace else name
        self.ca, self.cert, self.key = directory / CA, directory / CERT, directory / KEY
        authority, own, key = _read(self.ca, name), _read(self.cert, name), _read_key(self.key)
        self.common_name = common_name(own)
        self.expires = own.not_valid_after_utc
        now = datetime.fromtimestamp(unix_time(), UTC)
        if self.expires < now:
            raise KeysError(f"certificate of {wanted} expired on {_day(self.expires)}; run `tidybot keys --force`")
        if authority.not_valid_after_utc < now:
            raise KeysError(
                f"the authority of {wanted}'s certificate expired on {_day(authority.not_valid_after_utc)}; "
                "run `tidybot keys --force`"
            )
        if own.not_valid_before_utc > now:
            raise KeysError(
                f"certificate of {wanted} is not valid before {_day(own.not_valid_before_utc)}; is this clock right?"
            )
        if self.common_name != wanted:
            raise KeysError(f"{self.cert} is the certificate of {self.common_name}, not of {wanted}")
        try:
            own.verify_directly_issued_by(authority)
        except (InvalidSignature, ValueError, TypeError) as error:
            raise KeysError(
                f"certificate of {wanted} was not signed by {self.ca}: copy the whole folder again, or run "
                "`tidybot keys --force`"
            ) from error

        if key.public_key() != own.public_key():
            raise KeysError(f"{self.key} does not belong to {self.cert}: copy the whole folder again")

    def settings(self, serving: bool) -> dict[str, Any]:
        """Zenoh's `transport/link/tls`: mutual authentication for a router (`serving`) or a client."""
        cert, key = str(self.cert), str(self.key)
        found = {
            "root_ca_certificate": str(self.ca),
            "enable_mtls": True,
            "connect_certificate": cert,
            "connect_private_key": key,
            "verify_name_on_connect": True,
        }
        return {**found, "listen_certificate": cert, "listen_private_key": key} if serving else found

    def context(self) -> ssl.SSLContext:
        """The certificate as a context of Python's own TLS."""
        context = ssl.create_default_context(cafile=str(self.ca))
        context.load_cert_chain(self.cert, self.key)
        return context


def common_name(certificate: x509.Certificate) -> str:
    """The name that access control goes by."""
    names = certificate.subject.get_attributes_for_oid(NameOID.COMMON_NAME)
    return str(names[0].value) if names else ""


def _read(path: Path, name: str) -> x509.Certificate:
    try:
        return x509.load_pem_x509_certificate(path.read_bytes())
    except FileNotFoundError:
        raise KeysError(f"no certificate of {name}: {path} is missing; `tidybot keys` makes it") from None
    except OSError as error:
        raise KeysError(f"{path} cannot be read by this user ({error.strerror})") from None
    except ValueError as error:
        raise KeysError(f"{path} is not a certificate: {error}") from None


def _read_key(path: Path) -> Any:
    try:
        return serialization.load_pem_private_key(path.read_bytes(), None)
    except FileNotFoundError:
        raise KeysError(f"{path} is missing; run `tidybot keys --force`") from None
    except OSError as error:
        raise KeysError(f"{path} cannot be read by this user ({error.strerror})") from None
    except (ValueError, TypeError) as error:
        raise KeysError(f"{path} is not a key: {error}") from None


def _day(when: datetime) -> str:
    return when.strftime("%Y-%m-%d %H:%M UTC")
