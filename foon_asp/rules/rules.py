"""The rules of the user and of the library that hold for one question, understood as far as possible."""

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from enum import StrEnum
from functools import cache, cached_property
from typing import NamedTuple

from clingo.ast import AST, ASTType

from foon_asp.deadline import Deadline
from foon_asp.encoding.encoding import Encoding, read_encoding
from foon_asp.encoding.facts import hundredths, write_facts_read
from foon_asp.encoding.search import run
from foon_asp.errors import UserError
from foon_asp.grounding.parsing import parse
from foon_asp.grounding.run import Run
from foon_asp.grounding.stated import Stated
from foon_asp.network import Source
from foon_asp.problem import Contradiction, Having, Problem, Restriction, Trait, Wanted, reach
from foon_asp.rules.clause import Clause, Signature, literals, written
from foon_asp.rules.dependence import TIMES
from foon_asp.rules.flat_answers import FlatAnswers
from foon_asp.rules.flat_body import Asking, Constant, Fact, FlatBodies, Item, Never, NotFlatError, Term, Way
from foon_asp.rules.lifted_program import NOBODY, LiftedProgram, stands_alone
from foon_asp.rules.limit import Limit, Limiting, limiting
from foon_asp.rules.number_limits import number_checks
from foon_asp.rules.rule_kind import Analysis, Kind, Rule

_DELETING = {Kind.HELPER, Kind.FACT, Kind.DELETING}
_SHRINKING = _DELETING | {Kind.SHRINKING}
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


