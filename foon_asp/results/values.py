"""The values that results are made of: object nodes, units, steps and places, without ids to look up."""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

from msgspec import UNSET, Struct, UnsetType, field

from foon_asp.network import FunctionalUnit, Source
from foon_asp.problem import Costs, Objective

if TYPE_CHECKING:
    Figure = int | Fraction
    """What an objective measures: a whole number, or an exact fraction."""
else:
    from numbers import Rational as Figure


class Value(Struct, frozen=True):
    """A value without an identity of its own: two are equal if all their fields are."""


class Place(Value, frozen=True):
    """Where a copy of a unit was read.

    Attributes:
        line: The number of the line, from 1; 0 if it was not read from a line.
        videos: The addresses of the annotated videos.
    """

    file: str
    line: int
    videos: tuple[str, ...]

    def __str__(self) -> str:
        return Source(self.file, self.line).short


class Relation(Value, frozen=True):
    """The relation of an object to another one: ``in`` a ``bowl``."""

    word: str
    object: str


class Contents(Value, frozen=True):
    """The ingredients in an object, and the word before them: ``contains``."""

    word: str
    ingredients: tuple[str, ...]


class Node(Value, frozen=True):
    """An object node.

    Attributes:
        id: The id in the whole network, as in the facts; null where the network does not have it.
        node: The one-line notation, which ``--goal`` understands.
        stands_for: Below level 3: the level-3 nodes that a goal stands for.
        wanted: How many copies of a goal are wanted, where that is not one.
    """

    id: int | None
    node: str
    label: str
    states: tuple[str, ...]
    relations: tuple[Relation, ...]
    contents: tuple[Contents, ...]
    stands_for: "tuple[Node, ...] | UnsetType" = UNSET
    wanted: int | UnsetType = UNSET

    def __str__(self) -> str:
        return self.node


class Origin(Value, frozen=True):
    """The origin of an input; exactly one field is set.

    The last two occur only in a tree that does not execute.

    Attributes:
        kitchen: It is in the kitchen.
        bought: It is in the kitchen once the shopping list is bought.
        step: The first step that makes it, from 1.
        implied: It is taken as given by the container rule ``implied``.
        later_step: The first step that makes it, which is too late.
        missing: It is neither in the kitchen nor made.
    """

    kitchen: bool | UnsetType = UNSET
    bought: bool | UnsetType = UNSET
    step: int | UnsetType = UNSET
    implied: bool | UnsetType = UNSET
    later_step: int | UnsetType = UNSET
    missing: bool | UnsetType = UNSET

    def __str__(self) -> str:
        if self.step is not UNSET:
            return f"step {self.step}"
        if self.later_step is not UNSET:
            return f"step {self.later_step}, which is later"
        return next(name for name in self.__struct_fields__ if getattr(self, name) is not UNSET)


class Copy(Node, frozen=True, kw_only=True):
    """One copy of an object node, and its origin."""

    origin: Origin = field(name="from")


class Copies(Value, frozen=True):
    """How many copies of an object node there are."""

    object: Node
    copies: int


class Input(Copy, frozen=True, kw_only=True):
    """An input of a step.

    Attributes:
        stays: Where items are used up: whether it is still there after the step.
        amount: Where items are used up, and amounts are known: how many copies one execution takes.
    """

    stays: bool | UnsetType = UNSET
    amount: int | UnsetType = UNSET


class Output(Node, frozen=True, kw_only=True):
    """An output of a step.

    Attributes:
        made: Whether the unit makes it; false for an output that it takes as given.
        amount: Where items are used up, and amounts are known: how many copies one execution makes.
    """

    made: bool
    amount: int | UnsetType = UNSET


class Mention(Value, frozen=True):
    """The id, the motion and the places of a unit.

    Attributes:
        id: The id in the whole network, the number in ``use(U)``; null where the network does not have it.
        source: The place of each copy of the unit.
    """

    id: int | None
    motion: str
    source: tuple[Place, ...]

    def __str__(self) -> str:
        return f"{self.motion}    [{self.source[0]}]"


