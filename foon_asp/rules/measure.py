"""User measures: rules that define the cost of each unit, and their evaluation by clingo."""

import hashlib
import re
from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

from foon_asp.deadline import Deadline
from foon_asp.encoding.fact_writer import OBJECT_FACTS, object_facts, quote, write_worlds
from foon_asp.encoding.run import ProgramError
from foon_asp.encoding.stated import Stated
from foon_asp.errors import UserError
from foon_asp.network import Network, Source
from foon_asp.problem import Problem
from foon_asp.rules.passed_constraint import exists
from foon_asp.rules.tuning import TUNING
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity
from foon_asp.text.plain_file import read_plain_text

if TYPE_CHECKING:  # clingo, which is not needed before there is a measure
    from foon_asp.encoding.derived import Value
    from foon_asp.rules.measure_rules import MeasureRules, Statement

Cost = int | Fraction

_DECIMAL = re.compile(r"[0-9]{1,1000}(\.[0-9]{1,1000})?", re.ASCII)


@dataclass(frozen=True)
class Measure:
    """User rules that define an objective by the cost of each unit.

    ``name`` is the name of the objective, and ``text`` has the rules. ``place`` says where the rules are
    from: the path of a file, or a name such as ``measure 1`` for rules passed as text. A file may define
    several measures.
    """

    name: str
    text: str
    place: str

    @property
    def digest(self) -> str:
        """The SHA-256 digest of the rules, in hexadecimal."""
        return hashlib.sha256(self.text.encode()).hexdigest()

    def costs(self, problem: Problem, deadline: Deadline | None = None) -> Sequence[Cost]:
        """Return the cost of each unit of a problem, by id; a unit without a rule costs 0.

        The costs are cached for the network. Raises :class:`LimitError` at the deadline, but only if clingo
        runs in another process.

        Raises :class:`InputError` if rules give a unit two costs, or a cost other than a number from 0.
        Raises :class:`UserError` if they read success rates and the problem has no rates.
        """
        from foon_asp.rules.measure_rules import read_rules  # noqa: PLC0415 (takes clingo along)

        rules = read_rules(self.text, self.place)
        problem_seen = problem.as_seen or problem
        key: list[Hashable] = [self]
        if "rate" in rules.reads:
            if problem_seen.rates is None:
                raise UserError(f"{self.place}: the rules read rate/2: give a rates file, with --rates FILE")
            key += [frozenset(problem_seen.rates.items()), frozenset(problem_seen.own_rates.items())]
        if not rules.reads.isdisjoint(("needs", "gives", "utensil")):
            key += [problem.containers, problem.utensils]
        costs_by_key = _costs_by_network.setdefault(problem.network, {})
        if tuple(key) not in costs_by_key:
            costs_by_key[tuple(key)] = _Evaluation(self, rules, problem, deadline or Deadline()).costs()
        return costs_by_key[tuple(key)]


def wrong_cost(
    measure: Measure, problem: Problem, stated: Mapping[int, Fraction], deadline: Deadline
) -> str | None:
    """Return a message about the first unit whose cost differs from the stated cost; ``None`` if none does.

    ``stated`` has costs by unit id. Each such unit is evaluated, even if another unit has the same facts. If
    the rules do not define the measure, the message says that. Raises the errors of :meth:`Measure.costs`.
    """
    from foon_asp.rules.measure_rules import read_rules  # noqa: PLC0415 (takes clingo along)

    costs = measure.costs(problem, deadline)
    rules = read_rules(measure.text, measure.place)
    if measure.name not in rules.names:
        return f"the rules say nothing of {measure.name}"
    evaluated_costs = _Evaluation(measure, rules, problem, deadline).cost_by_number(stated)
    for unit, cost in stated.items():
        for rule_cost in (costs[unit], evaluated_costs.get(problem.network.unit_number(unit), 0)):
            if rule_cost != cost:
                return f"unit {unit} costs {rule_cost} by the rules of {measure.name}, and not {cost}"
    return None


# By network: costs by measure and all else that they depend on.
_costs_by_network: WeakKeyDictionary[Network, dict[Hashable, Sequence[Cost]]] = WeakKeyDictionary()


