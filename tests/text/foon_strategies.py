"""Hypothesis strategies: object nodes, functional units, and FOON text whole and broken."""

from hypothesis import settings
from hypothesis import strategies as st

from foon_asp.network import Contents, FunctionalUnit, ObjectNode, Relation
from foon_asp.text.line import Line, MotionLine, ObjectLine, StateLine
from foon_asp.text.motion_times import is_time
from foon_asp.text.writer import write_line

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
    """Draw lists of units, each with an input; some without outputs, some nodes used several times.

    No motion ends in ``*``, which in FOON text marks a composite motion and is no part of its name.
    """
    motion = names().filter(lambda name: not name.endswith("*") or not name.strip("* "))

    def of_nodes(pool: list[ObjectNode]) -> st.SearchStrategy[list[FunctionalUnit]]:
        some = st.sampled_from(pool)
        unit = st.builds(
            FunctionalUnit.of,
            motion,
            st.lists(some, min_size=1, max_size=3),
            st.lists(some, max_size=3),
        )
        return st.lists(unit, max_size=most)

    return st.lists(nodes(), min_size=1, max_size=4).flatmap(of_nodes)


_IDS = st.just("") | st.integers(0, 999).map(str) | st.sampled_from(["00", "007"])
_TIMES = st.sampled_from(
    [
        "1:10",
        "12:59",
        "0:02:50",
        "Assumed",
        "assumed",
        "<Assumed>",
        "<Assumed,Assumed>",
        "<0:01, 0:09>",
        "<0:12-0:34,0:40-0:44>",
    ]
)


def object_lines() -> st.SearchStrategy[ObjectLine]:
    """Draw object lines without dirt: with and without id, flag, category and goal mark."""
    tags = st.sampled_from([(), ("0",), ("1",), ("1", "15"), ("0", "!"), ("!",)])
    return st.builds(ObjectLine, names(), _IDS, tags, st.just(()))


def state_lines() -> st.SearchStrategy[StateLine]:
    """Draw state lines without dirt: states, relations, contents in any order."""
    name, item = names(), names(without=",")
    relation = st.builds(Relation, name.filter(lambda word: word != "contains"), item)
    listed = st.lists(item, min_size=1, max_size=4, unique=True).map(tuple)
    holding = st.builds(
        lambda word, items, id_: StateLine(Contents(word, tuple(sorted(items))), id_, items),
        st.just("contains") | name,
        listed,
        _IDS,
    )
    return st.builds(StateLine, name | relation, _IDS, st.just(()), st.just(())) | holding


def motion_lines() -> st.SearchStrategy[MotionLine]:
    """Draw motion lines without dirt: with and without id, ``*``, times, entity and success rate."""
    motion = names().filter(lambda name: name[-1] != "*")
    entity = names().filter(lambda name: not is_time(name))
    rate = st.sampled_from(["0.85", ".5", "1", "1.0", "0", "1."])
    times = st.lists(_TIMES, max_size=2).map(tuple)
    fields = times | st.builds(lambda when, who, how: (*when, who, how), times, entity, rate)
    return st.builds(MotionLine, motion, _IDS, st.booleans(), fields, st.just(()))


def lines() -> st.SearchStrategy[Line]:
    """Draw lines of any kind without dirt."""
    return st.one_of(object_lines(), state_lines(), motion_lines())


# What annotators do to a line: a piece of it, and what they write instead.
_SLIPS = [
    ("\t", " "),
    ("\t", "\t\t"),
    ("\t", "\t "),
    ("\t", " \t"),
    ("\t", ""),
    ("]", ""),
    ("}", ""),
    ("[", ""),
    ("{", ""),
    ("]", "}"),
    ("{", "["),
    ("}", "]"),
    (",", ", "),
    (",", ",,"),
    (">", ""),
    ("<", ""),
    ("d", ""),
    ("1", "01"),
    ("0", "00"),
    (":", ""),
]


def dirty_lines() -> st.SearchStrategy[str]:
    """Draw lines with up to three slips in them: some are read with remarks, some not at all."""

    def slip(text: str, at: int, kind: tuple[str, str]) -> str:
        places = [i for i in range(len(text)) if text.startswith(kind[0], i)]
        if not places:
            return text
        place = places[at % len(places)]
        return text[:place] + kind[1] + text[place + len(kind[0]) :]

    def slips(text: str, kinds: list[tuple[int, tuple[str, str]]], end: str) -> str:
        for at, kind in kinds:
            text = slip(text, at, kind)
        return text + end

    some = st.lists(st.tuples(st.integers(0, 9), st.sampled_from(_SLIPS)), max_size=3)
    ends = st.sampled_from(["", "", " ", "\t", "]", "\t\t ", " \t"])
    return st.builds(slips, lines().map(write_line), some, ends)


# Each of these means something where it stands, or is a comment, or is empty.
_WHOLE_LINES = [
    "O\ttea",
    "O12\ttea pot\t1",
    "S\thot",
    "S41\tin\t[pot]",
    "S\tcontains\t{tea,milk}",
    "M\tpour",
    "M4\tpour\t1:10\tAssumed",
    "M4\tpour*\t<0:01,0:09>\tRobot\t0.85",
    "O12\ttea pot\t0\t15",
    "O\ttea\t0\t!",
    "//",
    "",
    "# note",
    "# From:\ta.txt:3\tv",
    "# Source:\thttps://example.org/tea",
]
_DIRTY_LINES = [
    "O tea",
    "O9\t\ttea\t0\t!",
    "O\ttea\t",
    "O\ttea\t0\tx",
    "S\tin\t[pot",
    "S\tin\t[pot}",
    "S\tin\tpot",
    "S\ton\t[]",
    "S\thot \t",
    "S\tcontains\t{a, a, b,,}",
    "M pour",
    "M4\tpour*\tAssume",
    "M\tpour\t<Assumed\t1:35]",
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
    "S\t",
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
    "# From:\ta.txt:3\tv\tw\n# From:\tb.txt:9\n"
    "O7\twater\t0\nS\tin\t[kettle]\nM9\tboil*\nO\twater\t1\t4\nS\thot\n//",
    "O\twater\nS\tin\t[kettle]\nM\tboil\nO\twater\nS\thot\n//",
    "O7\tkettle\t0\nS8\tcontains\t{water}\nM9\ttip\t<0:10>\t0:20\nO7\tkettle\t1\nO1\ttea\t0\n//",
]


def _with_dirt(unit: str, dirty: str) -> str:
    """Put a dirty line where the first of its letter stands."""
    lines = unit.split("\n")
    place = [line[0] for line in lines].index(dirty[0])
    return "\n".join([*lines[:place], dirty, *lines[place + 1 :]])


def unit_texts() -> st.SearchStrategy[str]:
    """Draw one unit as text, closed: as it should be, or with one line in it that is dirty."""
    whole = st.sampled_from(_WHOLE_UNITS)
    above = st.sampled_from(["", "", "# From:\ta.txt:3\tv\n", "# Source:\tv\n", "# note\n"])
    return st.builds(str.__add__, above, whole | st.builds(_with_dirt, whole, st.sampled_from(_DIRTY_LINES)))


def texts() -> st.SearchStrategy[str]:
    """Draw FOON text: whole units among single lines that are whole, dirty, broken or anything at all."""
    anything = st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\r\n"), max_size=5)
    piece = (
        st.sampled_from(_WHOLE_UNITS)
        | unit_texts()
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
