"""The constraints of a question that a certificate can cover."""

import hashlib
import re
from collections.abc import Iterable, Mapping
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from foon_asp.asp import Settings
from foon_asp.encoding.encoding_file import string_constant
from foon_asp.encoding.own_encodings import is_own
from foon_asp.hypergraph.exact_optimum import Limit
from foon_asp.problem import Problem
from foon_asp.proof.canonical_json import canonical_json
from foon_asp.proof.compiled_rules import CompiledRules
from foon_asp.proof.rule_meaning import LIBRARY, OWN, Rule, meaning_of_rule
from foon_asp.rules.passed_constraint import Constraint, LibraryUse, RuleText, find_constraint
from foon_asp.rules.ready_made import LISTED, question_of

if TYPE_CHECKING:  # clingo
    from foon_asp.certificate.own_limits import OwnLimits

_STRING = re.compile(r'"(?:[^"\\]|\\.)*"')
_FACT = re.compile(rf"(\w+)\(({_STRING.pattern}(?:;{_STRING.pattern})*)\)\.")
_UNSET = frozenset(("", '""', "#sup", "#inf"))


class Coverage(NamedTuple):
    """The constraints of a question: the ``rules`` that a certificate covers, and the others.

    Attributes:
        rules: Rules from :data:`foon_asp.proof.rule_meaning.LIBRARY` with their values, and claims about user
            rules.
        not_covered: The other constraints as texts: names of rules with their digests, constants with their
            values, and replaced encodings.
        limits: The search for limits that follow from user rules; ``None`` if it is not needed.
    """

    rules: tuple[Rule, ...] = ()
    not_covered: tuple[str, ...] = ()
    limits: "OwnLimits | None" = None

    @property
    def partial(self) -> bool:
        """Whether trees may have to keep to more than ``rules`` says.

        They may if some constraints are not covered, or if user rules are covered by claims.
        """
        return bool(self.not_covered) or any(rule["rule"] == OWN for rule in self.rules)

    def compile_rules(self, problem: Problem) -> CompiledRules:
        """Return the covered rules, compiled for the network of a problem."""
        question, nodes = question_of(problem), len(problem.network.objects)
        return CompiledRules(
            [meaning_of_rule(rule, question) for rule in self.rules], nodes, len(problem.network) + nodes
        )

    def forbidden_units(self, problem: Problem) -> frozenset[int]:
        """Return the units of a problem, by id, that covered rules remove."""
        return self.compile_rules(problem).removed

    def rules_beyond_removal(self) -> list[str]:
        """Return the names of covered rules that may do more than remove units.

        All rules have to be ready-made: claims about user rules raise ``KeyError``.
        """
        return [rule["rule"] for rule in self.rules if not LIBRARY[rule["rule"]].removes]


NOTHING = Coverage()  # no constraints at all


def coverage(settings: Settings) -> Coverage:
    """Return the constraints of a question, divided into those that a certificate covers and the others.

    Ready-made constraints are covered, with the values that were set. A ready-made constraint that lacks a
    value is omitted, since it excludes nothing. Rules that only list facts can add values for ready-made
    constraints.

    Other rules only exclude trees, so a bound without them still holds. Constants that no covered constraint
    reads are named as not covered. A replaced encoding may do anything, so it is named as not covered, too.
    Under a replaced encoding, only ready-made rules that remove units are covered.
    """
    constants = dict(setting.partition("=")[::2] for setting in settings.constants)
    uses: list[tuple[str, Mapping[str, str]]] = []
    others: list[Constraint] = []
    for constraint in dict.fromkeys(map(find_constraint, settings.constraints)):
        file = constraint.file if isinstance(constraint, LibraryUse) else constraint
        stem = file.stem if isinstance(file, Path) and is_own(file) else ""
        if stem in LIBRARY and (settings.replaced is None or LIBRARY[stem].removes):
            uses.append((stem, constraint.constants if isinstance(constraint, LibraryUse) else constants))
        else:
            others.append(constraint)
    read_names = {name for stem, _ in uses for name in LIBRARY[stem].values}
    values_by_predicate: dict[str, set[str]] = {name: set() for name in LISTED if name in read_names}
    for stem, constants_given in uses:  # what one use lists, the others read
        for name in values_by_predicate.keys() & LIBRARY[stem].values.keys():
            values_by_predicate[name] |= {string_constant(constants_given.get(LISTED[name], ""))} - {""}
    if "heats" in values_by_predicate:  # which begins with motions of the ready-made constraint
        values_by_predicate["heats"] |= _facts_of_rules(
            find_constraint(Path("never_heated")), among_others=True
        )["heats"]
    uncovered: list[str] = []
    for constraint in others:
        listed_facts = _facts_of_rules(constraint) if values_by_predicate else {}
        if listed_facts and listed_facts.keys() <= values_by_predicate.keys():
            for name, listed_values in listed_facts.items():
                values_by_predicate[name] |= listed_values
        else:
            uncovered.append(_name_with_digest(constraint))
    rules: dict[str, Rule] = {}
    for stem, constants_given in uses:
        types_by_name = LIBRARY[stem].values.items()
        values = {
            name: sorted(values_by_predicate[name])
            if value_type is list
            else _parsed_value(constants_given.get(name, ""), value_type)
            for name, value_type in types_by_name
        }
        if all(value not in (None, "", []) for value in values.values()):
            rule = {"rule": stem, **values}
            rules[canonical_json(rule)] = rule
    used_constants = {
        LISTED.get(name, name)
        for stem, constants_given in uses
        if constants_given is constants
        for name in LIBRARY[stem].values
    }
    if settings.replaced is not None:
        uncovered.append(f"encodings {settings.replaced.name}")
    uncovered += [f"{name}={value}" for name, value in constants.items() if name not in used_constants]
    return Coverage(
        tuple(rules[text] for text in sorted(rules)), tuple(sorted(set(map(_escape_unprintable, uncovered))))
    )