class _Flat(NamedTuple):
    """A rule that is answered without clingo: the ways in which it is broken, or what it asks for."""

    ways: tuple[Way, ...]
    askings: tuple[Asking, ...]


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
        endless: bool = True,
        varied: Collection[Signature] = (),
    ) -> None:
        """Look at what was read, under constants that are set as ``name=value`` for clingo.

        ``endless`` says that nobody knows whether grounding them comes to an end.
        """
        self._encodings, self._constants, self._endless = tuple(encodings), tuple(constants), endless
        statements = [statement for each in encodings for statement in each.statements]
        self._analysis = Analysis(statements, self._constants, varied)
        self.rules: tuple[Rule, ...] = self._analysis.rules
        self._live = self._analysis.of_rule
        self._bodies = FlatBodies(self._analysis)

    def varying(self, varied: Collection[Signature]) -> "Rules":
        """Give the same rules for a question that derives or varies some predicates of facts."""
        return Rules(self._encodings, self._constants, self._endless, varied)

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
    def all_deleting(self) -> bool:
        """Whether every rule is a fact or deletes: then what they remove is all that they do."""
        return all(rule.kind in _DELETING for rule in self.rules)

    @property
    def shrinking(self) -> bool:
        """Whether a tree that keeps to the rules still does when units are left out of it."""
        return all(rule.kind in _SHRINKING for rule in self.rules)

    @property
    def local(self) -> bool:
        """Whether no rule sees beyond the tree.

        Only then may rules be asked about a part of the units. What :meth:`applied` gives holds of rules that
        see further, too, since it looks at all units that can be made.
        """
        return all(rule.local for rule in self.rules)

    @property
    def together(self) -> Together:
        """What stays of the reductions under these rules."""
        if self.all_deleting:
            return Together.REDUCED
        if not self.rest:
            return Together.REQUIRED
        if not self.local:
            return Together.PLAIN
        return Together.BOUNDED if self.spare else Together.CUT

    @property
    def spare(self) -> bool:
        """Whether a tree that keeps to the rest may need units that lead to no goal."""
        return any(rule.kind is not Kind.SHRINKING for rule in self.rest)

    @cached_property
    def rest(self) -> tuple[Rule, ...]:
        """The rules that :meth:`applied` does not settle: shrinking ones, some that require, and others."""
        settled = set(self._settled)
        return tuple(
            rule
            for number, rule in enumerate(self.rules)
            if number not in settled and rule.kind is not Kind.HELPER
        )

    @cached_property
    def _settled(self) -> list[int]:
        """The places of the rules that :meth:`applied` settles."""
        return [
            number
            for number, rule in enumerate(self.rules)
            if rule.kind in {Kind.FACT, Kind.DELETING}
            or (rule.one_of and (number in self._flat or stands_alone(self._live[number])))
        ]

    @property
    def wanted(self) -> list[Wanted] | None:
        """The units that are asked for.

        ``None`` where rules see more than a tree, or do more than to rule units out and to ask for some.
        """
        if not self.local or self.rest or not self._flat.keys() >= set(self._settled):
            return None
        return [
            Wanted([tuple(_traits(way)) for way in asking.helping if way.unit is not None], _always(asking))
            for asking in self._askings
        ]

    @property
    def _askings(self) -> list[Asking]:
        """What is asked for by the rules that are answered without clingo."""
        return [asking for flat in self._flat.values() for asking in flat.askings]

    @cached_property
    def _flat(self) -> "dict[int, _Flat]":
        """What is answered without clingo, by the place of the rule."""
        found: dict[int, _Flat] = {}
        for number, rule in enumerate(self.rules):
            if rule.local and (rule.one_of or rule.kind in {Kind.FACT, Kind.DELETING}):
                with suppress(NotFlatError):
                    found[number] = self._flattened(rule, self._live[number])
        return found

    def _flattened(self, rule: Rule, clauses: Sequence[Clause]) -> _Flat:
        bodies = self._bodies
        if rule.one_of:
            return _Flat((), tuple(asking for clause in clauses for asking in bodies.askings(clause)))
        return _Flat(tuple(way for clause in clauses for way in bodies.ways(clause)), ())

    @cached_property
    def _limiting(self) -> dict[int, Limiting]:
        """The rules that limit executions, by their places."""
        found = {
            number: limiting(self._analysis, each[0])
            for number, each in enumerate(self._live)
            if len(each) == 1
        }
        return {number: each for number, each in found.items() if each is not None}

    @property
    def only_limits(self) -> bool:
        """Whether no rule looks at how often units are executed but to say how often at most."""
        at_most = {number for number, each in self._limiting.items() if not each.at_least}
        others = (c for number, each in enumerate(self._live) if number not in at_most for c in each)
        return all(literal.signature != TIMES for clause in others for literal in literals(clause.body))

    def limits(self, problem: Problem, deadline: Deadline) -> list[Limit]:
        """Give what rules say of how often units are executed, as far as these are limits of sums.

        Raises as :meth:`applied`.
        """
        limiting = self._limiting
        if not limiting:
            return []
        rows = [
            (f"_counts({number},{row})", body) for number, each in limiting.items() for row, body in each.rows
        ]
        program = LiftedProgram(self._analysis, (), rows)
        found = self._ask(program, [("_counts", 3)], problem, deadline)
        counts: dict[int, list[tuple[int, int]]] = {number: [] for number in limiting}
        for number, weight, unit in () if found is None else found.rows["_counts"]:
            here = problem.network.unit_of_number(unit)
            if here is not None:
                counts[number].append((weight, here))
        return [
            limit
            for number, each in limiting.items()
            if found is not None
            for limit in each.limits(counts[number])
        ]

    def counted(self, problem: Problem) -> Iterator[tuple[Callable[[int], bool], int]]:
        """Give which units rules count, as far as that needs no clingo, and how many a tree has at most."""
        for number, each in self._limiting.items():
            if each.single and not (each.each or each.at_least) and self.rules[number].local:
                clause = self._live[number][0]
                try:
                    bodies = [clause._replace(body=body) for body in each.bodies()]
                    ways = [way for body in bodies for way in self._bodies.ways(body)]
                except NotFlatError:
                    continue
                answers = FlatAnswers(problem, self._bodies.tables, self._bodies.size, {})
                yield cache(answers.removed(ways)), each.bound

    def applied(
        self, problem: Problem, deadline: Deadline | None = None
    ) -> Restriction | Contradiction | None:
        """Say what is left of a problem under the rules that are settled without a search.

        A tree keeps to these if and only if it has no removed unit, and a unit of each required set. What
        rules see are all units that can be made without any rule. ``None`` says that the rules could not be
        settled so: the program as a whole then shows what is wrong with them. Raises ``KeyboardInterrupt`` at
        a limit and at ctrl-C, and :class:`UserError` for prices that rules look at and cannot be told.
        """
        if problem.restriction is not None:
            problem = replace(problem, restriction=None)
        found = self._by_hand(list(self._flat), problem)
        others = [number for number in self._settled if number not in self._flat]
        if not others or isinstance(found, Contradiction):
            return found
        more = self._by_clingo(others, problem, deadline or Deadline())
        if not isinstance(more, Restriction):
            return more
        removed, gone = found.removed, more.removed
        return Restriction(lambda unit: gone(unit) or removed(unit), (*found.required, *more.required))

    def _by_hand(self, numbers: Sequence[int], problem: Problem) -> Restriction | Contradiction:
        """Find what rules remove and require without clingo; what they remove is found when it is asked."""
        prices = self._prices(problem) if self._analysis.reads(("price", 2)) else {}
        answers = FlatAnswers(problem, self._bodies.tables, self._bodies.size, prices)
        ways = [way for number in numbers for way in self._flat[number].ways]
        if answers.any_holds(way for way in ways if way.unit is None):
            return Contradiction()
        askings = (asking for number in numbers for asking in self._flat[number].askings)
        required = [units for each in askings for units in answers.asked(each) if units is not None]
        if not all(required):
            return Contradiction()
        return Restriction(answers.removed(ways), tuple(required))

    def _prices(self, problem: Problem) -> dict[int, int]:
        """Give the prices of units as rules see them; raises where those that can be made have none such."""
        read = [("price", 2)]
        try:
            return hundredths(problem, range(len(problem.network)), read)
        except UserError:
            return hundredths(problem, reach(problem).units, read)

    def _by_clingo(
        self, numbers: Sequence[int], problem: Problem, deadline: Deadline
    ) -> Restriction | Contradiction | None:
        """Let clingo derive what rules remove and require, from the facts that they look at."""
        program = LiftedProgram(self._analysis, numbers)
        found = self._ask(program, program.predicates, problem, deadline)
        if found is None:
            return None
        removed = found.atoms["_removed"]
        helps = [found.atoms[f"_helps_{number}"] for number in found.atoms["_asks"]]
        if NOBODY in removed or not all(helps):
            return Contradiction()
        required = [_ids(problem, each) for each in helps if NOBODY not in each]
        return Restriction(_ids(problem, removed).__contains__, tuple(required))

    def _checks(self, program: LiftedProgram) -> str:
        """Give rules that find what a program calculates beyond clingo's numbers."""
        analysis = self._analysis
        if not number_checks((*analysis.definitions, *analysis.statements)):
            return ""
        statements: list[AST] = []
        parse(Stated("rules", program.text), statements.append, lambda *_: None)
        return number_checks(statements)

    def _ask(
        self, program: LiftedProgram, predicates: Sequence[Signature], problem: Problem, deadline: Deadline
    ) -> Run | None:
        """Let clingo derive some predicates; ``None`` where it has no answer or something is wrong."""
        with deadline.watched("writing facts"):
            rules = program.text + self._checks(program)
            text = rules + write_facts_read(problem, sorted(reach(problem).units), program.reads)
        constants = [word for constant in self._constants for word in ("-c", constant)]
        try:
            found = run((), text, constants, deadline, "ignore", predicates=predicates, endless=self._endless)
        except UserError:
            return None
        if found.units is None:
            if not found.exhausted:
                deadline.check()
                raise KeyboardInterrupt
            return None
        return found


def _ids(problem: Problem, numbers: Iterable[int]) -> frozenset[int]:
    """Give units by id that are known by their numbers in the whole network."""
    found = map(problem.network.unit_of_number, numbers)
    return frozenset(unit for unit in found if unit is not None)


def _facts(way: Way) -> list[Fact]:
    return [item for item in way.items if isinstance(item, Fact)]


def _always(asking: Asking) -> bool:
    """Whether a unit is asked for whatever the facts are."""
    return not asking.when.items and all(way.unit is not None for way in asking.helping)


def _traits(way: Way) -> Iterator[Trait]:
    """Give what a unit has of which a way holds, as far as words of the rule say it."""
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
    """Give the texts that facts of some predicates have in a rule."""
    return [word for fact in facts if fact.signature[0] in predicates for word in _text(fact.terms[-1])]


def _saying(statements: Iterable[AST]) -> list[AST]:
    """Give the statements that are in a ready-made constraint whatever its constants are called."""
    return [each for each in statements if each.ast_type not in {ASTType.Program, ASTType.Comment}]
