"""Docstrings of questions, completed by the help of their options."""

import inspect
import re
import textwrap
from collections.abc import Callable, Mapping

_PROBLEM = (
    "The problem to ask about, made by :meth:`foon_asp.Foon.problem`; or the path of a recipe or a folder, "
    "or data that were loaded."
)
_ENTRY = re.compile(r"^    (\w+): (.*(?:\n        .*)*)", re.MULTILINE)


def docstring_entries(ask: Callable[..., object]) -> dict[str, str]:
    """Return the descriptions in the ``Parameters`` section of a function's docstring, each in one line.

    The keys are the names of the parameters. Without a docstring, the mapping is empty.
    """
    if ask.__doc__ is None:  # python -OO
        return {}
    section = inspect.cleandoc(ask.__doc__).partition("Parameters:\n")[2].partition("\n\n")[0]
    return {name: " ".join(text.split()) for name, text in _ENTRY.findall(section)}


def complete_docstring(
    ask: Callable[..., object], signature: inspect.Signature, texts: Mapping[str, str]
) -> str | None:
    """Return the docstring of a function with descriptions of its parameters, in the order of the signature.

    ``texts`` has descriptions by name. A description that the docstring has already takes precedence. A
    parameter without a description is left out. If there is no section ``Parameters``, one is inserted before
    ``Returns``, or else at the end. Return ``None`` for a function without docstring.
    """
    if ask.__doc__ is None:  # python -OO
        return None
    text_of = {"problem": _PROBLEM, **texts, **docstring_entries(ask)}
    docstring = inspect.cleandoc(ask.__doc__)
    text_before, heading, text_after = docstring.partition("Parameters:\n")
    if heading:
        text_after = text_after.partition("\n\n")[2]
    else:
        text_before, heading, text_after = docstring.partition("Returns:\n")
        text_after = heading + text_after
    entries = (_entry(name, text_of[name]) for name in signature.parameters if name in text_of)
    return f"{text_before}Parameters:\n{''.join(entries)}\n{text_after}\n"


def _entry(name: str, text: str) -> str:
    """Return the indented and wrapped lines of a parameter in a docstring."""
    lines = textwrap.wrap(f"{name}: {text}", width=100, break_on_hyphens=False, subsequent_indent=" " * 4)
    return textwrap.indent("\n".join(lines), " " * 4) + "\n"
