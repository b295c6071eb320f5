"""The names that FOONs know, the brackets of words, and what units with a motion do."""

import unicodedata
from collections import Counter
from collections.abc import Iterator
from functools import cached_property
from pathlib import Path

from foon_asp.linting.habits import Habit
from foon_asp.linting.names import Kind, Names
from foon_asp.linting.near_names import by_what_is_left
from foon_asp.network import Contents, Relation, counted
from foon_asp.text.line import LineError, StateLine
from foon_asp.text.table import read_rows

_UTENSILS = "utensils.txt"
UTENSIL, HABIT = "utensil", "habit"
Bracket = type[Relation] | type[Contents]
_BRACKETS: dict[str, Bracket] = {"[ ]": Relation, "{ }": Contents}
_LEAST = 3  # lines of a word before it says anything of its brackets


class Vocabulary:
    """Names of each kind, how often words of relations stand with each bracket, and what units mostly do."""

    def __init__(self) -> None:
        self.names: dict[Kind, set[str]] = {kind: set() for kind in Kind}
        self.utensils: set[str] = set()
        self.brackets: dict[str, Counter[Bracket]] = {}
        self.habits: dict[str, Habit] = {}

    @classmethod
    def of(cls, names: Names) -> "Vocabulary":
        """Learn from files; a utensil is an object that others are in or on, or that a table says is one."""
        learned = cls()
        for kind in Kind:
            learned.names[kind].update(names.mentions[kind])
        for table in names.files.tables:
            if Path(table.file).name == _UTENSILS:
                learned.utensils.update(line.strip() for line in table.lines if line.strip()[:1] not in "#")
        learned.names[Kind.OBJECT] |= learned.utensils
        learned.habits = names.habits.of_motions()
        for word, mentions in names.mentions[Kind.WORD].items():
            counts = learned.brackets.setdefault(word, Counter())
            for mention in mentions:
                if isinstance(mention.line, StateLine) and not mention.line.remarks:
                    attribute = mention.line.attribute
                    counts[Relation if isinstance(attribute, Relation) else Contents] += mention.often
                    if isinstance(attribute, Relation) and attribute.object in names.objects:
                        learned.utensils.add(attribute.object)
        return learned

    def add(self, other: "Vocabulary") -> None:
        """Add what another one knows."""
        for kind in Kind:
            self.names[kind] |= other.names[kind]
        self.utensils |= other.utensils
        for motion, habit in other.habits.items():
            self.habits[motion] = self.habits.get(motion, Habit()).plus(*habit)
        for word, counts in other.brackets.items():
            self.brackets.setdefault(word, Counter()).update(counts)

    @cached_property
    def words(self) -> frozenset[str]:
        """Every word of every name."""
        return frozenset(word for names in self.names.values() for name in names for word in words_of(name))

    @cached_property
    def near(self) -> dict[Kind, dict[str, list[str]]]:
        """The words of each kind by themselves and by what is left of them when a letter is taken away."""
        found = {}
        for kind in Kind:
            alike = (Kind.STATE, Kind.MOTION) if kind in {Kind.STATE, Kind.MOTION} else (kind,)
            words = {word for each in alike for name in self.names[each] for word in words_of(name)}
            opposites = {f"un{word}" for word in words if word.endswith("ed")}
            found[kind] = by_what_is_left(words | opposites)
        return found

    def usual_bracket(self, word: str) -> Bracket | None:
        """Give ``Relation`` or ``Contents`` for a word that stands with one of them nearly always."""
        counts = self.brackets.get(word)
        if not counts:
            return None
        (kind, often), *others = counts.most_common()
        return kind if often >= max(_LEAST, 10 * sum(count for _, count in others)) else None

    def text(self) -> str:
        """Write a vocabulary, as :func:`read_vocabulary` reads it."""
        rows = [(str(kind), name) for kind in Kind if kind is not Kind.WORD for name in self.names[kind]]
        rows += [(UTENSIL, name) for name in self.utensils]
        rows += [
            (f"{Kind.WORD} {sign}", f"{word}\t{self.brackets[word][bracket]}")
            for word in self.brackets
            for sign, bracket in _BRACKETS.items()
            if self.brackets[word][bracket]
        ]
        rows += [(HABIT, "\t".join(map(str, (motion, *habit)))) for motion, habit in self.habits.items()]
        return "".join(f"{kind}\t{name}\n" for kind, name in sorted(rows))


def words_of(name: str) -> Iterator[str]:
    """Give the words of a name that are made of letters alone, small and without accents."""
    if not name.isascii():
        name = "".join(c for c in unicodedata.normalize("NFD", name) if not unicodedata.combining(c))
    return (word for word in name.lower().replace("-", " ").split(" ") if word.isalpha())


def _counted(kind: str, row: str, count: int) -> tuple[str, list[int]]:
    """Give a name and the numbers behind it."""
    name, *numbers = row.split("\t")
    if len(numbers) != count or not all(number.isascii() and number.isdigit() for number in numbers):
        raise LineError(len(kind) + 2, repr(row), (f"a name and, behind tabs, {counted(count, 'number')}",))
    return name, [int(number) for number in numbers]


def read_vocabulary(file: Path) -> Vocabulary:
    """Read ``kind⇥name`` lines; raises :class:`InputError` for a line of another form."""
    found = Vocabulary()
    kinds = {str(kind): kind for kind in Kind if kind is not Kind.WORD}

    def read(kind: str, name: str, _: object) -> None:
        sign = _BRACKETS.get(kind.removeprefix(f"{Kind.WORD} "))
        if kind in kinds:
            found.names[kinds[kind]].add(name)
        elif kind == UTENSIL:
            found.utensils.add(name)
            found.names[Kind.OBJECT].add(name)
        elif sign:
            word, (often,) = _counted(kind, name, 1)
            found.names[Kind.WORD].add(word)
            found.brackets.setdefault(word, Counter())[sign] += often
        elif kind == HABIT:
            motion, counts = _counted(kind, name, len(Habit._fields))
            found.habits[motion] = found.habits.get(motion, Habit()).plus(*counts)
        else:
            expected = (*kinds, UTENSIL, HABIT, *(f"{Kind.WORD} {sign}" for sign in _BRACKETS))
            raise LineError(1, repr(kind), expected)

    read_rows(file, "vocabulary", "a name", read)
    return found