def _parsed_value(written: str, value_type: type) -> Any:
    """Return a value of a constraint from its text, as a number or text; ``None`` for a number not set."""
    if value_type is int:
        return None if written in _UNSET else int(written)
    return string_constant(written)


def _facts_of_rules(constraint: Constraint, among_others: bool = False) -> dict[str, set[str]]:
    """Return the values that rules list as facts, by predicate: ``{"motion": {"stir"}}``.

    If the rules also have other statements, the result is empty. With ``among_others``, other statements are
    skipped. Only facts whose arguments are texts count.
    """
    from foon_asp.encoding import encoding  # noqa: PLC0415 - they load clingo
    from foon_asp.rules import stating  # noqa: PLC0415 - they load clingo

    values: dict[str, set[str]] = {}
    for line in encoding.read_encoding(stating.load_constraints((constraint,))[constraint]).text.splitlines():
        fact = _FACT.fullmatch(line)
        if fact is not None:
            values.setdefault(fact[1], set()).update(map(string_constant, _STRING.findall(fact[2])))
        elif not among_others and line != "#program base." and not line.startswith("% "):
            return {}
    return values


def _name_with_digest(constraint: Constraint) -> str:
    """Return the name and the digest of rules as one text; for rules given as text, also the rules."""
    if isinstance(constraint, RuleText):
        return (
            f"{constraint.name} {_sha256(constraint.text.encode('utf-8', 'surrogatepass'))} {constraint.text}"
        )
    file = constraint.file if isinstance(constraint, LibraryUse) else constraint
    return f"{constraint.name} {_sha256(file.read_bytes())}"


def _sha256(content: bytes) -> str:
    """Return the SHA-256 digest of a text in bytes, in hexadecimal."""
    return hashlib.sha256(content).hexdigest()


def without_unused_claims(
    rules: Iterable[Rule], members: Iterable[int], limits: Iterable[Limit] = ()
) -> tuple[Rule, ...]:
    """Return the rules with only those claims about user rules that a proof uses.

    Some claims say that no tree has all units of a set. Such a claim remains if ``members``, the actions in
    landmarks of the proof, contain the whole set. Claims with a second set of units always remain. ``limits``
    are the limits that the proof uses. They replace the limits of the user rules.
    """
    members, used_limits = frozenset(members), [_limit_json(*limit) for limit in limits]
    return tuple(
        {
            **rule,
            "claims": [claim for claim in rule["claims"] if claim[1] or members.issuperset(claim[0])],
            "limits": used_limits,
        }
        if rule["rule"] == OWN
        else rule
        for rule in rules
    )


def _limit_json(amounts: Mapping[int, Fraction], max_sum: Fraction) -> list[Any]:
    """Return the JSON of a limit: units by their amount, and the greatest sum: ``[{"1": [3, 8]}, 1]``."""
    units: dict[str, list[int]] = {}
    for unit in sorted(amounts):
        units.setdefault(str(amounts[unit]), []).append(unit)
    return [units, int(max_sum)]


def _escape_unprintable(name: str) -> str:
    """Return a name with escapes for characters that cannot be printed, such as line ends."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in name)
