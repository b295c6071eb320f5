"""Ready-made constraints understood without clingo.

Importing clingo, parsing a constraint and asking about a tree takes as long as all the rest of a small
question. What these constraints say is known: it is what certificates are checked by.
"""

import re
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from fractions import Fraction
from itertools import accumulate
from pathlib import Path
from typing import Any, Final

from foon_asp.encoding.facts import hundredths
from foon_asp.encoding.own_encodings import is_own
from foon_asp.errors import UserError
from foon_asp.grounding.exact import LARGEST
from foon_asp.problem import Contradiction, Problem, Restriction, follow
from foon_asp.proof.constraint import LIBRARY, Meaning, Question, Rule, Units, meaning
from foon_asp.proof.ruled import Ruled
from foon_asp.resources import encodings_folder
from foon_asp.rules.constraint import Constraint, LibraryUse, find_constraint

# Values that are listed in facts, of a file of the user's as well: the constant that gives one, if one does.
LISTED: Final = {"allergen": "forbidden_ingredient", "allowed": "allowed_source", "heats": ""}
_PRICE = ("price", 2)

# What they look at beside what ours always do, but for prices. Where clingo is asked about one of them, it is
# asked about all.
READ: Final = frozenset(
    {("motion", 2), ("input", 2), ("output", 2), ("label", 2), ("ingredient", 2), ("utensil", 1)}
    | {("source", 2), ("video", 2), ("rate", 2)}
)
_HEATS = re.compile(r'heats\("([^"\\]*)"\)\.')
_NUMBER = re.compile(r"-?(0|[1-9]\d{0,9})", re.ASCII)
_TEXT = re.compile(r'("?)([^"\\]+)\1')
_WITH_REST = {"before", "not_both_motions", *(name for name in LIBRARY if name.startswith("at_most"))}
_ASKING = "require_"  # how the names of those begin that ask for units


class ReadyMade:
    """Ready-made constraints of one question, by what a certificate says of them.

    They see no further than a tree, and none asks for units that lead to no goal but by sets of which it
    requires one. ``rest`` says that some do more than to remove and to require units: then a tree that keeps
    to these still does when units are left out. It does to all of them where they are ``shrinking``.
    ``constants`` are those of all of them, as terms, and ``files`` are theirs.
    """

    local: Final = True
    spare: Final = False

    def __init__(self, rules: Sequence[Rule], constants: Mapping[str, str], files: Sequence[Path]) -> None:
        self.rules, self.constants, self.files = tuple(rules), constants, tuple(files)
        names = [rule["rule"] for rule in rules]
        self.rest = not _WITH_REST.isdisjoint(names)
        self.shrinking = not any(name.startswith(_ASKING) for name in names)
        self._last: tuple[Problem, tuple[Meaning, ...], Ruled] | None = None

    @property
    def looked_at(self) -> frozenset[tuple[str, int]]:
        """The facts that they look at, beside what ours always do."""
        return READ | {_PRICE} if "max_price" in self.constants else READ

    def fit(self, problem: Problem) -> bool:
        """Whether they say of a problem what they say to clingo.

        That is not known of the rest where they do not see all that is at hand, and of prices that clingo
        refuses.
        """
        if self.rest and problem.kitchen_seen != problem.kitchen:
            return False
        try:
            if "max_price" in self.constants:
                hundredths(problem, range(len(problem.network)), [_PRICE])
        except UserError:
            return False
        return True

    def applied(self, problem: Problem) -> Restriction | Contradiction:
        """Return what is left of a problem under what these remove and require."""
        meanings, _ = self._said(problem)
        # what is needed by a unit of the last set is made by one of the others, as the tree executes
        required = tuple(
            frozenset().union(*(sets[-1] for sets in alternatives))
            for each in meanings
            for alternatives in each.wanted
        )
        if any(each.never for each in meanings) or not all(required):
            return Contradiction()
        removed: frozenset[int] = frozenset().union(*(each.removed for each in meanings))
        return Restriction(removed.__contains__, required)

    def counted(self, problem: Problem) -> Iterator[tuple[Callable[[int], int], int]]:
        """Return how much each unit counts, a whole number, and what those of a tree come to at most."""
        for each in self._said(problem)[0]:
            if each.max_sum is not None and all(len(units) == 1 for units, _ in each.things):
                amounts = {unit: int(amount) for units, amount in each.things for unit in units}
                yield lambda unit, amounts=amounts: amounts.get(unit, 0), int(each.max_sum)  # type: ignore[misc]

    def conflict(self, problem: Problem, units: Units) -> Sequence[Units] | None:
        """Return sets of units of each of which a tree has one, and no tree that keeps to the rest does.

        ``None`` where it keeps to it; the tree keeps to what is not of the rest.
        """
        for rule, each in zip(self.rules, self._said(problem)[0], strict=True):
            if each.max_sum is not None:
                used = [thing for thing in each.things if not units.isdisjoint(thing[0])]
                used.sort(key=lambda thing: -thing[1])
                sums = accumulate((amount for _, amount in used), initial=Fraction())
                over = next((place for place, total in enumerate(sums) if total > each.max_sum), None)
                if over is not None:
                    return [members for members, _ in used[:over]]
            if each.barred is not None and (early := _too_early(problem, rule, units)):
                return [Units({unit}) for unit in sorted(early)]
        return None

    def barred(self, problem: Problem, without: Units) -> Units:
        """Return units that no tree has that keeps to them all and has none of some others."""
        meanings, _ = self._said(problem)
        return Units().union(*(each.barred(Units(), without) for each in meanings if each.barred))

    def keeps(self, problem: Problem, units: Collection[int]) -> bool:
        """Whether a tree keeps to all of them."""
        _, ruled = self._said(problem)
        tree = frozenset(units)
        return ruled.fault(tree, frozenset(range(len(problem.network))) - tree) is None

    def _said(self, problem: Problem) -> tuple[tuple[Meaning, ...], Ruled]:
        if self._last is None or self._last[0] is not problem:
            asked, nodes = question_of(problem), len(problem.network.objects)
            meanings = tuple(meaning(rule, asked) for rule in self.rules)
            self._last = problem, meanings, Ruled(meanings, nodes, len(problem.network) + nodes)
        return self._last[1:]