class _Evaluation:
    """Evaluation of a measure over the units of a problem."""

    def __init__(self, measure: Measure, rules: "MeasureRules", problem: Problem, deadline: Deadline) -> None:
        """Prepare the evaluation of a measure; ``rules`` are its parsed rules."""
        self._measure, self._rules, self._problem, self._deadline = measure, rules, problem, deadline
        self._unit_number = problem.network.unit_number

    def costs(self) -> Sequence[Cost]:
        """Return the cost of each unit, by id; of units with the same facts, only one is evaluated."""
        units = range(len(self._problem.network))
        fact_keys = self._fact_keys()
        if fact_keys is None:
            cost_by_number = self.cost_by_number(units)
            return [cost_by_number.get(self._unit_number(unit), 0) for unit in units]
        first_unit: dict[Hashable, int] = {}
        for unit, key in enumerate(fact_keys):
            first_unit.setdefault(key, unit)
        cost_by_number = self.cost_by_number(first_unit.values())
        by_key = {key: cost_by_number.get(self._unit_number(unit), 0) for key, unit in first_unit.items()}
        return list(map(by_key.__getitem__, fact_keys))

    def _fact_keys(self) -> Sequence[Hashable] | None:
        """Return a key for each unit, by id.

        Units with equal keys have the same facts, except for numbers of units and nodes. Return ``None`` if
        the rules use these numbers, or read a fact that the keys do not cover.
        """
        if not self._rules.nameless:
            return None
        problem, network = self._problem, self._problem.network
        objects = network.objects
        unit_columns: dict[str, Callable[[], Iterable[Hashable]]] = {
            "unit": lambda: (),
            "utensil": lambda: (),
            "motion": lambda: network.motions,
            "inputs": lambda: map(len, network.inputs),
            "ingredients": lambda: (
                sum(len(objects[o].ingredients) for o in inputs) for inputs in network.inputs
            ),
            "rate": lambda: map((problem.as_seen or problem).rate, range(len(network))),
        }
        reads = self._rules.reads
        object_facts_read = reads.intersection(OBJECT_FACTS)
        objects_of = {
            "input": network.inputs,
            "output": network.outputs,
            "needs": problem.needs,
            "gives": problem.gives,
        }
        if not reads <= unit_columns.keys() | OBJECT_FACTS | objects_of.keys():
            return None
        columns = [tuple(unit_columns[name]()) for name in sorted(reads & unit_columns.keys())]
        if object_facts_read or not reads.isdisjoint(objects_of):
            numbers: dict[Hashable, int] = {}
            fact_rows = (tuple(object_facts(node, object_facts_read)) for node in objects)
            kinds = [numbers.setdefault(facts, len(numbers)) for facts in fact_rows]
            object_lists = [objects_of[name] for name in sorted(reads & objects_of.keys())]
            columns.append(
                tuple(_nodes_key(network, unit, object_lists, kinds) for unit in range(len(network)))
            )
        columns = [column for column in columns if column]
        return list(zip(*columns, strict=True)) if columns else [()] * len(network)

    def cost_by_number(self, units: Iterable[int]) -> dict[int, Cost]:
        """Return the costs that rules derive for units, by unit number; a unit without a rule is left out.

        ``units`` are ids. Raises :class:`InputError` for an invalid cost, and for a unit with two costs.
        """
        by_number = {self._unit_number(unit): unit for unit in units}
        values: dict[int, Cost] = {}
        for world, name, number, value in self._derive_costs(by_number.values(), self._rules.statements):
            if name != (self._measure.name,):
                continue
            assert isinstance(world, int)
            cost = _exact_cost(value) if number == world else None
            if cost is None or cost != values.setdefault(world, cost):
                self._refuse_cost(by_number[world])
        return values

    def _derive_costs(
        self, units: Iterable[int], statements: Iterable["Statement"]
    ) -> Sequence[tuple["Value", ...]]:
        """Return the costs that clingo derives for units, as rows of world, measure, unit number and cost.

        The world is the number of the unit whose facts were used. Clingo runs in this process if the program
        is small, else in another one. Raises :class:`InputError` if clingo drops an instance of a rule.
        """
        from foon_asp.encoding import derived  # noqa: PLC0415
        from foon_asp.encoding.encoding import program_fault  # noqa: PLC0415 (takes clingo along)
        from foon_asp.rules.measure_rules import COST, WORLD  # noqa: PLC0415

        statements = list(statements)
        problem, reads = self._problem, self._rules.reads
        lines = [statement.text for statement in statements]
        lines += write_worlds(problem, units, reads, WORLD)
        if "utensil" in reads:
            lines += [f"utensil({quote(label)})." for label in sorted(problem.utensils)]
        text = "\n".join(lines)
        name, arity = f"_{COST[0]}", COST[1] + 1
        try:
            if self._rules.plain and len(text) < TUNING.quick_letters:
                return derived.derive(text, name, arity)
            from foon_asp.encoding.program_client import derive  # noqa: PLC0415

            return derive(text, name, arity, self._deadline)
        except ProgramError as refused:
            raise self._with_places(program_fault(refused.messages, refused.otherwise), statements) from None

    def _with_places(self, error: UserError, statements: Sequence["Statement"]) -> UserError:
        """Return an error of clingo with places in the rules of the user, not in the text for clingo.

        An error without a place gets the name of the rules in front of its message.
        """
        if not isinstance(error, InputError):
            return UserError(f"{self._measure.place}: {error}")
        return InputError(
            [
                self._error_at(
                    diagnostic.code, diagnostic.message, statements[diagnostic.source.line - 1].source
                )
                for diagnostic in error.diagnostics
            ]
        )

    def _error_at(self, code: str, message: str, source: Source) -> Diagnostic:
        """Return an error about a place in the rules, with the text of its line."""
        from foon_asp.encoding.encoding import located_diagnostic  # noqa: PLC0415 (takes clingo along)

        stated = Stated(self._measure.place, self._measure.text)
        return located_diagnostic(Severity.ERROR, code, message, source, [stated])

    def _refuse_cost(self, unit: int) -> None:
        """Raise :class:`InputError` for a unit with an invalid cost or several costs.

        The error shows the rules that derive these costs. To find them, the unit is evaluated again with each
        rule for costs alone.
        """
        from foon_asp.rules.measure_rules import BEYOND  # noqa: PLC0415 (takes clingo along)

        network, number = self._problem.network, self._unit_number(unit)
        unit_text = f"the unit {network.motions[unit]!r} ({number}, {network.sources[unit][0]})"
        source_by_cost: dict[tuple[Value, Value], Source] = {}
        statements = self._rules.statements
        for rule in (statement for statement in statements if statement.is_cost):
            alone = [statement for statement in statements if statement is rule or not statement.is_cost]
            for _, name, subject, value in self._derive_costs([unit], alone):
                if name == (self._measure.name,):
                    source_by_cost.setdefault((subject, value), rule.source)
        large_costs = {
            cost: source for cost, source in source_by_cost.items() if _value_text(cost[1]) == BEYOND
        }
        errors = []
        for (subject, value), source in (large_costs or source_by_cost).items():
            if large_costs:
                message = (
                    f"found a number of more than 32 bits in the cost of {unit_text}, "
                    "and clingo has none such; "
                    'a large cost is given in a table, as text: "5000000000"'
                )
            elif subject != number:
                message = (
                    f"found a cost of {_value_text(subject)} among the facts of {unit_text}: "
                    "a rule is about one unit"
                )
            elif _exact_cost(value) is None:
                message = (
                    f"found the cost {_value_text(value)} of {unit_text}, "
                    'expected a number from 0: 5, or "2.50"'
                )
            else:
                message = (
                    f"found the cost {_value_text(value)} of {unit_text}, expected one value for each unit"
                )
            errors.append(self._error_at("cost", message, source))
        raise InputError(errors)


