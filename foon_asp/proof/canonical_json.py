"""Canonical JSON, by which equal values have equal texts and equal digests."""

import hashlib
import json


def canonical_json(value: object) -> str:
    """Return plain values as JSON text with sorted keys and without spaces between its parts."""
    return json.dumps(value, sort_keys=True, separators=(",", ":"), check_circular=False)


def digest_of(value: object) -> str:
    """Return the SHA-256 digest, in hexadecimal, of plain values written as canonical JSON."""
    return hashlib.sha256(canonical_json(value).encode()).hexdigest()
