"""Ready-made constraints, evaluated without clingo.

Importing clingo, parsing a constraint and checking a tree takes as long as all other work of a small
question. Here the constraints have the meaning by which certificates are checked.
"""

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, Final

from foon_asp.deadline import Deadline
from foon_asp.encoding.exact import LARGEST
from foon_asp.encoding.fact_writer import prices_in_hundredths
from foon_asp.encoding.own_encodings import is_own
from foon_asp.errors import UserError
from foon_asp.problem import Contradiction, LinearRow, Problem, Restriction
from foon_asp.proof.compiled_rules import CompiledRules
from foon_asp.proof.rule_meaning import LIBRARY, Meaning, Question, Rule, meaning_of_rule
from foon_asp.resources import encodings_folder
from foon_asp.rules.passed_constraint import Constraint, LibraryUse, find_constraint

# Parameters that are listed in facts, of a user file as well: the constant that sets one, empty without one.
LISTED: Final = {"allergen": "forbidden_ingredient", "allowed": "allowed_source", "heats": ""}
_PRICE = ("price", 2)

# Predicates that they read in addition to those of the built-in encodings, without prices. Where clingo
# checks one of the constraints, it checks all.
READ: Final = frozenset(
    {("motion", 2), ("input", 2), ("output", 2), ("label", 2), ("ingredient", 2), ("utensil", 1)}
    | {("source", 2), ("video", 2), ("rate", 2)}
)
_HEATS = re.compile(r'heats\("([^"\\]*)"\)\.')
_INTEGER = re.compile(r"-?(0|[1-9]\d{0,9})", re.ASCII)
_QUOTED_TEXT = re.compile(r'("?)([^"\\]+)\1')
_WITH_UNSETTLED = {"before", "not_both_motions", *(name for name in LIBRARY if name.startswith("at_most"))}
_REQUIRING_PREFIX = "require_"  # prefix of the names of constraints that require units


class ReadyMade:
    """Ready-made constraints of one question, which are evaluated without clingo.

    ``local``: ``True``, as the constraints read facts about the tree alone.
    ``redundant``: ``False``, as only required sets, and no other constraints, can demand redundant units.
    ``unsettled``: whether some constraints are more than removals of units and required sets.
    ``shrinking``: whether all constraints are antimonotone: if a tree keeps to them, so does every subtree.
    ``constants``: the constants by name, as terms of clingo.
    ``files``: the files of the constraints.
    """

    local: Final = True
    redundant: Final = False

    def __init__(self, rules: Sequence[Rule], constants: Mapping[str, str], files: Sequence[Path]) -> None:
        """Find out from the names of the constraints whether they are unsettled or shrinking.

        ``rules`` are the constraints with the values of their constants, as in certificates.
        """
        self.rules, self.constants, self.files = tuple(rules), constants, tuple(files)
        names = [rule["rule"] for rule in rules]
        self.unsettled = not _WITH_UNSETTLED.isdisjoint(names)
        self.shrinking = not any(name.startswith(_REQUIRING_PREFIX) for name in names)
        self._last: tuple[Problem, tuple[Meaning, ...], CompiledRules] | None = None

    @property
    def looked_at(self) -> frozenset[tuple[str, int]]:
        """The predicates that the constraints read, in addition to those of the built-in encodings.

        ``price/2`` is among them only if a constraint limits the price.
        """
        return READ | {_PRICE} if "max_price" in self.constants else READ

    def has_same_meaning(self, problem: Problem) -> bool:
        """Whether the constraints mean the same for a problem here as in clingo.

        Return ``False`` if some are ``unsettled`` and rules see only a part of the kitchen
        (``kitchen_seen``). Return ``False`` also if they limit the price, and clingo refuses the prices.
        """
        if self.unsettled and problem.kitchen_seen != problem.kitchen:
            return False
        try:
            if "max_price" in self.constants:
                prices_in_hundredths(problem, range(len(problem.network)), [_PRICE])
        except UserError:
            return False
        return True

    def leave_to_search(self, problem: Problem) -> bool:
        """Return ``False``: the search is never left to enforce the constraints."""
        return False

    def restriction_of(self, problem: Problem, deadline: Deadline) -> Restriction | Contradiction:
        """Return the units that the constraints remove from a problem, and the sets that they require.

        Return :class:`Contradiction` if no tree keeps to some constraint, or if a required set is empty. The
        deadline is not looked at.
        """
        meanings, _ = self._meanings(problem)
        # what is needed by a unit of the last set is made by one of the others, as the tree executes
        required = tuple(
            frozenset().union(*(sets[-1] for sets in alternatives))
            for meaning in meanings
            for alternatives in meaning.requirements
        )
        if any(meaning.never for meaning in meanings) or not all(required):
            return Contradiction()
        removed: frozenset[int] = frozenset().union(*(meaning.removed for meaning in meanings))
        return Restriction(removed.__contains__, required)

    def upper_limits(self, problem: Problem, deadline: Deadline) -> Iterator[LinearRow]:
        """Yield the constraints that bound a sum of amounts of units from above, as rows.

        A constraint is left out if it counts a set of several units only once. The deadline is not looked at.
        """
        for rule_meaning in self._meanings(problem)[0]:
            if rule_meaning.max_sum is not None and all(
                len(units) == 1 for units, _ in rule_meaning.counted_sets
            ):
                amounts = {unit: int(amount) for units, amount in rule_meaning.counted_sets for unit in units}
                yield LinearRow(amounts, int(rule_meaning.max_sum))

    def keeps(self, problem: Problem, units: Collection[int]) -> bool:
        """Whether a tree, given by the ids of its units, keeps to all constraints."""
        _, ruled = self._meanings(problem)
        tree = frozenset(units)
        return ruled.fault(tree, frozenset(range(len(problem.network))) - tree) is None

    def _meanings(self, problem: Problem) -> tuple[tuple[Meaning, ...], CompiledRules]:
        """Return the meanings of the constraints for a problem, and a checker of trees for these meanings.

        The result for the last problem is cached.
        """
        if self._last is None or self._last[0] is not problem:
            question, nodes = question_of(problem), len(problem.network.objects)
            meanings = tuple(meaning_of_rule(rule, question) for rule in self.rules)
            self._last = problem, meanings, CompiledRules(meanings, nodes, len(problem.network) + nodes)
        return self._last[1:]


