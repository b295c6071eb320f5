"""Reports on a disagreement between engines: one file with all data needed to reproduce it."""

import platform
from collections.abc import Iterable
from importlib.metadata import version
from pathlib import Path

from foon_asp.asp import Outcome
from foon_asp.asp.bare_program import bare_program
from foon_asp.encoding.encoding import read_encoding
from foon_asp.engines import ClaimedAnswer, DisagreementError
from foon_asp.engines.bare_clingo import ENGINE_OPTIONS
from foon_asp.errors import UserError
from foon_asp.json_layout import Json, json_text
from foon_asp.problem import Problem
from foon_asp.proof.certificate_subject import Subject
from foon_asp.results.plain_values import exact_measures, plain
from foon_asp.rules.passed_constraint import Constraint, LibraryUse, RuleText, find_constraint
from foon_asp.text.exact_number import decimal_text
from foon_asp.text.unit_price_list import write_unit_prices
from foon_asp.text.writer import write_units
from foon_asp.whole_file import write_whole

_DISTRIBUTIONS = ("foon-asp", "clingo", "highspy")


def write_disagreement(request: ClaimedAnswer, disagreement: DisagreementError) -> str:
    """Write a report on a disagreement into a file in the current folder; return the message for the user.

    :func:`disagreement_name` names the file. If it cannot be written, the message says so. An older report of
    this name is replaced.
    """
    name = disagreement_name(request.outcome)
    try:
        write_whole(
            Path(name), json_text(disagreement_json(request, disagreement)).encode("utf-8", "surrogatepass")
        )
    except UserError as error:  # what was found counts more than where it is written
        return f"{disagreement}; the report could not be written: {error}"
    return f"{disagreement}; question, data and answers are in {name}: attach it to your report"


def disagreement_name(outcome: Outcome) -> str:
    """Return the name of the file of a report.

    The name has a digest of the network, and the ids of the goals.
    """
    problem = outcome.problem
    return (
        f"foon-asp-disagreement-{_digests(problem)['network'][:8]}-{'-'.join(map(str, problem.goals))}.json"
    )


def disagreement_json(request: ClaimedAnswer, disagreement: DisagreementError) -> Json:
    """Return a disagreement as a JSON object: question, data and rules as text, and both answers.

    Included files are part of the text of rules. The key ``bare_clingo`` has the program that clingo was
    given, and its arguments.
    """
    outcome, settings = request.outcome, request.settings
    problem, answer = outcome.problem, disagreement.answer
    program = bare_program(problem, outcome.objectives, settings, request.soft)
    encodings = (f"#program base.\n{read_encoding(file).text}\n" for file in program.files)
    return {
        "message": str(disagreement),
        "question": {
            "goals": [str(problem.network.objects[o]) for o in problem.goals],
            "containers": str(problem.containers),
            "items": "lasting" if problem.items is None else "used-up",
            "level": problem.network.level,
            "objectives": list(map(str, outcome.objectives)),
            "constraints": list(_rule_texts(settings.constraints).values()),
            "soft": [
                {"rules": text, "weight": request.soft[constraint]}
                for constraint, text in _rule_texts(request.soft).items()
            ],
            "constants": list(settings.constants),
        },
        "data": _data_files(problem),
        "digests": _digests(problem),
        "answers": {
            "foon-asp": {
                "objectives": list(map(str, outcome.objectives)),
                "status": str(outcome.status),
                "units": None if outcome.units is None else list(outcome.units),
                "costs": plain(outcome.costs),
                "lower_bound": plain(exact_measures(outcome.bounds)),
                **({"penalty": request.penalty} if request.soft else {}),
            },
            answer.engine: {
                "objectives": list(map(str, answer.objectives)),
                "units": None if answer.units is None else list(answer.units),
                "costs": None if answer.units is None else plain(problem.costs(answer.units)),
            },
        },
        "bare_clingo": {
            "arguments": [*program.constants, *ENGINE_OPTIONS],
            "program": "".join(encodings) + program.text,
        },
        "versions": {name: version(name) for name in _DISTRIBUTIONS},
        "python": f"{platform.python_version()} on {platform.platform()}",
    }


def _rule_texts(constraints: Iterable[Constraint]) -> dict[Constraint, str]:
    """Return, for each constraint, the text of its rules and of the files that they include."""
    texts: dict[Constraint, str] = {}
    for constraint in constraints:
        definition = find_constraint(constraint)
        file = definition.file if isinstance(definition, LibraryUse) else definition
        texts[constraint] = file.text if isinstance(file, RuleText) else read_encoding(file).text
    return texts


def _data_files(problem: Problem) -> dict[str, str]:
    """Return the texts of a data folder for a problem, by file name.

    If the problem has rates and prices of units, they are included. Below level 3, the texts describe the
    network of level 3 from which the network of the problem was made.
    """
    network = problem.network
    detailed = network.detailed or network
    kitchen = sorted(problem.kitchen)
    if network.detailed is not None:
        kitchen = sorted(detail for o in kitchen for detail in network.objects_stand_for[o])
    files = {
        "FOON.txt": write_units(map(detailed.unit, range(len(detailed))), (), problem.amounts),
        "kitchen.json": json_text([str(detailed.objects[o]) for o in kitchen]),
        "utensils.txt": "".join(f"{label}\n" for label in sorted(problem.utensils)),
    }
    if problem.rates is not None:
        files["motion.txt"] = "".join(f"{motion}\t{decimal_text(r)}\n" for motion, r in problem.rates.items())
    if problem.unit_prices is not None:
        files["unit_prices.txt"] = write_unit_prices(problem.unit_prices)
    return files


def _digests(problem: Problem) -> dict[str, str]:
    """Return the digests of the data of a problem by name, as certificates have them."""
    subject = Subject(problem.network, problem.kitchen, problem.rates, problem.utensils, problem.unit_prices)
    return subject.digests()
