"""Canonical JSON, by which equal values have equal texts and equal digests."""

import hashlib
import json


def canonical_json(value: object) -> str:
    """Return plain values as canonical JSON: keys in order, without spaces."""
    return json.dumps(value, sort_keys=True, separators=(",", ":"), check_circular=False)


def digest_of(value: object) -> str:
    """Return the SHA-256 digest of plain values, written as canonical JSON."""
    return hashlib.sha256(canonical_json(value).encode()).hexdigest()
