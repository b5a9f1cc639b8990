"""Door: TLS with a certificate and its key, as files."""

from __future__ import annotations

import hashlib
import ssl
from pathlib import Path

from app.door.access import Certificate
from app.motion.basics import InputError


def context(certificate: Certificate) -> ssl.SSLContext:
    """TLS with this certificate; what is wrong with its files is ``InputError``."""
    made = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    made.minimum_version = ssl.TLSVersion.TLSv1_2
    for path in certificate:
        _demand_readable(path)
    try:
        made.load_cert_chain(certificate.chain, certificate.key, password=_no_password)
    except (ssl.SSLError, ValueError) as error:
        why = getattr(error, "reason", None) or str(error) or "no certificate and its key"
        raise InputError(
            f"TLS with {certificate.chain} and {certificate.key}: {str(why).replace('_', ' ').lower()};"
            " expected PEM files of a certificate and of its key without a password"
        ) from None
    return made


def fingerprint(certificate: Certificate) -> str:
    """SHA-256 of the certificate, as a browser's warning shows it: ``AB:CD:…``."""
    der = ssl.PEM_cert_to_DER_cert(certificate.chain.read_text("ascii"))
    return hashlib.sha256(der).digest().hex(":").upper()


def _demand_readable(path: Path) -> None:
    try:
        path.open("rb").close()
    except OSError as error:
        raise InputError(f"TLS: {path}: cannot be read: {error.strerror}") from None


def _no_password() -> str:
    raise ValueError("the key has a password")
