"""Functional units that are nearly the same, and in what they differ."""

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from foon_asp.network.functional_unit import FunctionalUnit
from foon_asp.network.object_node import ObjectNode
from foon_asp.network.spelling import one_letter_apart, without_doubles

_MOST = 3  # differences of units that are nearly the same
_COMMON = 300  # units: what more have in common says little of them
_LOOKED_AT = 12  # units that have most in common with one

_Part = tuple[str, str]


class UnitDifference(NamedTuple):
    """One thing in which two units differ, however often it stands in them.

    ``kind`` is motion, label, state, relation, ingredient, input or output; the last two are whole object
    nodes, in one-line notation. Where only one unit has it, the other text is empty. ``of`` is the label of
    the object that it is said of first, empty for what is no part of an object.
    """

    kind: str
    left: str
    right: str
    of: str = ""

    @property
    def is_slip(self) -> bool:
        """Whether both are a name, and spelt almost alike."""
        one, other = self.left, self.right
        return bool(one and other) and (
            one_letter_apart(one, other) or without_doubles(one) == without_doubles(other)
        )


class NearUnits(NamedTuple):
    """Two units that are nearly the same."""

    left: FunctionalUnit
    right: FunctionalUnit
    differences: tuple[UnitDifference, ...]


def unit_differences(left: FunctionalUnit, right: FunctionalUnit) -> tuple[UnitDifference, ...]:
    """Return in what two units differ, as few things as possible: each pair of names counts once."""
    found: list[UnitDifference] = []
    if left.motion != right.motion:
        found.append(UnitDifference("motion", left.motion, right.motion))
    sides = ("input", left.inputs, right.inputs), ("output", left.outputs, right.outputs)
    for side, here, there in sides:
        rest, others = [n for n in here if n not in there], [n for n in there if n not in here]
        pairs = sorted(
            (len(differences := _between(one, other)), one.label != other.label, i, j, differences)
            for i, one in enumerate(rest)
            for j, other in enumerate(others)
        )
        taken: set[int] = set()
        taken_there: set[int] = set()
        for _, _, i, j, differences in pairs:
            if i not in taken and j not in taken_there and _is_same_thing(rest[i], others[j], differences):
                taken.add(i)
                taken_there.add(j)
                found += differences
        found += [UnitDifference(side, str(node), "") for i, node in enumerate(rest) if i not in taken]
        found += [
            UnitDifference(side, "", str(node)) for j, node in enumerate(others) if j not in taken_there
        ]
    labels = {(d.left, d.right) for d in found if d.kind == "label"}
    once: dict[tuple[str, str, str], UnitDifference] = {}
    for each in found:
        # a label that is another one is so as a container and as an ingredient, too
        if (
            each.kind not in {"ingredient", "relation"}
            or (_object(each.left), _object(each.right)) not in labels
        ):
            once.setdefault(each[:3], each)
    return tuple(once.values())


def nearest_units(left: Iterable[FunctionalUnit], right: Iterable[FunctionalUnit]) -> list[NearUnits]:
    """Pair units of two lists that are nearly the same, each with one at most, those that differ least first.

    They differ in three things at most, and agree in more than half of what they say. In each pair the units
    have something in common that few units have.
    """
    lefts, rights = list(left), list(right)
    candidates = _candidates(lefts, rights)
    found = []
    for i, unit in enumerate(lefts):
        for j in candidates[i]:
            differences = unit_differences(unit, rights[j])
            if len(differences) <= _MOST and _agree(unit, rights[j]):
                found.append((len(differences), i, j, differences))
    pairs = []
    taken: set[int] = set()
    taken_there: set[int] = set()
    for _, i, j, differences in sorted(found):
        if i not in taken and j not in taken_there:
            taken.add(i)
            taken_there.add(j)
            pairs.append(NearUnits(lefts[i], rights[j], differences))
    return pairs


