"""Vocabularies: known names, the brackets of words, and the habits of motions."""

import unicodedata
from collections.abc import Iterable, Iterator, Sequence
from collections.abc import Set as AbstractSet
from functools import cached_property
from pathlib import Path

from foon_asp.linting.habits import Habit, Habits
from foon_asp.linting.names import Kind, Names
from foon_asp.linting.near_names import deletion_index, near_word
from foon_asp.network import Contents, Relation, counted
from foon_asp.text.line import LineError, StateLine
from foon_asp.text.value_table import read_rows

_UTENSILS_FILE = "utensils.txt"
UTENSIL, HABIT = "utensil", "habit"
Bracket = type[Relation] | type[Contents]
_BRACKETS: dict[Bracket, str] = {Relation: f"{Kind.WORD} [ ]", Contents: f"{Kind.WORD} {{ }}"}
_NUMBERS = {
    **dict.fromkeys((Kind.OBJECT, Kind.STATE, Kind.MOTION, UTENSIL), 0),
    **dict.fromkeys(_BRACKETS.values(), 1),
    HABIT: len(Habit._fields),
}
"""The kinds of rows in a vocabulary, with the number of numbers behind a name."""
_Row = tuple[str, str, Sequence[int]]


class Vocabulary:
    """Known names by kind, with numbers.

    A word of relations has two numbers: on how many lines each kind of bracket follows it. A motion has its
    :class:`Habit`. Other names have no numbers. The numbers of several rows for one name are added up.
    """

    def __init__(self, rows: Iterable[_Row] = ()) -> None:
        """Collect rows; each has a kind, a name of this kind, and the numbers of the name."""
        self.numbers: dict[str, dict[str, Sequence[int]]] = {kind: {} for kind in _NUMBERS}
        for kind, name, numbers in rows:
            by_name = self.numbers[kind]
            by_name[name] = (
                [*map(sum, zip(by_name[name], numbers, strict=True))] if name in by_name else numbers
            )

    @classmethod
    def of(cls, names: Names, habits: Habits) -> "Vocabulary":
        """Collect the names and habits of linted files.

        Utensils are objects to which others have a relation, and the names in ``utensils.txt``. Lines on
        which the reader made remarks are ignored for the brackets that follow words, and for utensils.
        """
        rows: list[_Row] = [
            (kind, name, ()) for kind in Kind if kind is not Kind.WORD for name in names.mentions[kind]
        ]
        for table in names.files.tables:
            if Path(table.file).name == _UTENSILS_FILE:
                rows += [(UTENSIL, line.strip(), ()) for line in table.lines if line.strip()[:1] not in "#"]
        for word, mentions in names.mentions[Kind.WORD].items():
            for line, occurrences in ((mention.line, mention.occurrences) for mention in mentions):
                if isinstance(line, StateLine) and not line.remarks and not isinstance(line.attribute, str):
                    rows.append((_BRACKETS[type(line.attribute)], word, [occurrences]))
                    if isinstance(line.attribute, Relation) and line.attribute.object in names.object_counts:
                        rows.append((UTENSIL, line.attribute.object, ()))
        return cls([*rows, *((HABIT, motion, habit) for motion, habit in habits.habits_of_units())])

    def union(self, other: "Vocabulary") -> "Vocabulary":
        """Return a vocabulary with the names of both; the numbers of common names are added up."""
        return Vocabulary([*self._rows(), *other._rows()])

    def _rows(self) -> Iterator[_Row]:
        """Yield all names as rows, as :meth:`__init__` takes them."""
        for kind, by_name in self.numbers.items():
            yield from ((kind, name, numbers) for name, numbers in by_name.items())

    @property
    def utensils(self) -> AbstractSet[str]:
        """The labels of utensils."""
        return self.numbers[UTENSIL].keys()

    @cached_property
    def names(self) -> dict[Kind, AbstractSet[str]]:
        """The names of each kind; those of objects include utensils, containers and ingredients."""
        names = {kind: self.numbers[kind].keys() for kind in (Kind.STATE, Kind.MOTION)}
        words = {word for kind in _BRACKETS.values() for word in self.numbers[kind]}
        return {**names, Kind.WORD: words, Kind.OBJECT: self.numbers[Kind.OBJECT].keys() | self.utensils}

    @cached_property
    def words(self) -> frozenset[str]:
        """Every word of every name, as :func:`words_of` returns them."""
        return frozenset(word for names in self.names.values() for name in names for word in words_of(name))

    @cached_property
    def _deletion_indexes(self) -> dict[Kind, dict[str, list[str]]]:
        """By kind of name, the :func:`deletion_index` of the words in its names.

        States and motions share an index. For each word that ends in ed, a word with un before it is added:
        unpeeled for peeled.
        """
        indexes = {}
        for kind in Kind:
            kinds = (Kind.STATE, Kind.MOTION) if kind in {Kind.STATE, Kind.MOTION} else (kind,)
            words = {word for name_kind in kinds for name in self.names[name_kind] for word in words_of(name)}
            opposites = {f"un{word}" for word in words if word.endswith("ed")}
            indexes[kind] = deletion_index(words | opposites)
        return indexes

    def find_slip(self, kind: Kind, name: str) -> tuple[str, str] | None:
        """Return the first unknown word of a name that is probably a slip, and the known word that is meant.

        Return ``None`` if the name is known, or has no such word.
        """
        if name in self.names[kind]:
            return None
        for word in words_of(name):
            if word not in self.words:
                meant = near_word(word, self._deletion_indexes[kind], verbs=kind is not Kind.OBJECT)
                if meant is not None:
                    return word, meant
        return None

    def habit(self, motion: str) -> Habit:
        """Return the habit of the units with a motion; all counts are 0 for an unknown motion."""
        return Habit(*self.numbers[HABIT].get(motion, ()))

    def brackets(self, word: str) -> dict[Bracket, int]:
        """Return on how many lines each kind of bracket follows a word, the more frequent kind first.

        A kind of bracket that never follows the word is left out.
        """
        counts = {
            bracket: self.numbers[kind][word][0]
            for bracket, kind in _BRACKETS.items()
            if word in self.numbers[kind]
        }
        return dict(sorted(counts.items(), key=lambda entry: -entry[1]))

    def usual_bracket(self, word: str) -> Bracket | None:
        """Return the kind of bracket that nearly always follows a word.

        It follows the word on at least three lines, and ten times as often as the other kind. Return ``None``
        if no kind does.
        """
        for bracket, occurrences in self.brackets(word).items():
            others = sum(self.brackets(word).values()) - occurrences
            return bracket if occurrences >= max(3, 10 * others) else None
        return None

    def text(self) -> str:
        """Return the vocabulary as the text of a file that :func:`read_vocabulary` reads."""
        rows = [(kind, "\t".join(map(str, (name, *numbers)))) for kind, name, numbers in self._rows()]
        return "".join(f"{kind}\t{row}\n" for kind, row in sorted(rows))


