"""Pairs of functional units that are nearly the same, and their differences."""

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from foon_asp.network.functional_unit import FunctionalUnit
from foon_asp.network.object_node import ObjectNode
from foon_asp.network.spelling import one_letter_apart, without_doubles

_NodePart = tuple[str, str]


class UnitDifference(NamedTuple):
    """A difference of two units, listed once even if it occurs in several nodes.

    ``kind`` is motion, label, state, relation, ingredient, input or output. ``left`` is the text in the first
    unit, and ``right`` the text in the second unit. A text is empty if its unit has no counterpart. For input
    and output, the texts are whole object nodes in one-line notation.

    ``of`` is the label that the first unit has for the object with the difference. It is empty for the kinds
    motion, label, input and output.
    """

    kind: str
    left: str
    right: str
    of: str = ""

    @property
    def is_slip(self) -> bool:
        """Whether one of the two texts may be a typing error, since they are spelled almost alike.

        Texts are spelled almost alike if they differ by one letter, or only in doubled letters, capitals,
        blanks and punctuation. An empty text is like no other.
        """
        return bool(self.left and self.right) and (
            one_letter_apart(self.left, self.right)
            or without_doubles(self.left) == without_doubles(self.right)
        )


class NearUnits(NamedTuple):
    """Two units that are nearly the same, and their differences."""

    left: FunctionalUnit
    right: FunctionalUnit
    differences: tuple[UnitDifference, ...]


def unit_differences(left: FunctionalUnit, right: FunctionalUnit) -> tuple[UnitDifference, ...]:
    """Return the differences of two units, each once.

    Each node that only one unit has is paired with a node on the same side of the other unit. Pairs with the
    fewest differences are made first. Paired nodes have the same label or at most two differences. A node
    without a partner is a difference as a whole. A different label is not listed again as a container or an
    ingredient.
    """
    differences: list[UnitDifference] = []
    if left.motion != right.motion:
        differences.append(UnitDifference("motion", left.motion, right.motion))
    sides = ("input", left.inputs, right.inputs), ("output", left.outputs, right.outputs)
    for side, nodes, other_nodes in sides:
        unmatched, other_unmatched = (
            [n for n in nodes if n not in other_nodes],
            [n for n in other_nodes if n not in nodes],
        )
        ranked_pairs = sorted(
            (
                len(pair_differences := _node_differences(node, other_node)),
                node.label != other_node.label,
                i,
                j,
                pair_differences,
            )
            for i, node in enumerate(unmatched)
            for j, other_node in enumerate(other_unmatched)
        )
        paired: set[int] = set()
        other_paired: set[int] = set()
        for _, _, i, j, pair_differences in ranked_pairs:
            if (
                i not in paired
                and j not in other_paired
                and _may_correspond(unmatched[i], other_unmatched[j], pair_differences)
            ):
                paired.add(i)
                other_paired.add(j)
                differences += pair_differences
        differences += [
            UnitDifference(side, str(node), "") for i, node in enumerate(unmatched) if i not in paired
        ]
        differences += [
            UnitDifference(side, "", str(node))
            for j, node in enumerate(other_unmatched)
            if j not in other_paired
        ]
    labels = {(d.left, d.right) for d in differences if d.kind == "label"}
    distinct: dict[tuple[str, str, str], UnitDifference] = {}
    for difference in differences:
        # a label that differs does so as a container and as an ingredient, too
        if (
            difference.kind not in {"ingredient", "relation"}
            or (_related_object(difference.left), _related_object(difference.right)) not in labels
        ):
            distinct.setdefault(difference[:3], difference)
    return tuple(distinct.values())


def nearest_units(left: Iterable[FunctionalUnit], right: Iterable[FunctionalUnit]) -> list[NearUnits]:
    """Return pairs of equal or nearly equal units, one from each list; the fewest differences come first.

    Each unit is in at most one pair. The units of a pair have at most three differences, and more than half
    of their features in common (:func:`_features`). The right one is among the candidates for the left one
    (:func:`_candidate_indices`).
    """
    lefts, rights = list(left), list(right)
    candidates = _candidate_indices(lefts, rights)
    ranked_pairs = []
    for i, unit in enumerate(lefts):
        for j in candidates[i]:
            differences = unit_differences(unit, rights[j])
            if len(differences) <= 3 and _mostly_agree(unit, rights[j]):
                ranked_pairs.append((len(differences), i, j, differences))
    pairs = []
    paired: set[int] = set()
    other_paired: set[int] = set()
    for _, i, j, differences in sorted(ranked_pairs):
        if i not in paired and j not in other_paired:
            paired.add(i)
            other_paired.add(j)
            pairs.append(NearUnits(lefts[i], rights[j], differences))
    return pairs


