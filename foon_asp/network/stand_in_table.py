"""The table of stand-ins: prices of using one object node in place of another."""

from collections import Counter
from collections.abc import Iterator, Mapping
from enum import StrEnum
from fractions import Fraction
from types import MappingProxyType
from typing import NamedTuple

from foon_asp.network.object_node import ObjectNode

STAND_IN = "stand in"
"""The motion of a unit that is a stand-in: its input is used in place of its output."""


class Edit(StrEnum):
    """A way in which the node that is used differs from the node that it is used for."""

    WORD = "word"
    """The same container or ingredients with another word: ``on [plate]`` for ``in [plate]``."""
    CONTAINER = "container"
    """Another container or surface, an additional or a missing one: ``in [bowl]`` for ``in [pot]``."""
    MORE_STATE = "more state"
    """A state that only the node that is used has."""
    FEWER_STATE = "fewer state"
    """A state that the node that is used lacks."""
    MORE_INGREDIENT = "more ingredient"
    """An ingredient that only the node that is used has."""
    FEWER_INGREDIENT = "fewer ingredient"
    """An ingredient that the node that is used lacks."""
    CONTENTS = "other contents"
    """Contents with at most half of the ingredients in common: an empty bowl for a full one."""
    SPELLING = "spelling"
    """The same label in the plural, or with other blanks, hyphens or capitals: ``cherrytomatoes``."""
    LABEL = "label"
    """Another label; the table has the pair of labels."""
    NODE = "node"
    """Another object node; the table has the pair of nodes."""


class Difference(NamedTuple):
    """An edit between two nodes, with its price.

    ``served`` is the different part of the node that is wanted, ``serving`` that of the node used in its
    place. They are texts, and empty if the node lacks the part.
    """

    edit: Edit
    served: str
    serving: str
    price: Fraction


Pairs = Mapping[tuple[str | ObjectNode, str | ObjectNode], Fraction | None]


class StandInTable(NamedTuple):
    """The prices of using one object node in place of another.

    A price is above 0; ``None`` means that a difference is never allowed. ``edits`` has a price for each kind
    of edit. ``words`` has prices for single states and ingredients, by kind of edit and name. They take
    precedence over the price of the kind.

    ``pairs`` has prices for pairs of labels or of nodes: the one that is used, and the one in whose place it
    is used. The price of a pair of nodes is the whole price. The price of a pair of labels is added to the
    prices of the other edits.

    Example:
        >>> table = foon_asp.StandInTable.usual()
        >>> on, in_ = map(foon_asp.parse_node, ("egg; on [plate]", "egg; in [plate]"))
        >>> table.dissimilarity(on, in_), table.dissimilarity(on, foon_asp.parse_node("ham; on [plate]"))
        (Fraction(1, 1), None)
        >>> [(str(edit.edit), edit.served, edit.serving) for edit in table.differences(on, in_)]
        [('word', 'in [plate]', 'on [plate]')]
    """

    edits: Mapping[Edit, Fraction | None]
    words: Mapping[tuple[Edit, str], Fraction | None] = MappingProxyType({})
    pairs: Pairs = MappingProxyType({})

    @classmethod
    def usual(cls) -> "StandInTable":
        """Return the table with the built-in prices, which is used where no file changes it."""
        return cls(dict(_EDITS), dict(_WORDS), {})

    def dissimilarity(self, serving: ObjectNode, served: ObjectNode) -> Fraction | None:
        """Return the sum of the prices of the edits between two nodes.

        Return ``None`` if the one node never stands in for the other.

        Parameters:
            serving: The node that is used.
            served: A different node, in whose place it is used.
        """
        edits = self.differences(serving, served)
        return None if edits is None else sum((edit.price for edit in edits), Fraction(0))

    def differences(self, serving: ObjectNode, served: ObjectNode) -> tuple[Difference, ...] | None:
        """Return the edits between two nodes, whose prices add up to the dissimilarity.

        Return ``None`` if the one node never stands in for the other.

        Parameters:
            serving: The node that is used.
            served: A different node, in whose place it is used.
        """
        differences: list[Difference] = []
        for edit, served_part, serving_part, price in self._node_edits(serving, served):
            if price is None:
                return None
            differences.append(Difference(edit, served_part, serving_part, price))
        return tuple(differences)

    def price(self, edit: Edit, name: str) -> Fraction | None:
        """Return the price of an edit of a single state or ingredient, or ``None`` if it is never allowed.

        If the table has no price for this name, it is the price of the kind of edit.

        Parameters:
            edit: The kind of the edit.
            name: The state or ingredient.
        """
        key = edit, name
        return self.words[key] if key in self.words else self.edits[edit]

    def _node_edits(
        self, serving: ObjectNode, served: ObjectNode
    ) -> Iterator[tuple[Edit, str, str, Fraction | None]]:
        """Yield the edits between two nodes: kind, part of the served node, part of the serving one, price.

        The price is ``None`` if the edit is never allowed. If the table has the pair of nodes, this is the
        only edit. Different labels whose pair the table lacks are an edit of spelling if they are spelled
        alike; otherwise they are never allowed. Two relations to one object are an edit of the word. All
        other different relations are paired in alphabetical order, each pair as an edit of the container.
        """
        if (serving, served) in self.pairs:
            yield Edit.NODE, str(served), str(serving), self.pairs[serving, served]
            return
        labels = serving.label, served.label
        if serving.label != served.label and labels not in self.pairs and spelled_alike(*labels):
            yield Edit.SPELLING, served.label, serving.label, self.edits[Edit.SPELLING]
        elif serving.label != served.label:
            yield Edit.LABEL, served.label, serving.label, self.pairs.get(labels)
        yield from self._content_edits(serving, served)
        for state in sorted(served.states - serving.states):
            yield Edit.FEWER_STATE, state, "", self.price(Edit.FEWER_STATE, state)
        for state in sorted(serving.states - served.states):
            yield Edit.MORE_STATE, "", state, self.price(Edit.MORE_STATE, state)
        served_parts = sorted(served.relations - serving.relations)
        serving_parts = sorted(serving.relations - served.relations)
        for relation in list(served_parts):
            serving_relation = next((part for part in serving_parts if part.object == relation.object), None)
            if serving_relation is not None:
                served_parts.remove(relation)
                serving_parts.remove(serving_relation)
                yield Edit.WORD, str(relation), str(serving_relation), self.edits[Edit.WORD]
        for position in range(max(len(served_parts), len(serving_parts))):
            texts = [
                str(side[position]) if position < len(side) else "" for side in (served_parts, serving_parts)
            ]
            yield Edit.CONTAINER, texts[0], texts[1], self.edits[Edit.CONTAINER]

    def _content_edits(
        self, serving: ObjectNode, served: ObjectNode
    ) -> Iterator[tuple[Edit, str, str, Fraction | None]]:
        """Yield the edits between the contents of two nodes, each as :meth:`_node_edits` yields it.

        Contents with equal ingredients are one edit of the word. Otherwise each different ingredient is an
        edit. If at most half of the ingredients are common, an edit ``CONTENTS`` comes before the edits of
        the ingredients.
        """
        if serving.contents == served.contents:
            return
        served_parts, serving_parts = Counter(served.ingredients), Counter(serving.ingredients)
        if served_parts == serving_parts:
            words = [" and ".join(contents.word for contents in node.contents) for node in (served, serving)]
            yield Edit.WORD, words[0], words[1], self.edits[Edit.WORD]
            return
        common = (served_parts & serving_parts).total()
        if 2 * common <= max(served_parts.total(), serving_parts.total()):
            texts = ["; ".join(map(str, node.contents)) for node in (served, serving)]
            yield Edit.CONTENTS, texts[0], texts[1], self.edits[Edit.CONTENTS]
        for item in sorted((served_parts - serving_parts).elements()):
            yield Edit.FEWER_INGREDIENT, item, "", self.price(Edit.FEWER_INGREDIENT, item)
        for item in sorted((serving_parts - served_parts).elements()):
            yield Edit.MORE_INGREDIENT, "", item, self.price(Edit.MORE_INGREDIENT, item)


