"""Object nodes: objects in a state."""

from collections.abc import Iterable
from typing import NamedTuple

from foon_asp.network.quoted_name import FIRST, LISTED, in_quotes, quoted


class Relation(NamedTuple):
    """A relation to another object, such as ``in [bowl]``: its word, and the label of that object."""

    word: str
    object: str

    def __str__(self) -> str:
        # "contains [a]" is read as contents, and so is a list in square brackets
        related_object = in_quotes(self.object) if self.word == "contains" else quoted(self.object, LISTED)
        return f"{quoted(self.word)} [{related_object}]"


class Contents(NamedTuple):
    """Contents of an object, such as ``contains {a,b}``: their word, and the sorted ingredients.

    An ingredient may be repeated.
    """

    word: str
    ingredients: tuple[str, ...]

    def __str__(self) -> str:
        return f"{quoted(self.word)} {{{','.join(quoted(item, LISTED) for item in self.ingredients)}}}"


class ObjectNode(NamedTuple):
    """An object in a state; two nodes are equal if all four parts are, as at level 3 of FOON.

    ``label`` is its name, ``states`` the set of its states, ``relations`` what it is in or on, ``contents``
    what it contains. Motion flags, times and ids belong to the line that was read and are no part of it.
    :meth:`of` makes a node and sorts the parts that have no order. The class is a named tuple, because tens
    of thousands of nodes are hashed and compared.

    Example:
        >>> node = foon_asp.parse_node("onion; chopped; in [bowl]")
        >>> node.label, sorted(node.states), sorted(node.relations)
        ('onion', ['chopped'], [Relation(word='in', object='bowl')])
        >>> node.is_in("bowl"), node == foon_asp.ObjectNode.of("onion", ["chopped"], [("in", "bowl")])
        (True, True)
    """

    label: str
    states: frozenset[str] = frozenset()
    relations: frozenset[Relation] = frozenset()
    contents: tuple[Contents, ...] = ()

    @classmethod
    def of(
        cls,
        label: str,
        states: Iterable[str] = (),
        relations: Iterable[tuple[str, str]] = (),
        contents: Iterable[tuple[str, Iterable[str]]] = (),
    ) -> "ObjectNode":
        """Make a node from plain values.

        Parameters:
            label: The name of the object.
            states: Its states.
            relations: Pairs of a word and an object, such as ``("in", "bowl")``.
            contents: Pairs of a word and ingredients, such as ``("contains", ["salt"])``.
        """
        return cls(
            label,
            frozenset(states),
            frozenset(Relation(*relation) for relation in relations),
            tuple(sorted(Contents(word, tuple(sorted(items))) for word, items in contents)),
        )

    @property
    def ingredients(self) -> tuple[str, ...]:
        """The ingredients of all contents in one sorted tuple; duplicates are kept."""
        if len(self.contents) == 1:
            return self.contents[0].ingredients
        return tuple(sorted(item for contents in self.contents for item in contents.ingredients))

    def is_in(self, container: str) -> bool:
        """Whether the node has a relation, by any word, to an object.

        Parameters:
            container: The label of the object.
        """
        return any(relation.object == container for relation in self.relations)

    def __str__(self) -> str:
        """Return the one-line notation: ``sweet potato; chopped; in [cutting board]``."""
        parts = [
            quoted(self.label, FIRST),
            *map(quoted, sorted(self.states)),
            *map(str, sorted(self.relations)),
            *map(str, self.contents),
        ]
        return "; ".join(parts)
