"""The catalog of questions against the questions: names, options, parameters, help."""

import ast
import importlib
import inspect
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import foon_asp
from foon_asp.cli.verbs import VERBS
from foon_asp.questions import contract, index
from foon_asp.questions.contract import Option, Part, Question
from foon_asp.questions.index import INDEX, module_name, question_name
from foon_asp.questions.result import Result
from tests.conftest import Cli

FACE = Path(foon_asp.__file__)
QUESTIONS = FACE.parent / "questions"
# what stands beside the questions in their room
BESIDE = {
    "__init__",
    "answer",
    "answer_and_more",
    "arguments",
    "caller",
    "contract",
    "each",
    "in_hand",
    "docstring",
    "cross_check",
    "index",
    "options",
    "posing",
    "result",
    "searching",
    "solve_soft",
    "tree",
}
# what a plain `solve` may import of ours, room by room: what it reads, cuts and shows needs no more, and each
# module costs every start
MAY_BE_LOADED = """
asp: assembly optimum outcome postconditions prepared program settings solver
bounds: coprime_base hypergraph landmark_cuts lexicographic
cli: asking click_option exit_code held main named_path options output output_file progress
    question_command verbs weighted_files whole_process
dataset: dataset items names nearby_optimum paths reading
document: json_document
encoding: own_encodings
grounding: stated
network: counted functional_unit level network node_pattern object_node source spelling
    starting task_tree unit_prices
problem: containers costs items number objective order problem progress relevance restriction trait
proof: simulation
questions: answer arguments caller contract docstring in_hand index options posing result solve
reduce: derivation dominance exact_costs extension forced graph narrow near reduction reductions
    support upper_bound wide within_reach
report: answer
rules: constraint
text: assumed_goals bytes_read clean_line data_folder diagnostics exact_price goal_name grammar item_list
    json_fault json_list json_node json_object json_value label_list line line_parser listed_unit
    motion_times object_list
    plain_file provenance rate_table reader stated_prices table_rows unit_price_list writer
"""
ALONE = {"deadline", "errors", "escapes", "garbage", "resources", "typed", "warning"}
# parameters that the command line has no option for: it has them from elsewhere
PYTHON_ONLY = {"problem", "foon", "about", "data", "left", "right", "reporter", "cancel", "on_progress"}


def function_of(verb: str) -> Callable[..., Result]:
    module = importlib.import_module(f"foon_asp.questions.{module_name(verb)}")
    found: Callable[..., Result] = getattr(module, question_name(verb))
    return found


def question_of(verb: str) -> Question:
    return contract.question_of(function_of(verb))


def parameters(verb: str) -> dict[str, inspect.Parameter]:
    return dict(inspect.signature(question_of(verb).command).parameters)


def asked_for(verb: str) -> dict[str, Option]:
    parts = Part.QUESTION | Part.COMMAND
    return {option.name: option for option in question_of(verb).options if option.part & parts}


def test_every_file_is_in_the_index() -> None:
    files = {path.stem for path in QUESTIONS.iterdir() if path.stem != "__pycache__"}
    assert files - BESIDE == {module_name(verb) for verb in INDEX}


def test_the_index_imports_nothing_of_ours() -> None:
    tree = ast.parse(Path(index.__file__).read_text())
    names = [n.module for n in ast.walk(tree) if isinstance(n, ast.ImportFrom)]
    assert not [name for name in names if name is None or name.startswith("foon_asp")]


@pytest.mark.parametrize("verb", INDEX)
def test_a_question_is_a_verb(verb: str) -> None:
    assert verb in VERBS
    assert isinstance(question_of(verb), Question)


@pytest.mark.parametrize("verb", INDEX)
def test_options_are_parameters(verb: str) -> None:
    options = question_of(verb).options
    posed = {each.name for each in options if each.part is Part.PROBLEM and each.positional}
    taken = {name for name in parameters(verb) if name not in PYTHON_ONLY}
    taken -= posed  # what is read to pose the problem comes before the options
    assert set(asked_for(verb)) in (taken, taken - {"time_limit"})  # which every function takes in Python


