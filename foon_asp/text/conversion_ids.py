"""Ids for lines of FOON text that have none."""

from foon_asp.text.line import Line, name_of


class Numbering:
    """The ids of names; lines without an id get the id of their name.

    There are three kinds of names: labels of objects, motions, and words of state lines, such as ``chopped``
    and ``in``. A name keeps the first id that is learnt for it. A name without an id gets a new one, which is
    higher than all ids of its kind with up to 15 digits. So all lines must be learnt before the first line is
    numbered.
    """

    def __init__(self) -> None:
        self._ids: dict[tuple[type, str], str] = {}
        self._highest: dict[type, int] = {}
        self._used_ids: set[tuple[type, str]] = set()

    def learn(self, line: Line) -> None:
        """Record the id of a line for its name; a line without an id is ignored."""
        if not line.id:
            return
        kind = type(line)
        self._ids.setdefault((kind, name_of(line)), line.id)
        self._used_ids.add((kind, line.id))
        if len(line.id) <= 15:  # ids after a longer one would be as long
            self._highest[kind] = max(self._highest.get(kind, 0), int(line.id))

    def number(self, line: Line) -> Line:
        """Return the line with an id: its own, or else the id of its name, which may be new."""
        if line.id:
            return line
        kind, name = type(line), name_of(line)
        if (kind, name) not in self._ids:
            number = self._highest.get(kind, 0) + 1
            while (kind, str(number)) in self._used_ids:
                number += 1
            self._highest[kind] = number
            self._ids[kind, name] = str(number)
        return line._replace(id=self._ids[kind, name])
