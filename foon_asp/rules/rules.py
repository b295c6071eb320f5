"""The rules of the user and of the library that hold for one question, understood as far as possible."""

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import replace
from enum import StrEnum
from functools import cache, cached_property
from typing import NamedTuple

from clingo.ast import AST, ASTType

from foon_asp.encoding.encoding import Encoding, read_encoding
from foon_asp.encoding.facts import hundredths
from foon_asp.errors import UserError
from foon_asp.grounding.stated import Stated
from foon_asp.network import Source
from foon_asp.problem import Contradiction, Having, Problem, Restriction, Trait, Wanted, reach
from foon_asp.rules.clause import Signature, literals, written
from foon_asp.rules.dependence import TIMES
from foon_asp.rules.flat_answers import FlatAnswers
from foon_asp.rules.flat_body import Asking, Constant, Fact, Item, Never, Term, Way
from foon_asp.rules.limit import Limit
from foon_asp.rules.rule_kind import Analysis, Kind, Rule

_SHRINKING = {Kind.HELPER, Kind.FACT, Kind.DELETING, Kind.SHRINKING}
_KITCHEN = ("kitchen", 1)
_HAVING = {
    "motion": Having.MOTION,
    **dict.fromkeys(("input", "needs"), Having.INPUT),
    **dict.fromkeys(("output", "gives"), Having.OUTPUT),
}


class Told(NamedTuple):
    """A rule for people: its text, and places in files.

    ``use`` says how a ready-made constraint was asked for that has constants of its own.
    """

    rule: Rule
    text: str
    source: Source
    use: str
    reason_source: Source | None
    further_source: Source | None


class Together(StrEnum):
    """What stays of the reductions under some rules.

    ``REDUCED``: all of them, since the rules only remove units. ``REQUIRED``: all of them, with what is
    required as more goals. ``CUT``: what cannot matter for the goals is left out, and what bounds exclude.
    ``BOUNDED``: only the latter. ``PLAIN``: nothing is left out.
    """

    REDUCED = "reduced"
    REQUIRED = "required"
    CUT = "cut"
    BOUNDED = "bounded"
    PLAIN = "plain"