@pytest.mark.parametrize("verb", INDEX)
def test_defaults_are_the_same(verb: str) -> None:
    def plain(value: Any) -> Any:
        return tuple(value.split(" ")) if isinstance(value, str) else value or None

    for name, option in asked_for(verb).items():
        default = parameters(verb)[name].default
        if option.positional and not option.many:
            assert default is inspect.Parameter.empty, name
        elif option.many:
            assert plain(option.default) == plain(default), name
        else:
            assert (option.default or None) == (default or None), name


@pytest.mark.parametrize("verb", INDEX)
def test_a_command_has_what_python_has(verb: str) -> None:
    theirs = inspect.signature(function_of(verb)).parameters
    for name in theirs.keys() - PYTHON_ONLY - ({"time_limit"} - parameters(verb).keys()):
        assert parameters(verb)[name].default == theirs[name].default, name


@pytest.mark.parametrize("verb", INDEX)
def test_an_option_has_a_sentence_of_help(verb: str) -> None:
    for option in question_of(verb).options:
        assert option.help[0].isupper(), option.name
        assert option.help.endswith("."), option.name


@pytest.mark.parametrize("verb", INDEX)
def test_help_begins_with_the_line_of_the_index(verb: str, cli: Cli) -> None:
    ran = cli(verb, "--help")
    assert ran.code == 0
    assert INDEX[verb].line in " ".join(ran.out.split())
    assert f"foon-asp {verb}" in ran.out
    assert "xits with 0" in ran.out


@pytest.mark.parametrize("verb", INDEX)
def test_text_parameters_are_those_of_the_text(verb: str) -> None:
    text = [option.name for option in question_of(verb).options if option.part & Part.TEXT]
    result = inspect.signature(function_of(verb)).return_annotation
    assert text == [name for name in inspect.signature(result.text).parameters if name != "self"]


def test_public_names_are_those_that_type_checkers_see() -> None:
    (guarded,) = [
        node
        for node in ast.parse(FACE.read_text()).body
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"
    ]
    seen = {
        alias.name: node.module
        for node in guarded.body
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    assert set(seen) == set(foon_asp.__all__)
    for name, module in seen.items():
        assert getattr(foon_asp, name) is getattr(importlib.import_module(str(module)), name)


def test_help_of_all_imports_no_question() -> None:
    code = (
        "import sys; from foon_asp.cli.main import cli\n"
        "try: cli.main(['--help'], standalone_mode=False)\n"
        "finally: print(sorted(m for m in sys.modules if m.startswith('foon_asp.questions.')))"
    )
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert ran.stdout.splitlines()[-1] == "['foon_asp.questions.index']"


def test_solve_imports_what_a_plain_answer_needs() -> None:
    code = (
        "import sys; from foon_asp.cli.main import main\n"
        "try: main(['solve', '--goal', 'ice'])\n"
        "except SystemExit: print(sorted(sys.modules))"
    )
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = set(ast.literal_eval(ran.stdout.splitlines()[-1]))
    assert "foon_asp.questions.solve" in loaded
    ours = {name.removeprefix("foon_asp.") for name in loaded if name.startswith("foon_asp.")}
    may = set(ALONE)
    for room, names in re.findall(r"^(\w+): ((?:\w+\s+)+)", MAY_BE_LOADED, re.MULTILINE):
        assert room in ours
        may |= {room, *(f"{room}.{name}" for name in names.split())}
    assert ours <= may
    others = {name.partition(".")[0] for name in loaded} - {*sys.stdlib_module_names}
    assert others <= {"foon_asp", "click", "__main__", "_distutils_hack"}  # the last is of setuptools
    assert not loaded & {"asyncio", "difflib", "sqlite3", "subprocess", "importlib.metadata"}