def ready_made(constraints: Sequence[Constraint], settings: Sequence[str]) -> ReadyMade | None:
    """Understand constraints that are all ready-made, unchanged, and asked for once, with all constants set.

    ``settings`` set constants as ``NAME=VALUE`` for those that have none of their own. ``None`` for any other
    constraints, and for values that need a closer look.
    """
    shared = dict(setting.partition("=")[::2] for setting in settings)
    files: list[Path] = []
    uses: list[tuple[str, dict[str, str]]] = []
    with suppress(UserError):
        for each in dict.fromkeys(map(find_constraint, constraints)):
            file = each.file if isinstance(each, LibraryUse) else each
            if not isinstance(file, Path) or file.stem not in LIBRARY or not is_own(file):
                return None
            files.append(file)
            uses.append((file.stem, each.constants if isinstance(each, LibraryUse) else shared))
        rules = _values(uses, shared)
        return None if rules is None or len(set(files)) < len(files) else ReadyMade(*rules, files)
    return None


def _values(
    uses: Sequence[tuple[str, Mapping[str, str]]], shared: Mapping[str, str]
) -> tuple[Sequence[Rule], Mapping[str, str]] | None:
    """Return constraints with their values, and all constants as terms; ``None`` where one is not plain."""
    facts: dict[str, set[str]] = {name: set() for name in LISTED}
    constants: dict[str, str] = {}
    taken: set[str] = set()
    rules: list[dict[str, Any]] = []
    for name, given in uses:
        rule: dict[str, Any] = {"rule": name}
        read = {LISTED.get(value, value): (value, kind) for value, kind in LIBRARY[name].values.items()}
        read.pop("", None)
        if given is not shared and given.keys() != read.keys():
            return None
        for constant, (value, kind) in read.items():
            written = given.get(constant, "")
            found = _NUMBER.fullmatch(written) if kind is int else _TEXT.fullmatch(written)
            if found is None or not written.isprintable() or (kind is int and abs(int(written)) > LARGEST):
                return None
            taken.update({constant} if given is shared else ())
            constants[constant] = written if kind is int else f'"{found[2]}"'
            if kind is list:
                facts[value].add(found[2])
            else:
                rule[value] = int(written) if kind is int else found[2]
        rules.append(rule)
    if any("heats" in LIBRARY[name].values for name, _ in uses):
        lines = (encodings_folder() / "constraints" / "never_heated.lp").read_text("utf-8").splitlines()
        said = "\n".join(line for line in lines if not line.startswith("%"))
        facts["heats"].update(_HEATS.findall(said))
    for rule in rules:  # what one use lists, the others read
        rule.update(
            (value, sorted(facts[value])) for value, k in LIBRARY[rule["rule"]].values.items() if k is list
        )
    return (rules, constants) if shared.keys() <= taken else None


def _too_early(problem: Problem, rule: Rule, units: Units) -> Units:
    """Give a unit of a tree with the later motion that runs without the earlier one, and all it builds upon.

    None where there is no such unit.
    """
    motions, needs, gives, kitchen = problem.network.motions, problem.needs, problem.gives, problem.kitchen
    maker: dict[int, int] = {}
    waiting = [unit for unit in sorted(units) if motions[unit] != rule["earlier_motion"]]
    while ready := [unit for unit in waiting if all(o in maker or o in kitchen for o in needs[unit])]:
        for unit in ready:
            if motions[unit] == rule["later_motion"]:
                found = follow(needs[unit], maker, needs, kitchen)
                assert found is not None
                return Units(found | {unit})
        for unit in ready:
            for o in gives[unit]:
                maker.setdefault(o, unit)
        waiting = [unit for unit in waiting if unit not in ready]
    return Units()


def question_of(problem: Problem) -> Question:
    """Return what constraints look at of a problem."""
    seen = problem.as_seen or problem
    return Question(
        problem.network,
        problem.kitchen,
        problem.goals,
        problem.utensils,
        lambda unit: None if seen.rates is None else seen.rate(unit),
        problem.prices.__getitem__,
        lambda unit: frozenset(problem.needs[unit]),
        lambda unit: frozenset(problem.gives[unit]),
    )