def units_with_one_difference(units: Iterable[FunctionalUnit]) -> list[NearUnits]:
    """Return the pairs of units in one list that have a single difference, which may be a mistake.

    The difference is in motion, state or relation, or between two names that are spelled almost alike. Quite
    different labels are taken to be intended. Both units have equally many inputs and equally many outputs.
    The later unit is among the candidates for the earlier one (:func:`_candidate_indices`).
    """
    all_units = list(units)
    pairs = []
    for i, candidates in enumerate(_candidate_indices(all_units, all_units)):
        for j in sorted(candidates):
            unit, other = all_units[i], all_units[j]
            same_sizes = len(unit.inputs) == len(other.inputs) and len(unit.outputs) == len(other.outputs)
            if i < j and same_sizes and len(differences := unit_differences(unit, other)) == 1:
                (difference,) = differences
                if difference.kind in {"motion", "state", "relation"} or difference.is_slip:
                    pairs.append(NearUnits(unit, other, differences))
    return pairs


def _candidate_indices(
    lefts: Sequence[FunctionalUnit],
    rights: Sequence[FunctionalUnit],
    max_candidates: int = 12,
    max_sharing: int = 300,
) -> list[list[int]]:
    """Return for each unit of ``lefts`` the indices of up to ``max_candidates`` similar units of ``rights``.

    Units are similar if they share a rare key (:func:`_index_keys`); those that share the most come first. A
    key is rare if at most ``max_sharing`` units of ``rights`` have it.
    """
    by_key: defaultdict[object, list[int]] = defaultdict(list)
    for j, unit in enumerate(rights):
        for key in _index_keys(unit):
            by_key[key].append(j)
    candidates = []
    for unit in lefts:
        shared_keys: Counter[int] = Counter()  # by index of a unit of ``rights``: their number
        for key in _index_keys(unit):
            indices = by_key.get(key, ())
            if len(indices) <= max_sharing:
                shared_keys.update(indices)
        ranked = [j for j, _ in sorted(shared_keys.items(), key=lambda counted: (-counted[1], counted[0]))]
        candidates.append(ranked[:max_candidates])
    return candidates


def _index_keys(unit: FunctionalUnit) -> set[object]:
    """Return the keys by which similar units are looked up.

    These are the motion, and for each side its nodes, ingredients and labels. Labels are keys by themselves
    and together with the motion.
    """
    keys: set[object] = {unit.motion}
    for side, nodes in enumerate((unit.inputs, unit.outputs)):
        for node in nodes:
            keys |= {(side, node), (side, node.label), (side, node.label, unit.motion)}
            keys |= {(side, item) for item in node.ingredients}
    return keys


def _mostly_agree(left: FunctionalUnit, right: FunctionalUnit) -> bool:
    """Whether two units have more than half of their features in common, with repetitions."""
    features, other_features = Counter(_features(left)), Counter(_features(right))
    return 4 * (features & other_features).total() > features.total() + other_features.total()


def _features(unit: FunctionalUnit) -> Iterator[object]:
    """Yield the features of a unit: its motion, and each name in its nodes with the node's side and label."""
    yield unit.motion
    for side, nodes in enumerate((unit.inputs, unit.outputs)):
        for node in nodes:
            yield from ((side, node.label, node_part) for node_part in _named_parts(node))


def _named_parts(node: ObjectNode) -> list[_NodePart]:
    """Return the names in a node, each after its kind: ``("state", "chopped")``."""
    return [
        ("label", node.label),
        *(("state", state) for state in sorted(node.states)),
        *(("relation", str(relation)) for relation in sorted(node.relations)),
        *(("ingredient", item) for item in node.ingredients),
    ]


def _node_differences(node: ObjectNode, other: ObjectNode) -> tuple[UnitDifference, ...]:
    """Return the differences of two nodes.

    If both nodes have equally many different names of a kind, these are paired in alphabetical order.
    Otherwise, each different name is a difference with an empty text on the other side.
    """
    parts, other_parts = Counter(_named_parts(node)), Counter(_named_parts(other))
    differences = []
    for kind in ("label", "state", "relation", "ingredient"):
        names, other_names = (
            sorted(name for part_kind, name in (minuend - subtrahend).elements() if part_kind == kind)
            for minuend, subtrahend in ((parts, other_parts), (other_parts, parts))
        )
        label = "" if kind == "label" else node.label
        if len(names) == len(other_names):
            differences += [
                UnitDifference(kind, *pair, label) for pair in zip(names, other_names, strict=True)
            ]
        else:
            differences += [UnitDifference(kind, name, "", label) for name in names]
            differences += [UnitDifference(kind, "", name, label) for name in other_names]
    return tuple(differences)


def _may_correspond(node: ObjectNode, other: ObjectNode, differences: Sequence[UnitDifference]) -> bool:
    """Whether two nodes may be versions of one node: they have the same label, or at most two differences."""
    return node.label == other.label or len(differences) <= 2


def _related_object(text: str) -> str:
    """Return the object in the text of a relation, such as ``in [bowl]``; return other texts unchanged."""
    return text.partition(" [")[2].rstrip("]") or text