def words_of(name: str) -> Iterator[str]:
    """Yield the words of a name in small letters, without accents; hyphens separate words.

    Words with other characters than letters are left out.
    """
    if not name.isascii():
        name = "".join(
            letter for letter in unicodedata.normalize("NFD", name) if not unicodedata.combining(letter)
        )
    return (word for word in name.lower().replace("-", " ").split(" ") if word.isalpha())


def read_vocabulary(file: Path) -> Vocabulary:
    """Read a vocabulary: lines of a kind, a name and its numbers, separated by tabs.

    Raises :class:`InputError` for a line of another form.
    """
    rows: list[_Row] = []

    def read_row(kind: str, row: str, _: object) -> None:
        """Add a line to ``rows``; ``row`` is the text of the line after the kind."""
        if kind not in _NUMBERS:
            raise LineError(1, repr(kind), tuple(_NUMBERS))
        name, *numbers = row.split("\t")
        if len(numbers) != _NUMBERS[kind] or not all(
            number.isascii() and number.isdigit() for number in numbers
        ):
            expected = f"a name and, behind tabs, {counted(_NUMBERS[kind], 'number')}"
            raise LineError(len(kind) + 2, repr(row), (expected if _NUMBERS[kind] else "a name alone",))
        rows.append((kind, name, list(map(int, numbers))))

    read_rows(file, "vocabulary", "a name", read_row)
    return Vocabulary(rows)
