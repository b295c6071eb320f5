"""The header of a certificate: form, version, keys, seal, level and digests."""

from collections.abc import Mapping
from typing import Any, NamedTuple

from foon_asp.proof.canonical_json import digest_of
from foon_asp.proof.certificate_fields import read_object
from foon_asp.proof.certificate_rules import read_rules
from foon_asp.proof.certificate_subject import Subject
from foon_asp.proof.refusal import require
from foon_asp.proof.rule_meaning import Rule

CERTIFICATE_KEYS = frozenset(
    (
        *("format", "version", "claim", "goals", "containers", "level", "objective", "digests", "rules"),
        *("measures", "not_covered", "tree", "costs", "bound", "cuts", "proof", "seal"),
    )
)


class Form(NamedTuple):
    """A form of certificates: its name, its version, and the keys that every certificate of the form has."""

    name: str
    version: int
    keys: frozenset[str]


TREE_FORM = Form("foon-asp certificate", 5, CERTIFICATE_KEYS)


def seal(certificate: Mapping[str, Any]) -> str:
    """Return the seal of a certificate: the SHA-256 digest of all its content except its key ``seal``."""
    return digest_of({key: value for key, value in certificate.items() if key != "seal"})


def check_header(certificate: Any, form: Form, subject: Subject) -> tuple[Rule, ...]:
    """Check form, version, keys, seal, level, rules and digests of a certificate; return its rules.

    Raises :class:`RefusedError` at the first fault. The rules are checked for their form alone.
    """
    require(isinstance(certificate, dict), "expected an object with the keys of a certificate")
    require(certificate.get("format") == form.name, f"expected the format {form.name!r}")
    version = certificate.get("version")
    is_known = type(version) is int and version == form.version
    require(is_known, f"expected version {form.version} of the format")
    require(certificate.keys() == form.keys, f"expected the keys {', '.join(sorted(form.keys))}")
    require(certificate["seal"] == seal(certificate), "the seal does not match: something was changed")
    level, network = certificate["level"], subject.network
    require(type(level) is int and level == network.level, f"not a claim about level {network.level}")
    rules = read_rules(certificate["rules"], len(network))
    digests = subject.digests(rules)
    stated_digests = read_object(certificate["digests"], tuple(digests))
    for name, digest in digests.items():
        require(stated_digests[name] == digest, f"{name}: not the one that the certificate is about")
    return rules
