"""What somebody asks on the page: plain words, read from JSON, in which nothing names a file."""

from typing import Any, TypeVar

import msgspec

from foon_asp.errors import UserError
from foon_asp.problem import ContainerRule
from foon_asp.questions.view import PagePart
from foon_asp.text.json_value import read_json

Names = tuple[str, ...]
Asked = TypeVar("Asked", bound=msgspec.Struct)


class Form(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One question: ``adding`` and ``without`` change the kitchen, ``rules`` is the text of the box."""

    goals: Names = ()
    objectives: Names = ("units",)
    containers: ContainerRule = ContainerRule.STRICT
    items: str = "lasting"
    adding: Names = ()
    without: Names = ()
    rules: str = ""
    beside: tuple[PagePart, ...] = ()


class Without(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The optimum of the answer ``page`` without one ``unit``, or without one kitchen ``item``."""

    page: int
    unit: int | None = None
    item: str | None = None

    def __post_init__(self) -> None:
        """Raise :class:`ValueError` for a unit and an item, or for neither."""
        if (self.unit is None) == (self.item is None):
            raise ValueError("expected a unit or an item")


def read_question(text: bytes, kind: type[Asked]) -> Asked:
    """Read a question of a kind from JSON; raises :class:`UserError` for whatever is none."""
    try:
        return msgspec.convert(read_json(text, _object), kind)
    except ValueError as error:
        raise UserError(f"found what is no question: {error}") from None


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Make an object; raises :class:`ValueError` where a key stands twice in it."""
    value = dict(pairs)
    if len(value) < len(pairs):
        raise ValueError("a key stands twice in one object")
    return value
