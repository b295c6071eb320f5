"""Reader of planning tasks in files, PDDL or the translator's format, as their delete relaxation."""

from collections.abc import Sequence
from pathlib import Path

from foon_asp.deadline import Deadline
from foon_asp.errors import UserError
from foon_asp.planning import sas_reader
from foon_asp.planning.delete_relaxation import delete_relaxation
from foon_asp.planning.pddl_outline import PddlOutline, require_task
from foon_asp.planning.strips_task import StripsTask
from foon_asp.planning.translator import require_translator, translate
from foon_asp.text.plain_file import read_plain_text

_EXPECTED = "DOMAIN.pddl PROBLEM.pddl, or TASK.sas"


def read_task(files: Sequence[Path], deadline: Deadline) -> StripsTask:
    """Return the delete relaxation of a planning task in files.

    ``files`` are a domain and a problem in PDDL, in any order, or one file of Fast Downward's translator. The
    domain may be left out if it is in the folder of the problem.

    Raises :class:`UserError` for other numbers or kinds of files, and for errors in a file. Raises
    :class:`LimitError` at the deadline.
    """
    if not 1 <= len(files) <= 2:
        raise UserError(f"found {len(files)} files, expected {_EXPECTED}")
    with deadline.watched("reading the task"):
        outlines = [PddlOutline(str(file), read_plain_text(file)) for file in files]
        if len(outlines) == 1 and outlines[0].text.startswith(sas_reader.BEGINNING):
            return delete_relaxation(sas_reader.parse_sas(outlines[0].text, outlines[0].file))
        domain, problem = _domain_and_problem(outlines)
    return read_pddl(domain, problem, deadline)


def read_pddl(domain: PddlOutline, problem: PddlOutline, deadline: Deadline) -> StripsTask:
    """Return the delete relaxation of a planning task in PDDL.

    Raises the errors of :func:`read_task`, and :class:`UserError` if Fast Downward's translator is not
    installed.
    """
    require_translator(f"{problem.file}: reading PDDL")
    with deadline.watched("reading the task"):
        require_task(domain, problem)
    text = translate(domain, problem, deadline)
    with deadline.watched("grounding the task"):
        return delete_relaxation(sas_reader.parse_sas(text, problem.file))


def _domain_and_problem(outlines: list[PddlOutline]) -> tuple[PddlOutline, PddlOutline]:
    """Return the domain and the problem among files; a missing domain is read from the problem's folder.

    Raises :class:`UserError` if the files are not one problem and at most one domain.
    """
    for outline in outlines:
        if outline.kind not in {"domain", "problem"}:
            raise UserError(
                f"{outline.file}: found neither a domain nor a problem in PDDL, which begins with (define "
                f"(domain NAME) or (define (problem NAME), expected {_EXPECTED}"
            )
    kinds = [outline.kind for outline in outlines]
    if kinds == ["domain"]:
        raise UserError(f"{outlines[0].file}: found a domain alone, expected its problem, too")
    if len(set(kinds)) < len(kinds):
        raise UserError(f"found two files with a {kinds[0]}, expected a domain and a problem")
    if kinds == ["problem"]:
        outlines = [_domain_in_folder_of(Path(outlines[0].file)), *outlines]
    domain, problem = sorted(outlines, key=lambda outline: outline.kind)
    return domain, problem


def _domain_in_folder_of(problem: Path) -> PddlOutline:
    """Return the domain in the folder of a problem, under a file name usual in planning competitions.

    The first such file that is a domain is returned. Raises :class:`UserError` if no file of such a name is a
    domain.
    """
    number = "".join(filter(str.isdigit, problem.stem))
    names = [
        f"{problem.stem}-domain{problem.suffix}",
        f"{problem.name[:3]}-domain.pddl",
        f"domain_{problem.name}",
        f"domain-{problem.name}",
        *(f"domain{mark}{number}.pddl" for mark in ("_", "-", "") if number),
        "domain.pddl",
    ]
    for name in names:
        file = problem.parent / name
        if file.is_file() and file != problem:
            outline = PddlOutline(str(file), read_plain_text(file))
            if outline.kind == "domain":
                return outline
    raise UserError(
        f"{problem}: found no domain beside this problem ({', '.join(dict.fromkeys(names))}), expected "
        f"{_EXPECTED}"
    )
