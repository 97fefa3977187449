"""A certificate authority in a directory: keys on disk that only their owner reads, certificates signed by it."""

import contextlib
import ipaddress
import os
import socket
from collections.abc import Iterable
from datetime import UTC, datetime, timedelta
from pathlib import Path

import msgspec
from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID

from cli.errors import CliError
from common.security.access import ROUTER, Subject
from common.security.keys import CA, CERT, KEY
from common.security.zenoh_config import SUBJECTS, client, standalone
from common.time.clock import unix_time

STANDALONE, CLIENT = "router.json5", "client.json5"
HOSTS = ("localhost", "127.0.0.1", "::1", "router")  # `router` is its name in the compose file
SKEW = timedelta(days=1)  # robots without a battery clock start in the past


class Row(msgspec.Struct):
    """One certificate of a keys directory."""

    name: str
    role: str
    folder: str
    expires: str


class Authority:
    """The directory that `tidybot keys` makes; the authority's own key is in `ca/`."""

    def __init__(self, directory: Path) -> None:
        self.directory = directory

    @property
    def exists(self) -> bool:
        return (self.directory / "ca" / CERT).exists() or (self.directory / ROUTER / CERT).exists()

    def found(self, days: float) -> None:
        """A new authority, in place of any that was there."""
        key = ec.generate_private_key(ec.SECP256R1())
        name = _name("tidybot authority", "authority")
        made = (
            _builder(name, name, key.public_key(), days)
            .add_extension(x509.BasicConstraints(ca=True, path_length=0), critical=True)
            .add_extension(_usage(signing_certificates=True), critical=True)
            .sign(key, hashes.SHA256())
        )
        write(self.directory / "ca" / KEY, _pem(key))
        write(self.directory / "ca" / CERT, made.public_bytes(serialization.Encoding.PEM))

    def issue(self, subject: Subject, days: float, hosts: Iterable[str] = ()) -> None:
        """A key and a certificate for one subject; routers also serve, under the names of `hosts`.

        A client gets a configuration file for plain Zenoh tools as well.

        Raises:
            CliError: the authority's key is not here.
        """
        try:
            authority = x509.load_pem_x509_certificate((self.directory / "ca" / CERT).read_bytes())
            signing = serialization.load_pem_private_key((self.directory / "ca" / KEY).read_bytes(), None)
        except OSError as error:
            raise CliError(f"{error.filename}: {error.strerror}; new certificates need the authority's key") from None
        assert isinstance(signing, ec.EllipticCurvePrivateKey)
        key = ec.generate_private_key(ec.SECP256R1())
        uses = [ExtendedKeyUsageOID.CLIENT_AUTH]
        names: list[x509.GeneralName] = [x509.DNSName(subject.name)]
        if subject.role == "router":
            uses.append(ExtendedKeyUsageOID.SERVER_AUTH)
            names = _host_names(hosts)
        made = (
            _builder(_name(subject.common_name, subject.role), authority.subject, key.public_key(), days)
            .add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
            .add_extension(_usage(signing_certificates=False), critical=True)
            .add_extension(x509.ExtendedKeyUsage(uses), critical=False)
            .add_extension(x509.SubjectAlternativeName(names), critical=False)
            .sign(signing, hashes.SHA256())
        )
        folder = self.directory / subject.common_name
        write(folder / KEY, _pem(key))
        write(folder / CERT, made.public_bytes(serialization.Encoding.PEM))
        write(folder / CA, authority.public_bytes(serialization.Encoding.PEM))
        if subject.role in ("operator", "observer", "agent", "fleet", "ros"):
            where = next((h for h in hosts if h not in hosts_of(())), "127.0.0.1")
            write(folder / CLIENT, client(folder, f"tls/{where}:7447", subject.namespace).encode())

    def has(self, subject: Subject) -> bool:
        return (self.directory / subject.common_name / CERT).exists()

    # --- who there is; the router lets in nobody else
    def subjects(self) -> list[Subject]:
        """The owners of all certificates.

        Raises:
            CliError: the list cannot be read.
        """
        path = self.directory / ROUTER / SUBJECTS
        try:
            return msgspec.json.decode(path.read_bytes(), type=list[Subject])
        except FileNotFoundError:
            return []
        except (OSError, msgspec.DecodeError) as error:
            raise CliError(f"{path}: {error}") from None

    def register(self, subjects: Iterable[Subject]) -> None:
        """Write down who may come, and the configuration with all of it for a router of another make."""
        folder = self.directory / ROUTER
        write(folder / SUBJECTS, msgspec.json.format(msgspec.json.encode(list(subjects)), indent=1))
        write(folder / STANDALONE, standalone(folder, subjects).encode())

    def rows(self) -> list[Row]:
        """Every certificate, as `tidybot keys --list` shows it."""
        found = []
        for subject in self.subjects():
            folder = self.directory / subject.common_name
            with contextlib.suppress(OSError, ValueError):
                expires = x509.load_pem_x509_certificate((folder / CERT).read_bytes()).not_valid_after_utc
                day = expires.isoformat(timespec="seconds")
                found.append(Row(name=subject.common_name, role=subject.role, folder=str(folder), expires=day))
        return found


def write(path: Path, content: bytes) -> None:
    """Replace a file at once; only its owner may read it."""
    path.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
    path.parent.chmod(0o700)
    draft = path.with_name(path.name + ".new")
    draft.unlink(missing_ok=True)
    with open(os.open(draft, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "wb") as out:
        out.write(content)
        out.flush()
        os.fsync(out.fileno())
    draft.replace(path)


def hosts_of(given: Iterable[str]) -> list[str]:
    """What a router may be called: this machine's names, and the ones given."""
    return list(dict.fromkeys([*HOSTS, socket.gethostname(), *given]))


def _host_names(hosts: Iterable[str]) -> list[x509.GeneralName]:
    names: list[x509.GeneralName] = []
    for host in hosts:
        try:
            names.append(x509.IPAddress(ipaddress.ip_address(host)))
        except ValueError:
            names.append(x509.DNSName(host))
    return names


def _builder(
    subject: x509.Name, issuer: x509.Name, key: ec.EllipticCurvePublicKey, days: float
) -> x509.CertificateBuilder:
    now = datetime.fromtimestamp(unix_time(), UTC)
    end = now + timedelta(days=days)
    return (
        x509.CertificateBuilder()
        .subject_name(subject)
        .issuer_name(issuer)
        .public_key(key)
        .serial_number(x509.random_serial_number())
        .not_valid_before(min(now, end) - SKEW)
        .not_valid_after(end)
    )


def _name(common_name: str, role: str) -> x509.Name:
    return x509.Name(
        [
            x509.NameAttribute(NameOID.COMMON_NAME, common_name),
            x509.NameAttribute(NameOID.ORGANIZATIONAL_UNIT_NAME, role),
        ]
    )


def _usage(signing_certificates: bool) -> x509.KeyUsage:
    return x509.KeyUsage(
        digital_signature=not signing_certificates,
        key_cert_sign=signing_certificates,
        crl_sign=signing_certificates,
        content_commitment=False,
        key_encipherment=False,
        data_encipherment=False,
        key_agreement=False,
        encipher_only=False,
        decipher_only=False,
    )


def _pem(key: ec.EllipticCurvePrivateKey) -> bytes:
    return key.private_bytes(
        serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
    )