def _nodes_key(
    network: Network, unit: int, object_lists: Sequence[Sequence[Sequence[int]]], kinds: Sequence[int]
) -> Hashable:
    """Return a key for the object nodes of a unit; units whose nodes differ only in their ids have one key.

    The key numbers the nodes of the unit from 0 and has the kind of each. For each of ``object_lists``, it
    has the numbers of the nodes that are listed for the unit. ``kinds`` has a number for each node of the
    network; nodes with the same facts have the same number.
    """
    nodes = dict.fromkeys((*network.inputs[unit], *network.outputs[unit]))
    positions = {o: position for position, o in enumerate(nodes)}
    return (
        tuple(kinds[o] for o in nodes),
        *(tuple(positions[o] for o in objects_of[unit]) for objects_of in object_lists),
    )


def _exact_cost(value: "Value") -> Cost | None:
    """Return a derived value as an exact cost: ``5`` for 5, the fraction 5/2 for ``"2.50"``.

    Return ``None`` unless the value is a number of at least 0.
    """
    if isinstance(value, int):
        return value if value >= 0 else None
    if not isinstance(value, str) or not _DECIMAL.fullmatch(value):
        return None
    cost = Fraction(value)
    return int(cost) if cost.denominator == 1 else cost


def _value_text(value: "Value") -> str:
    """Return a derived value as it would be written in a rule."""
    if isinstance(value, str):
        return quote(value)
    return str(value) if isinstance(value, int) else value.text


def read_measures(rules: str | PathLike[str] | Iterable[str | PathLike[str]]) -> dict[str, Measure]:
    """Read measures from one or several files or texts of rules; return them by name.

    An existing path is a file. Any other text is rules if it has ``:-`` or ends in a full stop. Otherwise it
    is a path. Repeated texts and files are read once. Raises :class:`UserError` for an empty text, for faults
    in rules, and for a measure that two texts define.
    """
    rules = [rules] if isinstance(rules, str | PathLike) else list(rules)
    if not rules:
        return {}
    if any(isinstance(source_text, str) and not source_text.strip() for source_text in rules):
        raise UserError(
            "found an empty text for a measure, expected a file, or rules such as "
            "cost(mine,U,N) :- inputs(U,N)."
        )
    from foon_asp.rules.measure_rules import read_rules  # noqa: PLC0415 (takes clingo along)

    measures: dict[str, Measure] = {}
    texts = [
        (source_text, f"measure {number}")
        if isinstance(source_text, str) and _is_rule_text(source_text)
        else (read_plain_text(Path(source_text)), str(source_text))
        for number, source_text in enumerate(rules, 1)
    ]
    for text, origin in dict.fromkeys(texts):
        for name, source in read_rules(text, origin).names.items():
            if name in measures:
                message = f"found the measure {name!r} again, of which {measures[name].place} has rules"
                raise InputError([Diagnostic(Severity.ERROR, "measure-name", message, source)])
            measures[name] = Measure(name, text, origin)
    return measures


def _is_rule_text(text: str) -> bool:
    """Whether a text is rules, and not the path of a file."""
    return (":-" in text or text.rstrip().endswith(".")) and not exists(Path(text))