_PLURALS = {"sses": "ss", "shes": "sh", "ches": "ch", "ies": "y", "oes": "o", "s": ""}


def spelled_alike(label: str, other: str) -> bool:
    """Whether two labels differ at most in singular or plural, blanks, hyphens, underscores and capitals."""
    return spelling_key(label) == spelling_key(other)


def spelling_key(label: str) -> str:
    """Return a label in lower case and in the singular, without blanks, hyphens and underscores.

    Labels with the same key count as spelled alike. A label of up to three letters is taken for a singular.
    The key of ``Cherry tomatoes`` is ``cherrytomato``.
    """
    letters = label.casefold().replace(" ", "").replace("-", "").replace("_", "")
    for plural, singular in _PLURALS.items():
        if letters.endswith(plural) and len(letters) > (5 if singular else 3) and not letters.endswith("ss"):
            return letters.removesuffix(plural) + singular
    return letters


_EDITS: Mapping[Edit, Fraction | None] = {
    Edit.SPELLING: Fraction(1),
    Edit.WORD: Fraction(1),
    Edit.CONTAINER: Fraction(2),
    Edit.MORE_STATE: Fraction(3),
    Edit.FEWER_STATE: Fraction(4),
    Edit.MORE_INGREDIENT: Fraction(3),
    Edit.FEWER_INGREDIENT: Fraction(5),
    Edit.CONTENTS: None,
}
# States that an action has to bring about: nodes without them never stand in.
_STATES_OF_ACTIONS = (
    *(
        "cooked",
        "baked",
        "fried",
        "boiled",
        "grilled",
        "roasted",
        "steamed",
        "sauteed",
        "toasted",
        "hardboiled",
    ),
    *(
        "chopped",
        "sliced",
        "diced",
        "cubed",
        "minced",
        "grated",
        "shredded",
        "halved",
        "quartered",
        "crushed",
    ),
    *("peeled", "mashed", "ground", "melted", "beaten", "whipped", "kneaded", "hot"),
)
_WORDS: Mapping[tuple[Edit, str], Fraction | None] = {
    **{(Edit.FEWER_STATE, state): None for state in _STATES_OF_ACTIONS},
    **{(Edit.MORE_STATE, state): None for state in ("dirty", "burnt", "rotten")},
}
