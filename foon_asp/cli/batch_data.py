"""The data of a batch, opened once in each process that answers questions."""

import contextlib
import hashlib
import io
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from foon_asp.batch.batch_question import BatchQuestion
from foon_asp.cli import shared_options
from foon_asp.cli.named_path import NamedPath
from foon_asp.comparison.many import makeable
from foon_asp.dataset import Dataset
from foon_asp.dataset.item_options import items_for
from foon_asp.errors import UserError
from foon_asp.network import STARTING, Network, is_starting
from foon_asp.problem import ITEMS, ContainerRule, Problem
from foon_asp.text.data_folder import find_data
from foon_asp.text.object_list import read_object_list


@dataclass(frozen=True)
class Opening:
    """A function that opens the data of a batch, and that can be sent to other processes.

    ``options``: name and value of each option for data.
    ``digest``: a digest of the contents of the files. Openings with equal options and digests are equal.
    """

    options: tuple[tuple[str, Any], ...]
    digest: str

    def __call__(self, quiet: bool = True) -> "BatchData":
        """Read and return the data; ``quiet`` drops warnings, which the first process has shown already."""
        with contextlib.redirect_stderr(io.StringIO()) if quiet else contextlib.nullcontext():
            return BatchData(shared_options.read_dataset(**dict(self.options)))


class BatchData:
    """The data of a batch, with a dataset for each kitchen that questions have named so far."""

    def __init__(self, dataset: Dataset) -> None:
        self._datasets: dict[str | None, Dataset] = {None: dataset}

    def goals_of_word(self, word: str, containers: ContainerRule, kitchen: str | None) -> Sequence[str]:
        """Return the goals that ``@goals`` or ``@makeable`` stands for, in one-line notation.

        ``@makeable`` depends on the container rule and on the kitchen, as in :meth:`_dataset_with_kitchen`.
        """
        dataset = self._dataset_with_kitchen(kitchen)
        if word == "@makeable":
            problem = dataset.problem((0,), containers, everything=True)
            return [str(problem.network.objects[goal]) for goal in makeable(problem)]
        names = dataset.names
        goals = dict.fromkeys(dataset.goal_ids(()))
        if isinstance(names, Network):
            return [str(names.objects[goal]) for goal in goals]
        return [str(names.node(goal)) for goal in goals]

    def items(self, question: BatchQuestion) -> str:
        """Return ``used-up`` if the goals file has an amount for a goal of the question, else ``lasting``.

        Goals that cannot be understood have no amount.
        """
        dataset = self._datasets[None]  # all kitchens have the same goals
        if not dataset.goal_amounts:
            return ITEMS[0]
        try:
            return ITEMS[not dataset.goal_amounts.keys().isdisjoint(dataset.command_goal_ids(question.goals))]
        except UserError:
            return ITEMS[0]  # the row of the question says what is wrong with its goals

    @property
    def example(self) -> Problem:
        """A problem over the data with an arbitrary goal, to check rules that hold for all questions."""
        return self._datasets[None].problem((0,), "strict")

    def problem(self, question: BatchQuestion) -> Problem:
        """Return the problem of a question.

        Of a large store, only the part that the goals can need is read. It is read at the first use of the
        problem.
        """
        dataset = self._dataset_with_kitchen(question.kitchen)
        files = question.stock, question.stays
        stock, stays = (None if file is None else NamedPath(file) for file in files)
        goals = dataset.command_goal_ids(question.goals)
        items = items_for(dataset, goals, question.amounts, question.items, stock, stays)
        return dataset.nearby(goals, question.containers, items)

    def _dataset_with_kitchen(self, kitchen: str | None) -> Dataset:
        """Return the dataset with a kitchen; the file of a kitchen is read once.

        ``kitchen`` is the path of a file, ``@starting`` for the starting kitchen, or ``None`` for the kitchen
        of the data.
        """
        if kitchen is not None and kitchen not in self._datasets:
            dataset = self._datasets[None]
            self._datasets[kitchen] = (
                dataset.with_starting_kitchen()
                if kitchen == str(STARTING)
                else dataset.with_kitchen(read_object_list(NamedPath(kitchen)))
            )
        return self._datasets[kitchen]


def measure_names(options: dict[str, Any]) -> Collection[str]:
    """Return the names of the measures in the files of ``--measure``; ``options`` has values by name."""
    files = options["measures"]
    if not files:
        return ()
    from foon_asp.rules.measure import read_measures

    return read_measures(files)


def data_digest(options: dict[str, Any], question_files: Iterable[Path]) -> str:
    """Return 16 hexadecimal digits of a digest of the contents of all files that options and questions name.

    ``options`` has values by name. The digest also depends on whether stand-ins are allowed, and on whether
    the kitchen is the starting one; it does not depend on ``level`` and ``lenient``. Raises
    :class:`UserError` for a pipe, which the processes could not read again.
    """
    others = {"level", "lenient", "measures", "stand_ins", "stand_in_tables", "similar"}
    files = find_data(**{key: value for key, value in options.items() if key not in others})
    digest = hashlib.sha256(b"stand-ins" if options["stand_ins"] else b"")
    if is_starting(files.kitchen):  # its answers are not those of an empty kitchen
        digest.update(str(STARTING).encode())
    for file in (
        *files.network,
        *(table for table in files[1:] if table not in {None, STARTING}),
        *sorted(set(question_files)),
        *options["measures"],
        *options["similar"],
        *options["stand_in_tables"],
    ):
        if not file.is_file():
            raise UserError(f"{file}: expected a file, since every process reads it again")
        with file.open("rb") as opened:
            digest.update(hashlib.file_digest(opened, "sha256").digest())
    return digest.hexdigest()[:16]
