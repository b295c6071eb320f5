"""Documents: values with a JSON form and schema, rows for tables, and lines for people."""

from collections.abc import Iterator
from typing import Any, ClassVar, Generic, Literal, Self, TypeVar

from msgspec import UNSET, Struct

from foon_asp.json_layout import Json, json_text, read_json
from foon_asp.network import counted
from foon_asp.problem import ContainerRule, Objective, conditions
from foon_asp.results.plain_values import plain
from foon_asp.results.table import Block, blocks_text
from foon_asp.results.table_columns import csv_text, data_frame, flat_row, markdown_text
from foon_asp.results.values import Node

T = TypeVar("T")


class Unserialized(Generic[T]):
    """A descriptor of a property that a document has, but its JSON does not have.

    :meth:`Document.set_unserialized` sets the property. Before that, it has the ``default``; without a
    default, it raises :class:`AttributeError`.
    """

    def __init__(self, *default: T) -> None:
        self._default = default

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    def __get__(self, document: object, owner: type | None = None) -> T:
        if not self._default:
            raise AttributeError(f"{self._name} is not known")
        return self._default[0]


class Document(Struct, frozen=True, kw_only=True, dict=True, tag_field="schema"):
    """A value whose fields are its JSON, in their order.

    The class attribute ``ROWS`` is the name of the field whose items are the rows of tables. If it is empty,
    or the field is ``None``, the document itself is the only row.
    """

    ROWS: ClassVar[str] = ""

    def set_unserialized(self, **attributes: object) -> Self:
        """Set properties (:class:`Unserialized`) of this document in place, and return the document."""
        self.__dict__.update(attributes)
        return self

    def show(self) -> Iterator[Block]:
        """Return lines and tables of text for people; each class of documents has its own method."""
        raise NotImplementedError

    def text(self) -> str:
        """Return the document in words, as the command line prints it."""
        return blocks_text(self.show())

    def json_dict(self) -> Json:
        """Return the document as plain values, in the order in which JSON has them."""
        values: Json = plain(self)
        return values

    def json_text(self) -> str:
        """Return the document as JSON, as the command line prints it with ``--format json``."""
        return json_text(self.json_dict())

    def json(self) -> Any:
        """Return the JSON of the document as lists, dictionaries, strings and numbers (docs/json.md)."""
        return read_json(self.json_text())

    def table_rows(self) -> Iterator[Json]:
        """Yield a row for each item of the field ``ROWS``, or one row for a document without it.

        A nested field has a name with a dot (``costs.units``). A fraction is in two columns: as a decimal,
        and exact (``costs.success_exact``).
        """
        rows = getattr(self, self.ROWS) if self.ROWS else None
        yield from map(flat_row, [self.json_dict()] if rows is None else map(plain, rows))

    def to_frame(self) -> Any:
        """Return a data frame of pandas with the rows and columns of :meth:`csv`.

        Raises:
            UserError: if pandas is not installed.
        """
        return data_frame(self.table_rows())

    def csv(self) -> str:
        """Return the rows as CSV, with a line of headings, for a spreadsheet."""
        return csv_text(self.table_rows())

    def markdown(self) -> str:
        """Return the rows as a Markdown table; empty columns and columns of exact numbers are left out."""
        return markdown_text(self.table_rows())


class AboutGoals(Document, frozen=True, kw_only=True):
    """A document about goals; its first fields are the question.

    Attributes:
        goals: What is to be made.
        containers: Whether a unit needs every input (strict), or takes as given a utensil whose only
            ingredient is an input too (implied).
        items: Whether available and made items can be used again (lasting), or are used up (used-up).
        level: What counts of an object node: 3 all, 2 no contents, 1 the label alone.
        objectives: The objectives, the first counting most; units decides last in any case.
        starting_kitchen: Where no kitchen was given, the items that are assumed to be available and can be
            needed for the goals; null where a kitchen was given.
    """

    goals: tuple[Node, ...]
    containers: ContainerRule
    items: Literal["lasting", "used-up"]
    level: int
    objectives: tuple[Objective, ...]
    starting_kitchen: tuple[Node, ...] | None

    @property
    def conditions(self) -> str:
        """The assumptions of every claim in a few words: ``strict containers, items used up``."""
        text = conditions(self.containers, self.level, self.starting_kitchen is not None)
        return text if self.items == "lasting" else f"{text}, items used up"

    def goal_lines(self, shown: int = 5) -> Iterator[str]:
        """Yield a line for each goal, with the number of copies wanted unless it is one.

        Below level 3, each line is followed by up to ``shown`` level-3 nodes that the goal stands for.
        """
        for goal in self.goals:
            yield f"goal: {goal}" if goal.wanted is UNSET else f"goal: {goal.wanted} x {goal}"
            if isinstance(goal.stands_for, tuple):
                yield f"  stands for {counted(len(goal.stands_for), 'object node')} at level 3:"
                yield from (f"    {node}" for node in goal.stands_for[:shown])
                if len(goal.stands_for) > shown:
                    yield f"    ... and {len(goal.stands_for) - shown} more; --format json lists all"
