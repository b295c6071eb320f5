"""The kitchen of a session: the one that was read, with its changes."""

from collections.abc import Iterable, Sequence
from pathlib import Path

import click

from foon_asp.cli.shell_line import quoted
from foon_asp.dataset import Dataset
from foon_asp.errors import UserError
from foon_asp.network import Network, ObjectNode, counted, pattern_at_level
from foon_asp.text.data_folder import STARTING, kitchen_item_warning
from foon_asp.text.diagnostics import Diagnostic, summarize
from foon_asp.text.goal_name import NodeNames, Wording, find_goal
from foon_asp.text.object_list import ListedObject, read_object_list

_HAVE = Wording("kitchen item", "", "have")
_LACK = Wording("kitchen item", " at hand", "lack")


class ShellKitchen:
    """What is at hand; ``question`` is asked with it. Changes are reported on stderr."""

    def __init__(self, dataset: Dataset) -> None:
        self.dataset = dataset
        self._read = dataset
        self._added: frozenset[int] = frozenset()
        self._removed: frozenset[int] = frozenset()

    @property
    def names(self) -> NodeNames:
        """Where names of object nodes are looked up."""
        return self.dataset.names

    @property
    def names_at_hand(self) -> NodeNames:
        """Where names of things at hand are looked up: they are numbered anew, in order of their ids."""
        nodes = tuple(map(self.names.node, sorted(self.dataset.kitchen)))
        return Network(nodes, (), (), (), (), {node: o for o, node in enumerate(nodes)}, {}, self.names.level)

    def have(self, words: Sequence[str]) -> None:
        """Put object nodes into the kitchen, by name."""
        before = self.dataset.kitchen
        found = find_nodes(words, self.names, _HAVE)
        self._change(self._added.union(found), self._removed.difference(found))
        for o in found:
            _say(f"{'already ' if o in before else ''}at hand: {self.names.node(o)}")

    def lack(self, words: Sequence[str]) -> None:
        """Take object nodes out of the kitchen, by name."""
        at_hand = sorted(self.dataset.kitchen)
        found = [at_hand[place] for place in find_nodes(words, self.names_at_hand, _LACK)]
        self._change(self._added.difference(found), self._removed.union(found))
        for o in found:
            _say(f"no longer at hand: {self.names.node(o)}")

    def take(self, file: Path) -> None:
        """Take the kitchen of a file instead, or the starting kitchen for ``@starting``.

        Raises :class:`UserError` if there is no such file, and :class:`InputError` for what is not understood
        in it.
        """
        if file == STARTING:
            self._read = self._read.with_starting_kitchen()
            self._change(frozenset(), frozenset())
            _say(f"kitchen: {self.size}, all that no unit makes")
            return
        if not file.is_file():
            raise UserError(f"{file}: no such file; have and lack change single object nodes")
        warnings: list[Diagnostic] = []
        items = read_object_list(file, warnings)
        level, find = self.names.level, self.names.find
        warnings += (kitchen_item_warning(i) for i in items if not find(pattern_at_level(i.pattern, level)))
        for text in summarize(warnings):
            _say(text)
        self._read = self._read.with_kitchen(items)
        self._change(frozenset(), frozenset())
        _say(f"kitchen: {self.size} from {file}")

    @property
    def size(self) -> str:
        """Say how many object nodes are at hand."""
        return counted(len(self.dataset.kitchen), "object node")

    def nodes(self) -> list[str]:
        """List what is at hand."""
        return self._sorted(self.dataset.kitchen)

    def changes(self) -> list[str]:
        """List what was put in, after a plus, and what was taken out, after a minus."""
        return [f"+ {n}" for n in self._sorted(self._added)] + [f"- {n}" for n in self._sorted(self._removed)]

    def _change(self, added: frozenset[int], removed: frozenset[int]) -> None:
        at_hand = self._read.kitchen
        self._added, self._removed = added - at_hand, removed & at_hand
        changed = self._added or self._removed
        self.dataset = self._read
        if changed:
            self.dataset = self._read.varied(self._added, self._removed, None)

    def _sorted(self, ids: Iterable[int]) -> list[str]:
        nodes: list[ObjectNode] = [self.names.node(o) for o in ids]
        return sorted(map(str, nodes))


def find_nodes(
    words: Sequence[str], among: NodeNames, wording: Wording, listed: Sequence[ListedObject] = ()
) -> list[int]:
    """Find the nodes that are named, each once; the beginning of a name is enough if only one name has it.

    Raises :class:`UserError` like :func:`foon_asp.text.goal_name.find_goal`.
    """
    if not words:
        raise UserError(f"name an object node: {wording.before} NAME...")
    alone = len(words) == 1
    try:
        found = [find_goal(word, among, listed, wording, by_beginning=alone) for word in words]
    except UserError as error:
        if alone:
            raise
        whole = quoted(" ".join(words))
        raise UserError(f"{error}\na name with blanks is in quotes: {wording.before} {whole}") from None
    return list(dict.fromkeys(found))


def _say(text: str) -> None:
    click.echo(text, err=True)
