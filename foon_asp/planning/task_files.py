"""Planning tasks in files, whose delete relaxation is asked for."""

from collections.abc import Sequence
from pathlib import Path

from foon_asp.deadline import Deadline
from foon_asp.errors import UserError
from foon_asp.planning import sas_reader
from foon_asp.planning.delete_relaxation import relaxed
from foon_asp.planning.pddl_reader import read_pddl
from foon_asp.planning.strips_task import StripsTask
from foon_asp.text.plain_file import read_plain_text


def read_task(files: Sequence[Path], deadline: Deadline) -> StripsTask:
    """Read and ground a task: a domain and a problem in PDDL, or what Fast Downward's translator writes.

    Raises :class:`UserError` for other files, and what is not understood in them; :class:`LimitError` at the
    deadline.
    """
    deadline.doing = "reading the task"
    if len(files) == 1:
        text = read_plain_text(files[0])
        if not is_translated(text):
            raise UserError(
                f"{files[0]}: found one file that is not of Fast Downward's translator (it begins with "
                f"{sas_reader.BEGINNING}), expected DOMAIN.pddl PROBLEM.pddl"
            )
        with deadline.watched("reading the task"):
            return sas_reader.parse_sas(text, str(files[0]))
    if len(files) != 2:
        raise UserError(f"found {len(files)} files, expected DOMAIN.pddl PROBLEM.pddl, or TASK.sas")
    with deadline.watched("reading the task"):
        task = read_pddl(*files)
    return relaxed(task, deadline)


def is_translated(text: str) -> bool:
    """Whether a text looks like what Fast Downward's translator writes."""
    return text.startswith(sas_reader.BEGINNING)
