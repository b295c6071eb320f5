"""Warnings about parameters of ready-made constraints that name nothing in the network."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Final

from foon_asp.encoding.encoding_file import string_constant
from foon_asp.encoding.own_encodings import is_own
from foon_asp.proof.rule_meaning import LIBRARY
from foon_asp.rules.fact_values import (
    CONTENTS,
    MOTIONS,
    FactValues,
    has_text,
    nearest_text,
    unknown_text_message,
)
from foon_asp.rules.passed_constraint import Constraint, LibraryUse, find_constraint
from foon_asp.rules.ready_made import LISTED

_LABELS: Final = ("label",)

# By text parameter: the predicates of facts among whose texts it has to be.
PARAMETERS: Final[Mapping[str, tuple[str, ...]]] = {
    **dict.fromkeys(("forbidden_motion", "limited_motion", "required_motion", "tied_motion"), MOTIONS),
    **dict.fromkeys(("earlier_motion", "later_motion", "one_motion", "other_motion"), MOTIONS),
    **dict.fromkeys(
        ("forbidden_object", "limited_utensil", "required_intermediate", "required_object", "tied_utensil"),
        _LABELS,
    ),
    **dict.fromkeys(("forbidden_ingredient", "required_ingredient", "unheated_ingredient"), CONTENTS),
    "allowed_source": ("source",),
}


def unknown_parameters(
    constraints: Sequence[Constraint], settings: Sequence[str], values: FactValues
) -> Iterator[str]:
    """Yield a warning for each parameter whose value names nothing in the network.

    The warning suggests a similar name, if there is one. Only text parameters of unchanged ready-made
    constraints are checked, and only if they have a value. ``settings``, as ``NAME=VALUE``, are the
    parameters of constraints that are passed without constants of their own.
    """
    shared = dict(setting.partition("=")[::2] for setting in settings)
    for constraint in dict.fromkeys(map(find_constraint, constraints)):
        file = constraint.file if isinstance(constraint, LibraryUse) else constraint
        if not isinstance(file, Path) or file.stem not in LIBRARY or not is_own(file):
            continue
        values_of = constraint.constants if isinstance(constraint, LibraryUse) else shared
        for value in LIBRARY[file.stem].values:
            parameter = LISTED.get(value, value)
            word = string_constant(values_of.get(parameter, "")) if parameter in PARAMETERS else ""
            if word and not has_text(PARAMETERS[parameter], word, values):
                use = constraint if isinstance(constraint, LibraryUse) else f"{file.stem}:{parameter}={word}"
                meant = nearest_text(PARAMETERS[parameter], word, values)
                yield f"{use}: warning: {unknown_text_message(PARAMETERS[parameter], word, meant)}"
