"""Docstrings of questions, completed by the help of their options."""

import inspect
import re
import textwrap
from collections.abc import Callable, Mapping

_PROBLEM = "The problem to ask about, made by :meth:`foon_asp.Foon.problem`."
_WIDTH = 100
_ENTRY = re.compile(r"^    (\w+): (.*(?:\n        .*)*)", re.MULTILINE)


def complete_docstring(ask: Callable[..., object], texts: Mapping[str, str]) -> str | None:
    """Give the docstring of a function with a description of each parameter, in their order.

    ``texts`` has descriptions by name. The docstring as written has the sections ``Parameters``, ``Returns``,
    ``Raises`` and ``Example``. What its first section says of a parameter is taken instead of the text; if
    that section is missing, it is put before ``Returns``.
    """
    if ask.__doc__ is None:  # python -OO
        return None
    written = inspect.cleandoc(ask.__doc__)
    before, heading, after = written.partition("Parameters:\n")
    if heading:
        own, _, after = after.partition("\n\n")
    else:
        before, heading, after = written.partition("Returns:\n")
        own, after = "", heading + after
    known = {"problem": _PROBLEM, **texts}
    known |= {name: " ".join(text.split()) for name, text in _ENTRY.findall(own)}
    entries = (_entry(name, known[name]) for name in inspect.signature(ask).parameters if name in known)
    return f"{before}Parameters:\n{''.join(entries)}\n{after}\n"


def _entry(name: str, text: str) -> str:
    lines = textwrap.wrap(f"{name}: {text}", _WIDTH, break_on_hyphens=False, subsequent_indent=" " * 4)
    return textwrap.indent("\n".join(lines), " " * 4) + "\n"
