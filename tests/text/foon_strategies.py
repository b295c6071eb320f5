"""Hypothesis strategies: object nodes, functional units, and FOON text whole and broken."""

from hypothesis import settings
from hypothesis import strategies as st

from foon_asp.network import FunctionalUnit, ObjectNode

# The same examples in every run, and no time limit on a single one: the machine may be busy.
steady = settings(deadline=None, derandomize=True, max_examples=100)

BRACKETS_AND_BREAKS = "\t\r\n[]{}"

# Characters that a line-oriented reader might stumble over, more often than chance would bring them.
_TRICKY = "ab  é'\"#/,-.0\x0b\x0c\x1e\x85\xa0\u2028\ufeff漢🍠"


def names(without: str = "") -> st.SearchStrategy[str]:
    """Draw what may be a label, a state, a motion or a word, save for the characters in ``without``."""
    tricky = st.sampled_from([c for c in _TRICKY if c not in without])
    anything = st.characters(exclude_categories=["Cs"], exclude_characters=BRACKETS_AND_BREAKS + without)
    return st.text(tricky | anything, min_size=1, max_size=6).map(lambda name: name.strip(" ")).filter(bool)


def nodes(without: str = "") -> st.SearchStrategy[ObjectNode]:
    """Draw object nodes as FOON text can state them.

    A related object has no comma and does not stand behind ``contains``: both mean contents.
    """
    name, item = names(without), names(without + ",")
    relation = st.tuples(name.filter(lambda word: word != "contains"), item)
    contents = st.tuples(st.just("contains") | name, st.lists(item, max_size=3))
    return st.builds(
        ObjectNode.of,
        name,
        st.sets(name, max_size=2),
        st.sets(relation, max_size=2),
        st.lists(contents, max_size=2),
    )


def units(most: int = 4) -> st.SearchStrategy[list[FunctionalUnit]]:
    """Draw lists of units, each with an input; some without outputs, some nodes used several times."""

    def of_nodes(pool: list[ObjectNode]) -> st.SearchStrategy[list[FunctionalUnit]]:
        some = st.sampled_from(pool)
        unit = st.builds(
            FunctionalUnit.of,
            names(),
            st.lists(some, min_size=1, max_size=3),
            st.lists(some, max_size=3),
        )
        return st.lists(unit, max_size=most)

    return st.lists(nodes(), min_size=1, max_size=4).flatmap(of_nodes)


# Each of these means something where it stands, or is a comment, or is empty.
_WHOLE_LINES = [
    "O\ttea",
    "O12\ttea pot\t1",
    "S\thot",
    "S41\tin\t[pot]",
    "S\tcontains\t{tea,milk}",
    "M\tpour",
    "M4\tpour\t1:10\tAssumed",
    "//",
    "",
    "# note",
    "# Source:\thttps://example.org/tea",
]
_DIRTY_LINES = [
    "S\tunder [pan]",
    "S\tcontains\t{a,}",
    "S\tcoated\t[a,b]",
    "O\ttea\t00",
    "M\tpour\t3:0s7",
    "// ",
]
_BROKEN_LINES = [
    "O",
    "O\t",
    "O tea",
    "S\t",
    "S\tin\t[pot",
    "S\tin\t[pot]]",
    "M",
    "M\t",
    "M\t[",
    "///",
    " //",
    "Onion\tx",
    "tea",
    "{",
    "\t",
    "\x0c",
    "\ufeff",
    "\u2028O\ta",
]
_WHOLE_UNITS = [
    "O\twater\nS\tin\t[kettle]\nM\tboil\nO\twater\nS\thot\n//",
    "O7\tkettle\t0\nS8\tcontains\t{water}\nM9\ttip\t<0:10>\t0:20\nO7\tkettle\t1\nO1\ttea\t0\n//",
]


def texts() -> st.SearchStrategy[str]:
    """Draw FOON text: whole units among single lines that are whole, dirty, broken or anything at all."""
    anything = st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\r\n"), max_size=5)
    piece = (
        st.sampled_from(_WHOLE_UNITS)
        | st.sampled_from(_WHOLE_LINES)
        | st.sampled_from(_WHOLE_LINES + _DIRTY_LINES + _BROKEN_LINES)
        | anything
    )
    mixed = st.lists(piece, max_size=15)
    # Texts without any fault are rare among the mixed ones: whole units with only remarks between them.
    harmless = st.sampled_from([*_WHOLE_UNITS, "# note", "", "//", "# Source: v"])
    pieces = mixed | st.lists(harmless, max_size=8)
    ends = st.sampled_from(["", "\n"])
    text = st.builds(lambda lines, end: "\n".join(lines) + end, pieces, ends)
    return st.builds(lambda t, crlf: t.replace("\n", "\r\n") if crlf else t, text, st.booleans())
