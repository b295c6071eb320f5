"""What somebody asks on the page: plain words, read from JSON, in which nothing names a file."""

from typing import Any, NamedTuple, get_args, get_type_hints

from foon_asp.errors import UserError
from foon_asp.problem import ITEMS, ContainerRule
from foon_asp.questions.view import Beside
from foon_asp.text.json_value import read_json

Names = tuple[str, ...]


class Form(NamedTuple):
    """One question: ``adding`` and ``without`` change the kitchen, ``rules`` is the text of the box."""

    goals: Names = ()
    objectives: Names = ("units",)
    containers: str = "strict"
    items: str = "lasting"
    adding: Names = ()
    without: Names = ()
    rules: str = ""
    beside: Names = ()


_CHOICES = {"containers": tuple(ContainerRule), "items": ITEMS, "beside": tuple(Beside)}


def read_form(text: bytes) -> Form:
    """Read a question; raises :class:`UserError` for whatever is none."""
    return Form(**_read(text, get_type_hints(Form)))


class Without(NamedTuple):
    """What is the optimum of the answer ``page`` without one ``unit``, or one kitchen ``item``?"""

    page: int
    unit: int | None = None
    item: str | None = None


def read_without(text: bytes) -> Without:
    """Read such a question; raises :class:`UserError` for whatever is none."""
    found = _read(text, get_type_hints(Without))
    if "page" not in found or ("unit" in found) == ("item" in found):
        raise UserError("expected a page, and a unit or an item")
    return Without(**found)


def _read(text: bytes, kinds: dict[str, object]) -> dict[str, Any]:
    """Read an object whose keys are of these kinds."""
    try:
        given = read_json(text)
    except ValueError as error:
        raise UserError(f"found a question that is no JSON: {error}") from None
    if not isinstance(given, dict):
        raise UserError("found a question that is no JSON object")
    if unknown := sorted(given.keys() - kinds.keys()):
        raise UserError(f"found {unknown[0]!r}, expected one of {', '.join(kinds)}")
    found: dict[str, Any] = {}
    for name, value in given.items():
        kind = kinds[name]
        many = kind == Names
        allowed = (str,) if many else get_args(kind) or (kind,)
        values = value if many and isinstance(value, list) else [value]
        if isinstance(value, list) != many or not all(type(each) in allowed for each in values):
            raise UserError(f"found another kind of value for {name!r}")
        for each in values:
            if name in _CHOICES and each not in _CHOICES[name]:
                raise UserError(f"found {name} {each!r}, expected one of {', '.join(_CHOICES[name])}")
        found[name] = tuple(values) if many else value
    return found
