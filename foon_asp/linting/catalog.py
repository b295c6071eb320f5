"""All lint rules by their codes."""

from difflib import get_close_matches

from foon_asp.linting import (  # noqa: F401 (each defines rules)
    bracket_rules,
    chain_rules,
    change_rules,
    cycle_rules,
    goal_rules,
    id_rules,
    letter_rules,
    name_rules,
    noqa,
    place_rules,
    reader_rules,
    table_rules,
    time_rules,
    unit_rules,
)
from foon_asp.linting.rule import RULES

CATALOG = dict(sorted(RULES.items()))
"""Every rule by code, in alphabetical order."""


def unknown_code_message(code: str) -> str:
    """Return the error message about a code that no rule has; it names the most similar code, if any."""
    similar_codes = get_close_matches(code, CATALOG, n=1)
    hint = f"; did you mean {similar_codes[0]!r}?" if similar_codes else ""
    return f"there is no code {code!r}; docs/lint.md lists them{hint}"
