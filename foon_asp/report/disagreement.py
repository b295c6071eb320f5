"""A disagreement between engines as a folder of data that asks the same question again."""

import platform
import shlex
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from foon_asp.asp import Outcome
from foon_asp.certificate import coverage
from foon_asp.document.json_document import costs_json
from foon_asp.encoding.encoding import read_encoding
from foon_asp.encoding.own_encodings import ENCODING_FILES
from foon_asp.engines import Asked, DisagreementError
from foon_asp.engines.bare_clingo import printed_command
from foon_asp.errors import UserError
from foon_asp.proof.verify import digests
from foon_asp.report.answer import answer_json
from foon_asp.report.whole_file import write_whole
from foon_asp.resources import encodings_folder
from foon_asp.rules.constraint import Constraint, RuleText, find_constraint
from foon_asp.text.exact_price import decimal_text
from foon_asp.text.json_value import json_text
from foon_asp.text.unit_price_list import write_unit_prices
from foon_asp.text.writer import write_units

_DISTRIBUTIONS = ("foon-asp", "clingo", "highspy", "up-fast-downward")


def write_disagreement(asked: Asked, found: DisagreementError) -> str:
    """Write all that is needed to look into a disagreement to a new folder; say what was found, and where."""
    folder = Path(disagreement_name(asked.outcome))
    try:
        for name, content in disagreement_files(asked, found).items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            write_whole(folder / name, content.encode("utf-8", "surrogatepass"))
    except (OSError, UserError) as error:  # what was found counts more than where it is written
        return f"{found}; the data could not be written to {folder}/: {error}"
    return f"{found}; data, question and answers are in {folder}/ (see report.json)"


def disagreement_name(outcome: Outcome) -> str:
    """Name the folder, by the data and the question."""
    problem = outcome.problem
    marks = digests(problem.network, problem.kitchen, problem.rates, problem.utensils, problem.unit_prices)
    return f"foon-asp-disagreement-{marks['network'][:8]}-{'-'.join(map(str, problem.goals))}"


def disagreement_files(asked: Asked, found: DisagreementError) -> dict[str, str]:
    """Give the files of the folder by name: the data, numbered as they were, the rules, and ``report.json``.

    The kitchen lists nodes as JSON kitchens can; ``report.json`` has them in one-line notation, too. Files of
    rules have in them what they include. ``facts.lp`` is what bare clingo was given.
    """
    outcome, settings = asked.outcome, asked.settings
    problem, answer = outcome.problem, found.answer
    network = problem.network
    # below level 3 the folder has what the network was made from; the command names the level
    whole = network.detailed or network
    at_hand = sorted(problem.kitchen)
    if network.detailed is not None:
        at_hand = sorted(detail for o in at_hand for detail in network.objects_stand_for[o])
    nodes = [whole.objects[o] for o in at_hand]
    kitchen = [
        {
            "label": node.label,
            "states": [*sorted(node.states), *map(str, sorted(node.relations))],
            "ingredients": list(node.ingredients),
        }
        for node in nodes
    ]
    goals = [str(network.objects[o]) for o in problem.goals]
    words = ["foon-asp", "solve", "--data", ".", "--containers", str(problem.containers)]
    words += ["--level", str(network.level), "--objective", ",".join(outcome.objectives), "--cross-check"]
    rules = _Rules()
    for each in dict.fromkeys(map(find_constraint, settings.constraints)):
        words += ["--rule" if isinstance(each, RuleText) else "--constraint", rules.copy(each)]
    for each, weight in asked.soft.items():
        words += ["--soft", f"{rules.copy(each)}={weight}"]
    if settings.replaced is not None:
        words += ["--encodings", rules.copy_encodings(settings.replaced)]
    words += [word for setting in settings.constants for word in ("-c", setting)]
    words += [word for goal in goals for word in ("--goal", goal if ";" in goal else goal + ";")]
    bare, facts = printed_command(asked)
    bare = [rules.names.get(word, word) for word in bare]
    report = {
        "message": str(found),
        "command": shlex.join(words),
        "bare_clingo": shlex.join(bare),
        "versions": {"python": platform.python_version()} | {name: _version(name) for name in _DISTRIBUTIONS},
        "platform": platform.platform(),
        "digests": digests(network, problem.kitchen, problem.rates, problem.utensils, problem.unit_prices),
        "kitchen": [str(node) for node in nodes],
        "forbidden_units": sorted(coverage(settings).forbids(problem)),
        "answer": answer_json(outcome) | ({"penalty": asked.penalty} if asked.soft else {}),
        "other": {
            "engine": answer.engine,
            "objectives": [str(objective) for objective in answer.objectives],
            "units": None if answer.units is None else list(answer.units),
            "costs": None if answer.units is None else costs_json(problem.costs(answer.units)),
        },
    }
    files = {
        "FOON.txt": write_units(map(whole.unit, range(len(whole)))),
        "kitchen.json": json_text(kitchen),
        "utensils.txt": "".join(f"{label}\n" for label in sorted(problem.utensils)),
        "facts.lp": facts,
        **rules.files,
        "report.json": json_text(report),
    }
    if problem.rates is not None:
        files["motion.txt"] = "".join(f"{motion}\t{decimal_text(r)}\n" for motion, r in problem.rates.items())
    if problem.unit_prices is not None:
        files["unit_prices.txt"] = write_unit_prices(problem.unit_prices)
    return files


class _Rules:
    """The user's files of rules, copied: ``files`` are their texts by name, ``names`` the names by path."""

    def __init__(self) -> None:
        self.files: dict[str, str] = {}
        self.names: dict[str, str] = {}

    def copy(self, file: Constraint) -> str:
        """Give what a constraint is called in the folder; ours is called by its name, a rule by its text."""
        if not isinstance(file, Path):
            return str(file)
        if file.parent.resolve() == (encodings_folder() / "constraints").resolve():
            return file.stem
        return self._add(file, f"rules-{len(self.files) + 1}-{file.name}")

    def copy_encodings(self, folder: Path) -> str:
        """Give what replaced encodings are called in the folder."""
        if not folder.is_dir():
            return str(folder)
        for name in ENCODING_FILES:
            if (folder / name).is_file():
                self._add(folder / name, f"encodings/{name}")
        return "encodings"

    def _add(self, file: Path, name: str) -> str:
        self.files[name], self.names[str(file)] = read_encoding(file).text, name
        return name


def _version(distribution: str) -> str | None:
    try:
        return version(distribution)
    except PackageNotFoundError:
        return None