class Rules:
    """All rules that are added to one question, taken together.

    ``rules`` has each of them with its kind, in the order of the files. The kinds hold for questions whose
    facts are what the network, the kitchen and the goals say; where a question derives or varies a predicate
    of facts, :meth:`varying` gives the kinds for that.
    """

    def __init__(
        self,
        encodings: Sequence[Encoding],
        constants: Sequence[str],
        varied: Collection[Signature] = (),
    ) -> None:
        """Look at what was read, under constants that are set as ``name=value`` for clingo."""
        self._encodings, self._constants = tuple(encodings), tuple(constants)
        statements = [statement for each in encodings for statement in each.statements]
        self._analysis = Analysis(statements, self._constants, varied)
        self.rules: tuple[Rule, ...] = self._analysis.rules

    def varying(self, varied: Collection[Signature]) -> "Rules":
        """Return the same rules for a question that derives or varies some predicates of facts."""
        return Rules(self._encodings, self._constants, varied)

    @cached_property
    def told(self) -> tuple["Told", ...]:
        """The rules for people: of a ready-made constraint with constants of its own, as in its file."""
        texts: dict[int, str] = {}
        uses: dict[str, Stated] = {}
        for encoding in self._encodings:
            rules = encoding.rules
            file, originals = rules, encoding.statements
            if isinstance(rules, Stated) and rules.file is not None:
                uses[rules.place] = rules
                file, originals = rules.file, read_encoding(rules.file).statements
            pairs = zip(_saying(encoding.statements), _saying(originals), strict=True)
            texts.update((id(statement), written(original, file)) for statement, original in pairs)

        def found(source: Source | None) -> Source | None:
            use = None if source is None else uses.get(source.file)
            return source if source is None or use is None else source._replace(file=str(use.file))

        return tuple(
            Told(
                rule,
                texts[id(statement)],
                found(rule.source) or rule.source,
                uses[rule.source.file].written if rule.source.file in uses else "",
                found(rule.reason_source),
                found(rule.further_source),
            )
            for rule, statement in zip(self.rules, self._analysis.statements, strict=True)
        )

    @property
    def shrinking(self) -> bool:
        """Whether a tree that keeps to the rules still does when units are left out of it."""
        return all(rule.kind in _SHRINKING for rule in self.rules)

    @property
    def local(self) -> bool:
        """Whether no rule sees beyond the tree.

        Only then may rules be asked about a part of the units.
        """
        return all(rule.local for rule in self.rules)

    @property
    def together(self) -> Together:
        """What stays of the reductions under these rules."""
        if not self.rest:
            return Together.REQUIRED if self._analysis.askings else Together.REDUCED
        if not self.local:
            return Together.PLAIN
        return Together.BOUNDED if self.spare else Together.CUT

    @property
    def spare(self) -> bool:
        """Whether a tree that keeps to the rest may need units that lead to no goal."""
        return any(rule.kind not in _SHRINKING for rule in self.rest)

    @cached_property
    def rest(self) -> tuple[Rule, ...]:
        """The rules that :meth:`applied` does not settle, so that clingo is asked about them."""
        settled = self._analysis.removals.keys() | self._analysis.askings.keys()
        return tuple(
            rule
            for number, rule in enumerate(self.rules)
            if number not in settled and rule.kind is not Kind.HELPER
        )

    @property
    def wanted(self) -> list[Wanted] | None:
        """The units that are asked for.

        ``None`` where rules see more than a tree, or do more than to rule units out and to ask for some.
        """
        if not self.local or self.rest:
            return None
        return [
            Wanted([tuple(_traits(way)) for way in asking.helping if way.unit is not None], _always(asking))
            for asking in self._askings
        ]

    @property
    def _askings(self) -> list[Asking]:
        return [asking for askings in self._analysis.askings.values() for asking in askings]

    @property
    def only_limits(self) -> bool:
        """Whether no rule looks at how often units are executed but to say how often at most."""
        at_most = {number for number, row in self._analysis.rows.items() if not row.at_least}
        others = (
            clause
            for number, each in enumerate(self._analysis.of_rule)
            if number not in at_most
            for clause in each
        )
        return all(literal.signature != TIMES for clause in others for literal in literals(clause.body))

    def limits(self, problem: Problem) -> list[Limit]:
        """Return what rules say of how often units are executed, as far as these are limits of sums.

        Raises :class:`UserError` as :meth:`applied` does.
        """
        if not self._analysis.rows:
            return []
        answers, units = self._answers(problem), sorted(reach(problem).units)
        found: list[Limit] = []
        for row in self._analysis.rows.values():
            weight = answers.weight(row)
            weights = {unit: number for unit in units if (number := weight(unit))}
            if row.each:
                found += [Limit({unit: 1}, row.bound) for unit in weights]
            else:
                found.append(Limit(weights, row.bound, row.at_least, row.used))
        return found

    def counted(self, problem: Problem) -> Iterator[tuple[Callable[[int], int], int]]:
        """Return how much each unit counts in a sum that a rule bounds, and what a tree comes to at most."""
        rows = [row for row in self._analysis.rows.values() if not (row.each or row.at_least)]
        if rows:
            answers = self._answers(problem)
            yield from ((cache(answers.weight(row)), row.bound) for row in rows)

    def applied(self, problem: Problem) -> Restriction | Contradiction:
        """Return what is left of a problem under the rules that remove units, or ask for one of a set.

        A tree keeps to these if and only if it has no removed unit, and a unit of each required set. Whether
        a unit is removed is found when it is asked. Raises :class:`UserError` for prices that rules look at
        and cannot be told.
        """
        if problem.restriction is not None:
            problem = replace(problem, restriction=None)
        answers = self._answers(problem)
        ways = [way for each in self._analysis.removals.values() for way in each]
        if answers.any_holds(way for way in ways if way.unit is None):
            return Contradiction()
        required = [units for each in self._askings for units in answers.asked(each) if units is not None]
        if not all(required):
            return Contradiction()
        return Restriction(answers.removed(ways), tuple(required))

    def _answers(self, problem: Problem) -> FlatAnswers:
        prices = self._prices(problem) if self._analysis.reads(("price", 2)) else {}
        bodies = self._analysis.bodies
        return FlatAnswers(problem, bodies.tables, bodies.size, prices)

    def _prices(self, problem: Problem) -> dict[int, int]:
        """Give the prices of units as rules see them; raises where those that can be made have none such."""
        read = [("price", 2)]
        try:
            return hundredths(problem, range(len(problem.network)), read)
        except UserError:
            return hundredths(problem, reach(problem).units, read)


def _facts(way: Way) -> list[Fact]:
    return [item for item in way.items if isinstance(item, Fact)]


def _always(asking: Asking) -> bool:
    """Whether a unit is asked for whatever the facts are."""
    return not asking.when.items and all(way.unit is not None for way in asking.helping)


def _traits(way: Way) -> Iterator[Trait]:
    """Return what a unit has of which a way holds, as far as words of the rule say it."""
    facts = _facts(way)
    for (name, _), terms in facts:
        if terms[0] == way.unit and name in _HAVING:
            having, of_node = _HAVING[name], [fact for fact in facts if fact.terms[0] == terms[-1]]
            if having is Having.INPUT and any(
                _is_never(item, Fact(_KITCHEN, terms[-1:])) for item in way.items
            ):
                having = Having.MADE
            said = _text(terms[-1]) if name == "motion" else _named(of_node, {"label", "ingredient"})
            yield from (Trait(having, word) for word in said)


def _is_never(item: Item, fact: Fact) -> bool:
    """Whether an item says that a fact is not there, maybe with others."""
    return isinstance(item, Never) and any(way.items == (fact,) for way in item.ways)


def _text(term: Term) -> list[str]:
    return [term.value] if isinstance(term, Constant) and isinstance(term.value, str) else []


def _named(facts: Iterable[Fact], predicates: Collection[str]) -> list[str]:
    """Return the texts that facts of some predicates have in a rule."""
    return [word for fact in facts if fact.signature[0] in predicates for word in _text(fact.terms[-1])]


def _saying(statements: Iterable[AST]) -> list[AST]:
    """Return the statements that are in a ready-made constraint whatever its constants are called."""
    return [each for each in statements if each.ast_type not in {ASTType.Program, ASTType.Comment}]