class NumberedStep(Value, frozen=True):
    """The number of a step, and the id, the motion and the places of its unit.

    Attributes:
        step: The number of the step, from 1.
        id: The id in the whole network, the number in ``use(U)``; null where the network does not have it.
    """

    step: int
    id: int | None
    motion: str
    source: tuple[Place, ...]


class Unit(Value, frozen=True):
    """A functional unit.

    Attributes:
        id: The id in the whole network, the number in ``use(U)``; null where the network does not have it.
        source: The place of each copy of the unit.
        stands_for: Below level 3: the level-3 units that it stands for.
    """

    id: int | None
    motion: str
    inputs: tuple[Node, ...]
    outputs: tuple[Node, ...]
    source: tuple[Place, ...]
    stands_for: "tuple[Unit, ...] | UnsetType" = UNSET

    def __str__(self) -> str:
        return f"{self.motion}: {' + '.join(map(str, self.inputs))} → {' + '.join(map(str, self.outputs))}"

    def lines(self) -> Iterator[str]:
        """Yield three lines of text: motion and place, inputs, outputs."""
        yield f"  {self.motion}    [{self.source[0]}]"
        yield f"    {' + '.join(map(str, self.inputs))}"
        yield f"  → {' + '.join(map(str, self.outputs))}"


class UnitDifference(Value, frozen=True):
    """One difference between two units, named once however often it occurs.

    Attributes:
        kind: motion, label, state, relation or ingredient; input or output for a whole object node.
        a: The word of the first unit; null if only the second has one.
        b: The word of the second unit; null if only the first has one.
        of: The label of the object that it belongs to; null for a motion or a whole node.
    """

    kind: str
    a: str | None
    b: str | None
    of: str | None

    def __str__(self) -> str:
        before = f"{self.of}: {self.kind}" if self.of else self.kind
        if self.a and self.b:
            return f"{before} {self.a!r} in A, {self.b!r} in B"
        return f"{before} {self.a or self.b!r} only in {'A' if self.a else 'B'}"


class Step(Value, frozen=True):
    """A functional unit as a step of a tree or plan.

    Attributes:
        step: The number of the step, from 1.
        id: The id in the whole network, the number in ``use(U)``.
        source: The place of each copy of the unit.
        stands_for: Below level 3: the level-3 units that it stands for.
        by: ``robot`` or ``person``, where a person helps.
        times: Where amounts are counted: how often it is executed, one time after the other.
    """

    step: int
    id: int | None
    motion: str
    inputs: tuple[Input, ...]
    outputs: tuple[Output, ...]
    source: tuple[Place, ...]
    stands_for: tuple[Unit, ...] | UnsetType = UNSET
    by: str | UnsetType = UNSET
    times: int | UnsetType = UNSET

    def lines(self, details: int = 5) -> Iterator[str]:
        """Yield lines of text: motion and place, inputs with their origins, and outputs.

        Below level 3, lines follow for up to ``details`` of the level-3 units that the step stands for.
        """
        who = "    by the person" if self.by == "person" else ""
        times = "" if self.times is UNSET or self.times == 1 else f"{self.times} times "
        yield f"{self.step:>3}  {times}{self.motion}    [{self.source[0]}]{who}"
        for step_input in self.inputs:
            used = ", used up" if step_input.stays is False else ""
            yield f"       {amount_text(step_input.amount)}{step_input}  ({step_input.origin}{used})"
        for made in self.outputs:
            implied = "" if made.made else "  (implied, not made here)"
            yield f"     → {amount_text(made.amount)}{made}{implied}"
        if self.stands_for is not UNSET:
            number = len(self.stands_for)
            yield f"     stands for {number} unit{'s' if number != 1 else ''} at level 3:"
            for unit in self.stands_for[:details]:
                yield f"       {unit.id}    [{unit.source[0]}]  {unit}"
            if number > details:
                yield f"       ... and {number - details} more; --format json lists all"


