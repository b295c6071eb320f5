"""Numbers for what a file has no ids for."""

from foon_asp.text.line import Line, name_of

_DIGITS = 15  # an id with more is none that one could count on from


class Numbering:
    """Gives ids to lines without one: objects by label, states by word, motions by label.

    What has an id somewhere gets the first that was learnt; everything else a new one, higher than all of
    its kind. So learn all lines before numbering the first.
    """

    def __init__(self) -> None:
        self._ids: dict[tuple[type, str], str] = {}
        self._highest: dict[type, int] = {}
        self._taken: set[tuple[type, str]] = set()

    def learn(self, line: Line) -> None:
        """Record the id of a line, if it has one."""
        if not line.id:
            return
        kind = type(line)
        self._ids.setdefault((kind, name_of(line)), line.id)
        self._taken.add((kind, line.id))
        if len(line.id) <= _DIGITS:
            self._highest[kind] = max(self._highest.get(kind, 0), int(line.id))

    def number(self, line: Line) -> Line:
        """Return the line with an id: its own, if it has one."""
        if line.id:
            return line
        kind, name = type(line), name_of(line)
        if (kind, name) not in self._ids:
            number = self._highest.get(kind, 0) + 1
            while (kind, str(number)) in self._taken:
                number += 1
            self._highest[kind] = number
            self._ids[kind, name] = str(number)
        return line._replace(id=self._ids[kind, name])
