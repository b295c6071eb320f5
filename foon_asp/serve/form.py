"""The forms by which the page asks. For security, none of their fields is the path of a file."""

from typing import Any, TypeVar

import msgspec

from foon_asp.errors import UserError
from foon_asp.json_layout import read_json
from foon_asp.problem import DEFAULT_RULE, ContainerRule
from foon_asp.questions.view import PagePart

Names = tuple[str, ...]
Question = TypeVar("Question", bound=msgspec.Struct)


class Form(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A question for the best tree.

    ``goals``, ``objectives``: their names; the first objective counts most.
    ``containers``: the container rule.
    ``items``: ``lasting`` or ``used-up``.
    ``adding``, ``without``: names of kitchen items to add and to remove.
    ``rules``: the text of rules.
    ``beside``: further answers that the page shows.
    """

    goals: Names = ()
    objectives: Names = ("units",)
    containers: ContainerRule = DEFAULT_RULE
    items: str = "lasting"
    adding: Names = ()
    without: Names = ()
    rules: str = ""
    beside: tuple[PagePart, ...] = ()


class RegretForm(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A question for the optimum without one unit or one kitchen item of the tree on ``page``.

    ``unit`` is an id in the whole network, ``item`` a node in one-line notation; one of the two is given.
    """

    page: int
    unit: int | None = None
    item: str | None = None

    def __post_init__(self) -> None:
        """Raise :class:`ValueError` unless exactly one of unit and item is given."""
        if (self.unit is None) == (self.item is None):
            raise ValueError("expected a unit or an item")


def read_question(text: bytes, form_type: type[Question]) -> Question:
    """Return the form that JSON text states, of type ``form_type``.

    Raises :class:`UserError` for text that is no such form, or that has an object with a repeated key.
    """
    try:
        return msgspec.convert(read_json(text, _object_without_repeats), form_type)
    except ValueError as error:
        raise UserError(f"found what is no question: {error}") from None


def _object_without_repeats(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Return an object of JSON from its pairs; raises :class:`ValueError` if it has a key twice."""
    value = dict(pairs)
    if len(value) < len(pairs):
        raise ValueError("a key stands twice in one object")
    return value
