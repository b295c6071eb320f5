"""What a line of a shell that begins with ``foon-asp`` may go on with."""

from collections.abc import Iterable, Sequence
from functools import cached_property
from itertools import islice, pairwise
from typing import NamedTuple

import click

from foon_asp.cli import options
from foon_asp.cli.shell_completion import MOST, beginning, option_words
from foon_asp.cli.shell_kitchen import ShellKitchen
from foon_asp.cli.shell_line import take_apart
from foon_asp.cli.verbs import VERBS, verb_command
from foon_asp.errors import UserError
from foon_asp.questions.posing import DATA


class Completed(NamedTuple):
    """Words for the place of the last one, of which there is the ``fragment``, ``quoted`` or not."""

    words: tuple[str, ...]
    fragment: str
    quoted: bool


def words_after(line: str) -> Completed:
    """Give the words that may be meant; none where the data that the line names cannot be read."""
    taken = take_apart(line)
    words = [word.text for word in taken.words[1:]]
    fragment = words.pop() if words and (taken.open_quote or not line[-1:].isspace()) else ""
    try:
        found = tuple(islice(dict.fromkeys(_words(words, fragment)), MOST))
    except (UserError, OSError, click.ClickException):
        found = ()
    return Completed(found, fragment, bool(taken.open_quote))


def _words(before: Sequence[str], fragment: str) -> Iterable[str]:
    if not before:
        return beginning(VERBS, fragment)
    verb = before[0]
    return option_words(verb, before[-1], fragment, _Data(before)) if verb in VERBS else ()


class _Data:
    """The data that a line names, read when it is first looked at."""

    def __init__(self, words: Sequence[str]) -> None:
        self._verb, *rest = words
        self._words = rest[:-1] if rest and rest[-1].startswith("-") else rest

    @cached_property
    def kitchen(self) -> ShellKitchen:
        """What names are looked up in."""
        command = verb_command(self._verb)
        context = command.make_context(self._verb, [*self._words], resilient_parsing=True)
        given = context.params
        said = {name: given.get(name) for name in DATA}
        said |= {name: given.get(name) or () for name in ("network", "sources", "measures")}
        with context.scope():
            level = given.get("level") or 3
            return ShellKitchen(options.read_dataset(**said, lenient=True, level=level))  # type: ignore[arg-type]

    @property
    def constraints(self) -> Sequence[str]:
        """The names of the constraints that the line has so far."""
        return [value.partition(":")[0] for flag, value in pairwise(self._words) if flag == "--constraint"]
