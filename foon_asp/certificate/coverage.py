"""Which of a user's constraints a certificate can speak about."""

import hashlib
from pathlib import Path
from typing import NamedTuple

from foon_asp.asp import Settings
from foon_asp.asp.constraint import RuleText, find_constraint
from foon_asp.asp.own_encodings import is_own
from foon_asp.network import Network

# Our constraints that rule out units one by one, and the constant that says which.
_FORBIDDING = {"forbid_motion.lp": "forbidden_motion", "forbid_object.lp": "forbidden_object"}


class Coverage(NamedTuple):
    """What is forbidden and certified, and what else narrows the trees and is not.

    ``motions`` and ``labels`` (of objects) rule out every unit that has one of them. ``not_covered`` names
    rules, by their text or by file, with a digest, and the constants that were set.
    """

    motions: tuple[str, ...] = ()
    labels: tuple[str, ...] = ()
    not_covered: tuple[str, ...] = ()

    def forbids(self, network: Network) -> frozenset[int]:
        """Give the units of a network that are ruled out."""
        nodes = {o for o, node in enumerate(network.objects) if node.label in self.labels}
        return frozenset(
            unit
            for unit, motion in enumerate(network.motions)
            if motion in self.motions or not nodes.isdisjoint((*network.inputs[unit], *network.outputs[unit]))
        )


NOTHING = Coverage()  # no constraints at all


def coverage(settings: Settings) -> Coverage:
    """Sort the constraints of a question into those that a certificate covers and the others.

    ``forbid_motion`` and ``forbid_object`` of ours are covered. Other rules only narrow the trees, so a bound
    without them still holds; a replaced encoding may say anything, and is named, too.
    """
    constants = dict(setting.partition("=")[::2] for setting in settings.constants)
    forbidden: dict[str, set[str]] = {constant: set() for constant in _FORBIDDING.values()}
    others: list[str] = []
    plain: set[str] = set()
    for each in dict.fromkeys(map(find_constraint, settings.constraints)):
        if isinstance(each, RuleText):
            others.append(f"{each.name} {_digest(each.text.encode('utf-8', 'surrogatepass'))} {each.text}")
            continue
        file, given = (each, constants) if isinstance(each, Path) else (each.file, each.constants)
        constant = _FORBIDDING.get(file.name)
        if constant is not None and is_own(file):
            if constant in given:
                from foon_asp.asp.encoding import string_constant  # noqa: PLC0415 - it loads clingo

                forbidden[constant] |= {string_constant(given[constant])} - {""}
                plain |= {constant} if given is constants else set()
        else:
            others.append(f"{each.name} {_digest(file.read_bytes())}")
    if settings.replaced is not None:
        others.append(f"encodings {settings.replaced.name}")
    others += [f"{name}={value}" for name, value in constants.items() if name not in plain]
    motions, labels = (tuple(sorted(forbidden[constant])) for constant in _FORBIDDING.values())
    return Coverage(motions, labels, tuple(sorted(set(map(_printable, others)))))


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _printable(name: str) -> str:
    """Escape the letters of a file's name or of a constant that cannot be printed: a line end, for one."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in name)