def ready_made(constraints: Sequence[Constraint], settings: Sequence[str]) -> ReadyMade | None:
    """Return the constraints if each is ready-made, unchanged, used once, and has all its constants set.

    ``settings``, as ``NAME=VALUE``, set the constants of constraints that are passed without constants.

    Return ``None`` for any other constraints, and for one with an error. Return ``None`` also if a setting is
    not used, and if a value is not a plain text or number.
    """
    shared = dict(setting.partition("=")[::2] for setting in settings)
    files: list[Path] = []
    uses: list[tuple[str, dict[str, str]]] = []
    with suppress(UserError):
        for constraint in dict.fromkeys(map(find_constraint, constraints)):
            file = constraint.file if isinstance(constraint, LibraryUse) else constraint
            if not isinstance(file, Path) or file.stem not in LIBRARY or not is_own(file):
                return None
            files.append(file)
            uses.append((file.stem, constraint.constants if isinstance(constraint, LibraryUse) else shared))
        rules = _rules_with_values(uses, shared)
        return None if rules is None or len(set(files)) < len(files) else ReadyMade(*rules, files)
    return None


def _rules_with_values(
    uses: Sequence[tuple[str, Mapping[str, str]]], shared: Mapping[str, str]
) -> tuple[Sequence[Rule], Mapping[str, str]] | None:
    """Return constraints with the values of their constants, and all constants as terms of clingo.

    ``uses`` are pairs of a constraint's name and its constants. ``shared`` are the constants from settings; a
    constraint without constants of its own is paired with them. A list in one use, such as allergens, holds
    for all uses.

    Return ``None`` if a value is missing, or is not a plain text or number. Return ``None`` also if a setting
    in ``shared`` is not used.
    """
    facts: dict[str, set[str]] = {name: set() for name in LISTED}
    constants: dict[str, str] = {}
    used_names: set[str] = set()
    rules: list[dict[str, Any]] = []
    for name, constants_given in uses:
        rule: dict[str, Any] = {"rule": name}
        parameters = {LISTED.get(value, value): (value, kind) for value, kind in LIBRARY[name].values.items()}
        parameters.pop("", None)
        if constants_given is not shared and constants_given.keys() != parameters.keys():
            return None
        for constant, (value, kind) in parameters.items():
            written = constants_given.get(constant, "")
            match = _INTEGER.fullmatch(written) if kind is int else _QUOTED_TEXT.fullmatch(written)
            if match is None or not written.isprintable() or (kind is int and abs(int(written)) > LARGEST):
                return None
            used_names.update({constant} if constants_given is shared else ())
            constants[constant] = written if kind is int else f'"{match[2]}"'
            if kind is list:
                facts[value].add(match[2])
            else:
                rule[value] = int(written) if kind is int else match[2]
        rules.append(rule)
    if any("heats" in LIBRARY[name].values for name, _ in uses):
        lines = (encodings_folder() / "constraints" / "never_heated.lp").read_text("utf-8").splitlines()
        facts_text = "\n".join(line for line in lines if not line.startswith("%"))
        facts["heats"].update(_HEATS.findall(facts_text))
    for rule in rules:  # what one use lists, the others read
        rule.update(
            (value, sorted(facts[value])) for value, k in LIBRARY[rule["rule"]].values.items() if k is list
        )
    return (rules, constants) if shared.keys() <= used_names else None


def question_of(problem: Problem) -> Question:
    """Return the parts of a problem that constraints read: its network, kitchen, goals, rates and prices.

    The rates are those that user rules see.
    """
    problem_seen = problem.as_seen or problem
    return Question(
        problem.network,
        problem.kitchen,
        problem.goals,
        problem.utensils,
        lambda unit: None if problem_seen.rates is None else problem_seen.rate(unit),
        problem.prices.__getitem__,
        lambda unit: frozenset(problem.needs[unit]),
        lambda unit: frozenset(problem.gives[unit]),
    )
