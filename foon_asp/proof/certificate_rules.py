"""The rules of a certificate: the constraints of its claim, read from JSON.

``rule_meaning.py`` says what these rules mean.
"""

import hashlib
from collections.abc import Mapping
from typing import Any

from foon_asp.proof.canonical_json import canonical_json
from foon_asp.proof.certificate_fields import (
    read_list,
    read_names,
    read_numbers,
    read_object,
    read_pair,
    read_rational,
)
from foon_asp.proof.certificate_limits import ALLOWED
from foon_asp.proof.refusal import CheckLimitError, require
from foon_asp.proof.rule_meaning import ALL_STEPS, LIBRARY, OWN, Rule


def read_rules(value: Any, unit_count: int) -> tuple[Rule, ...]:
    """Return the rules of a claim; refuse rules that are unknown, malformed, repeated or not sorted.

    The claims about user rules are one rule of the list; only their form is checked. ``unit_count`` is the
    number of units of the network. Raises :class:`CheckLimitError` if there are more rules than
    :class:`CertificateLimits` allows.
    """
    rules = [read_object(rule) for rule in read_list(value)]
    if len(rules) > ALLOWED.rules:
        raise CheckLimitError(f"it has more than {ALLOWED.rules} rules")
    for rule in rules:
        name = rule.get("rule")
        if name == OWN:
            _check_user_rules(rule, unit_count)
            continue
        if name == ALL_STEPS:
            read_object(rule, ("rule", "units"))
            read_numbers(rule["units"], unit_count)
            continue
        require(isinstance(name, str) and name in LIBRARY, "a rule is unknown")
        values = LIBRARY[rule["rule"]].values
        read_object(rule, ("rule", *values))
        for key, kind in values.items():
            require(type(rule[key]) is kind, "a value of a rule is of another kind")
            read_names(rule[key] if kind is list else [rule[key]] if kind is str else [])
    require(sum(rule["rule"] == OWN for rule in rules) <= 1, "rules of the user's own stand twice")
    texts = [canonical_json(rule) for rule in rules]
    require(texts == sorted(set(texts)), "expected rules in order, each of them once")
    return tuple(rules)


def _check_user_rules(rule: Rule, unit_count: int) -> None:
    """Refuse claims about user rules that are malformed; their truth is taken on trust.

    They consist of the texts of the rules with their digests, pairs of sets of units, and limits on sums.
    """
    read_object(rule, ("rule", "claims", "constants", "files", "library", "limits"))
    for key in ("constants", "library"):
        read_names(rule[key])
    for file in read_list(rule["files"]):
        read_object(file, ("name", "sha256", "text"))
        read_names([file["name"]])
        read_names([file["text"]])
        require(file["name"].isprintable(), "a file of rules has no printable name")
        sha = hashlib.sha256(file["text"].encode()).hexdigest()
        require(file["sha256"] == sha, "a text of rules does not have its digest")
    for claim in read_list(rule["claims"]):
        for unit_set in read_pair(claim, "two sets of units in a claim"):
            read_numbers(unit_set, unit_count, ascending=unit_set != [])
    for limit in read_list(rule["limits"]):
        amounts, max_sum = read_pair(limit, "amounts and their limit")
        require(type(max_sum) is int, "a limit is no whole number")
        counted: list[int] = []
        for amount, counted_units in read_object(amounts).items():
            number = read_rational(amount)
            is_count = number > 0 and number.denominator == 1
            require(is_count, "a limit counts what is no whole number above zero")
            counted += read_numbers(counted_units, unit_count)
        require(len(set(counted)) == len(counted), "a limit counts a unit twice")


def trusted_claims(certificate: Mapping[str, Any]) -> Rule | None:
    """Return the claims of a certificate about user rules, as one rule.

    The claims are taken on trust. Return ``None`` if the certificate has no such claims.
    """
    return next((rule for rule in certificate.get("rules", ()) if rule["rule"] == OWN), None)