def amount_text(amount: int | UnsetType) -> str:
    """Return an amount as a prefix of a node: ``2 x ``; empty for 1 and without an amount."""
    return "" if amount is UNSET or amount == 1 else f"{amount} x "


class Lack(Value, frozen=True):
    """A missing copy of an object node.

    Attributes:
        position: The number of the step that lacks it, from 1; null if a goal lacks it in the end.
        used_up_by: The numbers of the steps that used up the copies, from 1.
        amount: How many copies are needed, if that is not one.
        unit: The unit of the step, if the plan was replayed; null for a goal.
    """

    position: int | None
    missing: Node
    used_up_by: tuple[int, ...]
    unit: Unit | UnsetType | None = UNSET
    amount: int | UnsetType = UNSET


class ListedConstraint(Value, frozen=True):
    """A user rule without a head (``:- ...``).

    Attributes:
        number: The number of the rule among all such rules, from 1.
        constants: The constants in it that were set, as NAME=VALUE.
    """

    number: int
    file: str
    line: int
    text: str
    constants: tuple[str, ...]

    def lines(self, remark: str = "") -> Iterator[str]:
        """Yield a line with the place of the rule, a remark and the constants, and a line with its text."""
        settings = "".join(f"    -c {setting}" for setting in self.constants)
        yield f"  {Source(self.file, self.line)}{remark}{settings}"
        yield f"      {self.text}"


class UsedUpRun(Value, frozen=True):
    """Whether the steps of a tree, each done once, run where items are used up.

    The steps of an answer are done in the order listed. For another tree, it is enough that some order runs.

    Attributes:
        runs: Whether they run; null if that was not decided, and below level 3.
        shortage: The missing copy, if the steps do not run; else null.
    """

    runs: bool | None
    shortage: Lack | None


class CostedTree(Value, frozen=True):
    """A tree and its costs.

    Attributes:
        costs: What the tree costs by every objective.
        used_up: Whether the steps, each done once, run where items are used up.
        units: The steps, in an order that executes.
    """

    costs: Costs
    used_up: UsedUpRun | None
    units: tuple[Step, ...]

    @property
    def ids(self) -> tuple[int, ...]:
        """The units by id in the whole network, in an order that executes."""
        return tuple(step.id for step in self.units if step.id is not None)


def steps_not_in(steps: Sequence[Step], others: Iterable[Step]) -> list[Step]:
    """Return the steps whose unit ids are not in ``others``; repeats count (a multiset difference)."""
    missing = Counter(step.id for step in steps) - Counter(step.id for step in others)
    difference = []
    for step in steps:
        if missing[step.id]:
            missing[step.id] -= 1
            difference.append(step)
    return difference


def step_lines(steps: Iterable[Step | Unit], sign: str = " ") -> Iterator[str]:
    """Yield a line for each step: the sign, the id of its unit, the motion and the place.

    ``sign`` is ``+`` or ``-`` for a step that comes or goes.
    """
    for step in steps:
        yield f"  {sign} {step.id}  {step.motion}    [{step.source[0]}]"


def changed_motions(
    gone: Iterable[Step | FunctionalUnit], new: Iterable[Step | FunctionalUnit], named: int = 6
) -> str:
    """Return the motions of removed and added steps: ``- heat  + pour (2)``; empty without any.

    Of more than ``named`` motions, the last are replaced by a number of steps: ``- heat, pour and 3 more``.
    """
    texts = []
    for sign, steps in (("-", gone), ("+", new)):
        counts = Counter(step.motion for step in steps)
        motions = [motion if count == 1 else f"{motion} ({count})" for motion, count in counts.items()]
        if len(motions) > named:
            more_count = sum([*counts.values()][named - 1 :])
            motions = [f"{', '.join(motions[: named - 1])} and {more_count} more"]
        if motions:
            texts.append(f"{sign} {', '.join(motions)}")
    return "  ".join(texts)


Measures = Mapping[Objective, Figure | None]
"""The measures of a tree by objective; ``None`` if unknown."""
