"""Door: a certificate made here, for who has none: kept for the next run, since each browser warns once."""

from __future__ import annotations

import datetime
import ipaddress
import os
from collections.abc import Iterable
from pathlib import Path

from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID

from app.door.access import Certificate, is_ip
from app.door.tls import context
from app.motion.basics import InputError

VALID = datetime.timedelta(days=397)  # browsers believe no longer ones
RENEW = datetime.timedelta(days=7)


def made(folder: Path, names: Iterable[str], now: datetime.datetime) -> Certificate:
    """A certificate of our own for ``names``, kept in ``folder``; made anew when it must be."""
    wanted = frozenset(names)
    kept = Certificate(folder / "certificate.pem", folder / "key.pem")
    if not _is_good(kept, wanted, now):
        try:
            _write(kept, wanted, now)
        except OSError as error:
            raise InputError(f"--tls-made: {folder} cannot be written: {error.strerror}") from None
    return kept


def _is_good(kept: Certificate, wanted: frozenset[str], now: datetime.datetime) -> bool:
    try:
        certificate = x509.load_pem_x509_certificate(kept.chain.read_bytes())
        context(kept)
    except (OSError, ValueError, InputError):
        return False
    return wanted <= _names_of(certificate) and now + RENEW < certificate.not_valid_after_utc


def _names_of(certificate: x509.Certificate) -> frozenset[str]:
    try:
        names = certificate.extensions.get_extension_for_class(x509.SubjectAlternativeName).value
    except x509.ExtensionNotFound:
        return frozenset()
    return frozenset(str(name.value) for name in names)


def _write(kept: Certificate, names: frozenset[str], now: datetime.datetime) -> None:
    key = ec.generate_private_key(ec.SECP256R1())
    pem = key.private_bytes(
        serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
    )
    kept.key.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
    _write_private(kept.key, pem)
    certificate = _self_signed(key, names, now)
    _write_private(kept.chain, certificate.public_bytes(serialization.Encoding.PEM))


def _self_signed(
    key: ec.EllipticCurvePrivateKey, names: frozenset[str], now: datetime.datetime
) -> x509.Certificate:
    subject = x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, "Stridescope on this machine")])
    return (
        x509.CertificateBuilder()
        .subject_name(subject)
        .issuer_name(subject)
        .public_key(key.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - datetime.timedelta(days=1))  # a phone's clock may be behind
        .not_valid_after(now + VALID)
        .add_extension(
            x509.SubjectAlternativeName([_general(name) for name in sorted(names)]), critical=False
        )
        .add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
        .add_extension(x509.ExtendedKeyUsage([ExtendedKeyUsageOID.SERVER_AUTH]), critical=False)
        .sign(key, hashes.SHA256())
    )


def _general(name: str) -> x509.GeneralName:
    return x509.IPAddress(ipaddress.ip_address(name)) if is_ip(name) else x509.DNSName(name)


def _write_private(path: Path, data: bytes) -> None:
    """Nobody else may read it, not even for a moment."""
    new = path.with_suffix(".new")
    new.unlink(missing_ok=True)
    with os.fdopen(os.open(new, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "wb") as file:
        file.write(data)
    new.replace(path)