def units_kept_apart(units: Iterable[FunctionalUnit]) -> list[NearUnits]:
    """Return the pairs of units in one list that differ in a single thing which may be a slip.

    That is the motion, a state, a relation or an ingredient, or a label that is spelt almost like the other.
    Units with other labels are other units.
    """
    listed = list(units)
    pairs = []
    for i, others in enumerate(_candidates(listed, listed)):
        for j in sorted(others):
            one, other = listed[i], listed[j]
            sizes = len(one.inputs) == len(other.inputs) and len(one.outputs) == len(other.outputs)
            if i < j and sizes and len(differences := unit_differences(one, other)) == 1:
                (only,) = differences
                if only.kind in {"motion", "state", "relation"} or only.is_slip:
                    pairs.append(NearUnits(one, other, differences))
    return pairs


def _candidates(lefts: Sequence[FunctionalUnit], rights: Sequence[FunctionalUnit]) -> list[list[int]]:
    """Return for each unit a few of the others, by what they have in common that is rare."""
    by_part: defaultdict[object, list[int]] = defaultdict(list)
    for j, unit in enumerate(rights):
        for part in _signs(unit):
            by_part[part].append(j)
    found = []
    for unit in lefts:
        shared: Counter[int] = Counter()
        for part in _signs(unit):
            others = by_part.get(part, ())
            if len(others) <= _COMMON:
                shared.update(others)
        same = [j for j, _ in sorted(shared.items(), key=lambda each: (-each[1], each[0]))]
        found.append(same[:_LOOKED_AT])
    return found


def _signs(unit: FunctionalUnit) -> set[object]:
    """Return what a unit is found by: its nodes and its labels, alone and with the motion."""
    signs: set[object] = {unit.motion}
    for side, nodes in enumerate((unit.inputs, unit.outputs)):
        for node in nodes:
            signs |= {(side, node), (side, node.label), (side, node.label, unit.motion)}
            signs |= {(side, item) for item in node.ingredients}
    return signs


def _agree(left: FunctionalUnit, right: FunctionalUnit) -> bool:
    """Whether more than half of what two units say is the same."""
    here, there = Counter(_said(left)), Counter(_said(right))
    return 4 * (here & there).total() > here.total() + there.total()


def _said(unit: FunctionalUnit) -> Iterator[object]:
    yield unit.motion
    for side, nodes in enumerate((unit.inputs, unit.outputs)):
        for node in nodes:
            yield from ((side, node.label, part) for part in _parts(node))


def _parts(node: ObjectNode) -> list[_Part]:
    """Return what a node is made of."""
    return [
        ("label", node.label),
        *(("state", state) for state in sorted(node.states)),
        *(("relation", str(relation)) for relation in sorted(node.relations)),
        *(("ingredient", item) for item in node.ingredients),
    ]


def _between(node: ObjectNode, other: ObjectNode) -> tuple[UnitDifference, ...]:
    """Return in what two nodes differ; what stands alone on both sides is one difference."""
    here, there = Counter(_parts(node)), Counter(_parts(other))
    found = []
    for kind in ("label", "state", "relation", "ingredient"):
        ours, theirs = (
            sorted(name for part, name in (one - two).elements() if part == kind)
            for one, two in ((here, there), (there, here))
        )
        of = "" if kind == "label" else node.label
        if len(ours) == len(theirs):
            found += [UnitDifference(kind, *names, of) for names in zip(ours, theirs, strict=True)]
        else:
            found += [UnitDifference(kind, name, "", of) for name in ours]
            found += [UnitDifference(kind, "", name, of) for name in theirs]
    return tuple(found)


def _is_same_thing(node: ObjectNode, other: ObjectNode, differences: Sequence[UnitDifference]) -> bool:
    """Whether two nodes may be meant to be one: the label is the same, or little else differs."""
    return node.label == other.label or len(differences) <= 2


def _object(part: str) -> str:
    """Return the object of a relation, or an ingredient as it is."""
    return part.partition(" [")[2].rstrip("]") or part
