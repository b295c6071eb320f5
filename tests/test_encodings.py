"""The encodings against their own documentation, and the ready-made constraints against a network by hand.

The files are parsed here anew, with clingo's own parser and nothing of ``foon_asp.encoding.encoding``.
"""

import ast
import re
import shlex
import subprocess
import sys
from collections.abc import Callable, Iterable, Iterator
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import NamedTuple

import pytest
from clingo import Control, Model, Number
from clingo.ast import AST, ASTSequence, ASTType, parse_files, parse_string
from clingo.symbol import SymbolType

import foon_asp
from foon_asp.asp import Settings
from foon_asp.asp.bare_program import bare_program
from foon_asp.encoding import encoding
from foon_asp.encoding.facts import FACT_PREDICATES
from foon_asp.network import UnitPrices
from foon_asp.problem import ContainerRule, Objective, Problem
from foon_asp.resources import bundled_kitchen
from foon_asp.text.data_folder import find_data, read_data
from foon_asp.text.goal_name import find_goal
from tests.conftest import Cli, Ran

FOLDER = Path(__file__).resolve().parent.parent / "encodings"
README = (FOLDER / "README.md").read_text(encoding="utf-8")
FILES = {path.relative_to(FOLDER).as_posix(): path for path in sorted(FOLDER.rglob("*.lp"))}
CONSTRAINTS = [name for name in FILES if name.startswith("constraints/")]
BASE = [FOLDER / name for name in ("task_tree.lp", "objectives.lp", "show.lp")]

Signature = tuple[str, int]


# --- What the files say.


class Parsed(NamedTuple):
    """The predicates and constants of one file; shown ones count as read."""

    heads: set[Signature]
    read: set[Signature]
    declared: set[Signature]
    constants: dict[str, str]
    kinds: set[ASTType]


@cache
def parsed(name: str) -> Parsed:
    statements: list[AST] = []
    parse_files([str(FILES[name])], statements.append)
    return survey(statements)


def survey(statements: Iterable[AST]) -> Parsed:
    found = Parsed(set(), set(), set(), {}, set())
    for statement in statements:
        found.kinds.add(statement.ast_type)
        if statement.ast_type == ASTType.Definition:
            found.constants[statement.name] = str(statement.value)
        elif statement.ast_type == ASTType.Defined:
            found.declared.add((statement.name, statement.arity))
        elif statement.ast_type == ASTType.ShowSignature:
            found.read.add((statement.name, statement.arity))
        for signature, in_head in atoms(statement, in_head=False):
            (found.heads if in_head else found.read).add(signature)
    return found


def atoms(node: AST, in_head: bool) -> Iterator[tuple[Signature, bool]]:
    """Give every atom below a node with whether it stands in a head; conditions never do."""
    if node.ast_type == ASTType.SymbolicAtom:
        symbol = node.symbol
        while symbol.ast_type == ASTType.UnaryOperation:
            symbol = symbol.argument
        yield (symbol.name, len(symbol.arguments)), in_head
        return
    for key in node.child_keys:
        child = getattr(node, key)
        opens = key == "head" or (node.ast_type == ASTType.External and key == "atom")
        closes = key == "body" or (node.ast_type == ASTType.ConditionalLiteral and key == "condition")
        here = opens or (in_head and not closes)
        for part in child if isinstance(child, ASTSequence) else [child]:
            if isinstance(part, AST):
                yield from atoms(part, here)


def files_where(holds: Callable[[Parsed], bool]) -> set[str]:
    return {name for name in FILES if holds(parsed(name))}


def mentioned(name: str) -> set[Signature]:
    found = parsed(name)
    return found.heads | found.read | found.declared


def test_survey_tells_heads_from_bodies() -> None:
    program = """
        a(X) : b(X) :- c(X), d : e(X).   { f(X) : g(X) } = 1.   1 { h : i ; j } 2 :- k.   -l(1).
        :- m, not n(1,2), 1 < #sum { X,Y : o(X,Y), not p }.   #minimize { X@1 : q(X) }.   :~ r. [1]
        #external s : t.   #show u/3.   #show v : w.   #defined x/1.   #const y = 1.
        #sum { X : z(X) : aa(X) } :- bb.   cc(dd(1)).
    """
    statements: list[AST] = []
    parse_string(program, statements.append)
    found = survey(statements)
    assert {name for name, _ in found.heads} == {"a", "f", "h", "j", "l", "s", "z", "cc"}
    assert {name for name, _ in found.read} == {*"bcdegikmnopqrtuw", "aa", "bb"}
    assert found.declared == {("x", 1)}
    assert found.constants == {"y": "1"}


# --- What is ours is told from what is the user's by its first letter.

TERMS = {"units", "inputs", "inputs_and_ingredients", "success", "kitchen"}  # of optimize/2


def functions(node: AST) -> Iterator[str]:
    """Give the names of constants and functions in terms, and those of atoms."""
    if node.ast_type == ASTType.Function:
        yield node.name
    elif node.ast_type == ASTType.SymbolicTerm and node.symbol.type is SymbolType.Function:
        yield node.symbol.name
    for key in node.child_keys:
        child = getattr(node, key)
        for part in child if isinstance(child, ASTSequence) else [child]:
            if isinstance(part, AST):
                yield from functions(part)


def test_files_of_the_users_are_held_against_what_the_headers_say() -> None:
    """The predicates that they may not define, nor take a name of, are the public ones of all headers."""
    public = {each for each in in_headers("Facts", "Input", "Output") if not each[0].startswith("_")}
    assert public == encoding.PUBLIC | encoding.EXTENDED
    assert not encoding.PUBLIC & encoding.EXTENDED
    assert {name for name, _ in public} | {each.row.term for each in Objective} == encoding.PUBLIC_NAMES


@pytest.mark.parametrize("name", FILES)
def test_every_other_name_of_ours_has_the_prefix(name: str) -> None:
    """Constants that are set, and the criteria that ``optimize/2`` switches on, are public too."""
    statements: list[AST] = []
    parse_files([str(FILES[name])], statements.append)
    named = {found for statement in statements for found in functions(statement)}
    for statement in statements:
        if statement.ast_type == ASTType.Program and statement.name != "base":
            named |= {statement.name, *(parameter.name for parameter in statement.parameters)}
    names = {predicate for predicate, _ in encoding.PUBLIC | encoding.EXTENDED}
    public = TERMS | names | parsed(name).constants.keys()
    assert not {found for found in named - public if not found.startswith("_")}


# --- What the README says.

CODE = re.compile(r"`([^`]+)`")
ATOM = re.compile(r"(_?[a-z]\w*)\(([^()]*)\)")


class Row(NamedTuple):
    """One row of the predicate table."""

    atom: str
    meaning: str
    written: set[str]
    read: set[str]


def table(heading: str) -> list[list[str]]:
    """Give the cells of the only table under a heading."""
    section = README.split(f"\n## {heading}\n", 1)[1].split("\n## ", 1)[0]
    rows = [line for line in section.splitlines() if line.startswith("|")]
    assert set(rows[1]) <= set("|- "), rows[1]
    cells = [[cell.strip() for cell in re.split(r"(?<!\\)\|", row.strip("|"))] for row in rows[2:]]
    assert all(len(row) == rows[0].count("|") - 1 for row in cells)
    return cells


def signature(atom: str) -> Signature:
    match = ATOM.fullmatch(atom)
    assert match, atom
    return match[1], match[2].count(",") + 1


@cache
def predicates() -> dict[Signature, Row]:
    rows: dict[Signature, Row] = {}
    for predicate, meaning, written, read in table("Predicates"):
        short, atom = CODE.findall(predicate)
        name, _, arity = short.partition("/")
        assert signature(atom) == (name, int(arity)), f"{short} is not {atom}"
        assert signature(atom) not in rows, f"{short} is listed twice"
        rows[signature(atom)] = Row(atom, meaning, set(CODE.findall(written)), set(CODE.findall(read)))
    return rows


def test_every_predicate_is_in_the_table_and_the_other_way_round() -> None:
    assert set(predicates()) == in_headers("Facts", "Input", "Output")
    assert set(predicates()) >= {found for name in FILES for found in mentioned(name)}
    assert all(row.meaning for row in predicates().values())


@pytest.mark.parametrize("predicate", predicates(), ids="{0[0]}/{0[1]}".format)
def test_written_by_and_read_by_are_what_the_files_say(predicate: Signature) -> None:
    row = predicates()[predicate]
    written = files_where(lambda file: predicate in file.heads)
    if predicate in by_python():
        written.add("facts")
    assert row.written == written
    assert row.read == files_where(lambda file: predicate in file.read)


# all but success, which has predicates of its own and cannot stand beside another that is rounded
OBJECTIVES = tuple(objective for objective in Objective if objective is not Objective.SUCCESS)


@pytest.mark.slow
def test_facts_are_what_the_table_says() -> None:
    """All predicates but those of the second step are printed for a bundled goal, and no others."""
    data = read_data(find_data(bundled_kitchen()))
    goal = find_goal("macaroni and cheese", data.network, data.goals)
    given = data.network, data.kitchen, (goal,), data.rates, data.utensils, ContainerRule.STRICT
    problem = Problem(*given, unit_prices=UnitPrices(dict.fromkeys(data.network.motions, Fraction(2)), {}))
    statements: list[AST] = []
    parse_string(bare_program(problem, OBJECTIVES, Settings(), {}).facts, statements.append)
    second_step = {
        predicate
        for predicate, row in predicates().items()
        if "facts" in row.written and "second step" in row.meaning
    }
    with_constraints = {
        predicate for predicate, row in predicates().items() if "only with a con" in row.meaning
    }
    assert with_constraints == {("source", 2), ("video", 2), ("price", 2)}
    for_questions = {
        predicate
        for predicate, row in predicates().items()
        if "facts" in row.written and "for questions only" in row.meaning
    }
    used_up = {
        predicate
        for predicate, row in predicates().items()
        if "facts" in row.written and "only where items are used up" in row.meaning
    }
    counts = {("_least", 2), ("_most", 2)}
    assert used_up == {("stays", 2), ("uses_up", 2), ("stock", 2)} | counts
    everything = by_python() - second_step - for_questions - counts
    assert everything == set(FACT_PREDICATES.items()) == in_headers("Facts")
    everything -= used_up
    assert survey(statements).heads == everything - with_constraints
    statements.clear()
    settings = Settings(constraints=(Path("only_sources"),))
    parse_string(bare_program(problem, OBJECTIVES, settings, {}).facts, statements.append)
    assert survey(statements).heads == everything - {("video", 2)}  # the bundled kitchen names none
    assert second_step == {("_exponent", 3), ("_product", 3), ("_seen", 1), ("_fewer", 2), ("_wanted", 1)}


def test_every_constant_is_in_the_table_with_its_own_value() -> None:
    listed: list[tuple[str, str, str]] = []
    for constant, file, value, meaning in table("Constants"):
        assert meaning
        listed.append((CODE.findall(file)[0], CODE.findall(constant)[0], CODE.findall(value)[0]))
    in_files = [(name, *constant) for name in FILES for constant in parsed(name).constants.items()]
    assert sorted(listed) == sorted(in_files)


def test_every_file_of_the_program_is_introduced() -> None:
    listed = {CODE.findall(row[0])[0] for row in table("What makes a program")}
    assert listed == {name.split("/")[0] + "/" if "/" in name else name for name in FILES}


# --- What the headers say.


@cache
def header(name: str) -> list[str]:
    """Give the comment block that opens a file, without its percent signs."""
    lines = FILES[name].read_text(encoding="utf-8").split("\n")
    end = next(number for number, line in enumerate(lines) if not line.startswith("%"))
    return [line[1:] for line in lines[:end]]


@cache
def sections(name: str) -> dict[str, str]:
    """Give the text of Purpose, Input and Output in a header, in its order."""
    found: dict[str, str] = {}
    current = ""
    for line in header(name)[1:]:
        match = re.match(r" (\w+):\s+(.+)$", line)
        if match:
            current = match[1]
            assert current not in found, f"{name}: {current} comes twice"
            found[current] = match[2]
        elif current:
            assert line == "" or line.startswith("   "), f"{name}: {line!r} belongs to no section"
            found[current] += "\n" + line.strip()
    return found


def in_headers(*names: str) -> set[Signature]:
    """Give the predicates that some sections of all headers name."""
    texts = (sections(file).get(name, "") for file in FILES for name in names)
    return {signature(match[0]) for text in texts for match in ATOM.finditer(text)}


def by_python() -> set[Signature]:
    """Give the predicates that no encoding makes: the facts of every question, and what one of them reads."""
    return in_headers("Facts") | (in_headers("Input") - in_headers("Output"))


def test_facts_are_those_of_the_headers() -> None:
    """What the Python side writes, be it in facts or in rules, by name; and it writes all of it."""
    folder = Path(foon_asp.__file__).parent
    texts = [
        constant.value
        for file in ("encoding/facts.py", "asp/integrity.py")
        for constant in ast.walk(ast.parse((folder / file).read_text(encoding="utf-8")))
        if isinstance(constant, ast.Constant) and isinstance(constant.value, str)
    ]
    written = {name for text in texts for name in re.findall(r"(?:^|\n|[ ({:])(_[a-z_]+)\(", text)}
    told = {name for name, _ in by_python() if name.startswith("_")}
    assert {name for name in written if name != "_dropped"} == told


@pytest.mark.parametrize("name", FILES)
def test_header_has_a_title_and_its_sections(name: str) -> None:
    lines = header(name)
    assert re.fullmatch(r" [A-Z].*\.", lines[0]), f"{name}: no title"
    assert lines[1] == "", f"{name}: the title is one line, with an empty comment under it"
    facts = ["Facts"] if name in {"task_tree.lp", "used_up/task_tree.lp"} else []
    assert list(sections(name)) == ["Purpose", *facts, "Input", "Output"]


@pytest.mark.parametrize("name", FILES)
def test_header_names_the_predicates_read_and_defined(name: str) -> None:
    """Input are the predicates read from elsewhere, Output those defined here, spelt as in the table."""
    found = parsed(name)
    for section, expected in {"Input": found.read - found.heads, "Output": found.heads}.items():
        text = sections(name)[section].strip()
        named = [match[0] for match in ATOM.finditer(text)]
        assert sorted(map(signature, named)) == sorted(expected), f"{name}: {section}"
        assert (text == "(none)") == (not expected), f"{name}: {section}"
        assert [predicates()[signature(atom)].atom for atom in named] == named, f"{name}: {section}"


@pytest.mark.parametrize("name", FILES)
def test_header_examples_set_the_constants_of_the_file(name: str) -> None:
    examples = re.findall(r"-c (\w+)=", "\n".join(header(name)))
    assert sorted(examples) == sorted(parsed(name).constants)


@pytest.mark.parametrize("name", FILES)
def test_declared_predicates_are_used(name: str) -> None:
    assert parsed(name).declared <= parsed(name).read


# --- What may not be in the folder.


def test_no_python_in_the_folder() -> None:
    assert not [*FOLDER.rglob("*.py*"), *FOLDER.rglob("__pycache__")]


def test_only_plain_statements() -> None:
    shows = {ASTType.ShowSignature, ASTType.ShowTerm}
    assert files_where(lambda file: bool(shows & file.kinds)) == {"show.lp", "used_up/show.lp"}
    questions = {name for name in FILES if name.startswith("questions/")}
    narrowing = {
        "questions/assist.lp",
        "questions/at_most.lp",
        "questions/bounded_plans.lp",
        "questions/loose_ends.lp",
        "questions/other_trees.lp",
        "questions/required.lp",
        "questions/second_opinion.lp",
    }  # what is best is not theirs to say
    assert (
        files_where(lambda file: ASTType.Minimize in file.kinds)
        == {"objectives.lp", "used_up/objectives.lp"} | questions - narrowing
    )
    assert not files_where(lambda file: ASTType.Script in file.kinds)


# --- The ready-made constraints, in bare clingo.
#
#   slice:  apple, clean knife   → slices, knife
#   wash 1: apple                → washed apple
#   crank:  washed apple         → slices, peel
#   wash 2: knife                → rinsed knife
#
# Apple and knife are at hand, slices are wanted. A tree slices or cranks, and to crank it washes the apple.

KITCHEN_TABLE = """
    unit(1). motion(1,"slice"). input(1,(1;2)). needs(1,(1;2)). output(1,(4;2)). gives(1,(4;2)).
    unit(2). motion(2,"wash").  input(2,1).     needs(2,1).     output(2,3).     gives(2,3).
    unit(3). motion(3,"crank"). input(3,3).     needs(3,3).     output(3,(4;5)). gives(3,(4;5)).
    unit(4). motion(4,"wash").  input(4,2).     needs(4,2).     output(4,6).     gives(4,6).
    object(1..6). kitchen(1..2). goal(4).
    label((1;3),"apple"). label((2;6),"knife"). label(4,"slices"). label(5,"peel").
    state(2,"clean"). state(3,"washed"). state(6,"rinsed").
    ingredient(5,"pectin"). utensil("knife").
    source(1..3,"a.txt"). source(4,"b.txt"). source(2..3,"video").
    inputs(1,2). inputs(2..4,1). ingredients(1..4,0). risk(1..4,1).
    rate((1;2;4),500000). rate(3,400000).
    price(1,300). price(2..3,100). video(2..3,"one"). video(3,"two").
    optimize(units,1).
"""
SLICE, WASH_APPLE, CRANK, WASH_KNIFE = 1, 2, 3, 4
Tree = frozenset[int]
CRANKED: Tree = frozenset({WASH_APPLE, CRANK})
SLICED: Tree = frozenset({SLICE})
WASHES: Tree = frozenset({WASH_APPLE, WASH_KNIFE})
TREES = {
    SLICED,
    SLICED | {WASH_APPLE},
    SLICED | {WASH_KNIFE},
    SLICED | {WASH_APPLE, WASH_KNIFE},
    SLICED | CRANKED,
    SLICED | CRANKED | {WASH_KNIFE},
    CRANKED,
    CRANKED | {WASH_KNIFE},
}


def clingo(files: Iterable[Path], constants: dict[str, str], facts: str, *options: str) -> list[Tree]:
    """Give the answers of clingo in its order; fails at any message of clingo's."""
    messages: list[str] = []
    arguments = [argument for item in constants.items() for argument in ("-c", "=".join(item))]
    control = Control([*arguments, *options], logger=lambda _, text: messages.append(text))
    for file in files:
        control.load(str(file))
    control.add("base", [], facts)
    control.ground([("base", [])])
    assert not messages
    trees: list[Tree] = []

    def note(model: Model) -> None:
        trees.append(frozenset(symbol.arguments[0].number for symbol in model.symbols(shown=True)))

    control.solve(on_model=note)
    assert not messages
    return trees


def all_trees(files: Iterable[Path], constants: dict[str, str], facts: str = KITCHEN_TABLE) -> list[Tree]:
    return clingo(files, constants, facts, "--models=0", "--opt-mode=ignore")


class Case(NamedTuple):
    """One setting of a constraint: which of the trees are left, and the smallest of them."""

    constraint: str
    constants: dict[str, str]
    keeps: Callable[[Tree], bool]
    best: Tree | None


CASES = [
    Case(
        "at_most_motion",
        {"limited_motion": '"wash"', "max_uses": "1"},
        lambda t: not t.issuperset(WASHES),
        SLICED,
    ),
    Case("at_most_motion", {"limited_motion": '"wash"', "max_uses": "0"}, lambda t: t == SLICED, SLICED),
    Case("at_most_motion", {"limited_motion": '"slice"', "max_uses": "0"}, lambda t: SLICE not in t, CRANKED),
    Case("at_most_motion", {"limited_motion": '"bake"', "max_uses": "0"}, lambda _: True, SLICED),
    Case("at_most_motion", {"limited_motion": '"wash"'}, lambda _: True, SLICED),
    Case("at_most_motion", {"max_uses": "0"}, lambda _: True, SLICED),
    Case("at_most_units", {"max_units": "4"}, lambda _: True, SLICED),
    Case("at_most_units", {"max_units": "2"}, lambda t: len(t) <= 2, SLICED),
    Case("at_most_units", {"max_units": "1"}, lambda t: t == SLICED, SLICED),
    Case("at_most_units", {"max_units": "0"}, lambda _: False, None),
    Case("forbid_motion", {"forbidden_motion": '"slice"'}, lambda t: SLICE not in t, CRANKED),
    Case("forbid_motion", {"forbidden_motion": '"wash"'}, lambda t: t == SLICED, SLICED),
    Case("forbid_motion", {"forbidden_motion": '"bake"'}, lambda _: True, SLICED),
    Case("forbid_object", {"forbidden_object": '"knife"'}, lambda t: t == CRANKED, CRANKED),
    Case("forbid_object", {"forbidden_object": '"peel"'}, lambda t: CRANK not in t, SLICED),
    Case("forbid_object", {"forbidden_object": '"apple"'}, lambda _: False, None),
    Case("forbid_object", {"forbidden_object": '"oven"'}, lambda _: True, SLICED),
    Case("require_object", {"required_object": '"knife"'}, lambda t: bool({SLICE, WASH_KNIFE} & t), SLICED),
    Case("require_object", {"required_object": '"peel"'}, lambda t: CRANK in t, CRANKED),
    Case("require_object", {"required_object": '"oven"'}, lambda _: False, None),
    Case("forbid_ingredient", {"forbidden_ingredient": '"pectin"'}, lambda t: CRANK not in t, SLICED),
    Case("forbid_ingredient", {"forbidden_ingredient": '"knife"'}, lambda t: t == CRANKED, CRANKED),
    Case("forbid_ingredient", {"forbidden_ingredient": '"slices"'}, lambda _: False, None),
    Case("require_ingredient", {"required_ingredient": '"pectin"'}, lambda t: CRANK in t, CRANKED),
    Case("require_ingredient", {"required_ingredient": '"knife"'}, lambda t: t != CRANKED, SLICED),
    Case("require_ingredient", {"required_ingredient": '"salt"'}, lambda _: False, None),
    Case("require_intermediate", {"required_intermediate": '"apple"'}, lambda t: t >= CRANKED, CRANKED),
    Case("require_intermediate", {"required_intermediate": '"knife"'}, lambda _: False, None),
    Case("at_most_utensils", {"max_utensils": "0"}, lambda t: t == CRANKED, CRANKED),
    Case("at_most_utensils", {"max_utensils": "1"}, lambda _: True, SLICED),
    Case("least_rate", {"least_rate": "400000"}, lambda _: True, SLICED),
    Case("least_rate", {"least_rate": "400001"}, lambda t: CRANK not in t, SLICED),
    Case("least_rate", {"least_rate": "500001"}, lambda _: False, None),
    Case("only_sources", {"allowed_source": '"a.txt"'}, lambda t: WASH_KNIFE not in t, SLICED),
    Case("only_sources", {"allowed_source": '"video"'}, lambda t: t == CRANKED, CRANKED),
    Case("only_sources", {"allowed_source": '"c.txt"'}, lambda _: False, None),
    Case("before", {"earlier_motion": '"wash"', "later_motion": '"crank"'}, lambda _: True, SLICED),
    Case(
        "before", {"earlier_motion": '"slice"', "later_motion": '"crank"'}, lambda t: CRANK not in t, SLICED
    ),
    Case(
        "before", {"earlier_motion": '"wash"', "later_motion": '"slice"'}, lambda t: SLICE not in t, CRANKED
    ),
    Case("before", {"earlier_motion": '"wash"'}, lambda _: True, SLICED),
    Case("before", {"later_motion": '"slice"'}, lambda _: True, SLICED),
    Case(
        "not_both_motions",
        {"one_motion": '"slice"', "other_motion": '"wash"'},
        lambda t: SLICE not in t or not WASHES & t,
        SLICED,
    ),
    Case("not_both_motions", {"one_motion": '"slice"', "other_motion": '"bake"'}, lambda _: True, SLICED),
    Case("not_both_motions", {"one_motion": '"slice"'}, lambda _: True, SLICED),
    Case("not_both_motions", {"other_motion": '"slice"'}, lambda _: True, SLICED),
    Case(
        "at_most_utensil_uses",
        {"limited_utensil": '"knife"', "max_utensil_uses": "1"},
        lambda t: not t.issuperset({SLICE, WASH_KNIFE}),
        SLICED,
    ),
    Case(
        "at_most_utensil_uses",
        {"limited_utensil": '"knife"', "max_utensil_uses": "0"},
        lambda t: t == CRANKED,
        CRANKED,
    ),
    Case("at_most_utensil_uses", {"limited_utensil": '"knife"'}, lambda _: True, SLICED),
    Case("at_most_utensil_uses", {"max_utensil_uses": "0"}, lambda _: True, SLICED),
    Case(
        "motion_only_with",
        {"tied_motion": '"crank"', "tied_utensil": '"knife"'},
        lambda t: CRANK not in t,
        SLICED,
    ),
    Case(
        "motion_only_with",
        {"tied_motion": '"wash"', "tied_utensil": '"knife"'},
        lambda t: WASH_APPLE not in t,
        SLICED,
    ),
    Case(
        "motion_only_with",
        {"tied_motion": '"crank"', "tied_utensil": '"peel"'},
        lambda _: True,
        SLICED,
    ),
    Case("motion_only_with", {"tied_motion": '"slice"'}, lambda _: True, SLICED),
    Case("motion_only_with", {"tied_utensil": '"oven"'}, lambda _: True, SLICED),
    Case("never_heated", {"unheated_ingredient": '"apple"'}, lambda _: True, SLICED),
    Case(
        "at_most_price",
        {"max_price": "300"},
        lambda t: t in {SLICED, CRANKED},
        SLICED,
    ),
    Case("at_most_price", {"max_price": "299"}, lambda t: t == CRANKED, CRANKED),
    Case("at_most_price", {"max_price": "500"}, lambda t: WASH_KNIFE not in t, SLICED),
    Case("at_most_price", {"max_price": "199"}, lambda _: False, None),
    Case("at_least_videos", {"least_videos": "1"}, lambda t: t == CRANKED, CRANKED),
    Case("at_least_videos", {"least_videos": "2"}, lambda _: False, None),
    Case("at_least_videos", {"least_videos": "0"}, lambda _: True, SLICED),
    Case("require_motion", {"required_motion": '"crank"'}, lambda t: CRANK in t, CRANKED),
    Case("require_motion", {"required_motion": '"wash"'}, lambda t: bool(WASHES & t), CRANKED),
    Case("require_motion", {"required_motion": '"slice"'}, lambda t: SLICE in t, SLICED),
    Case("require_motion", {"required_motion": '"bake"'}, lambda _: False, None),
]


def test_trees_of_the_network_by_hand() -> None:
    trees = all_trees(BASE, {})
    assert len(trees) == len(TREES)
    assert set(trees) == TREES


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case.constraint} {case.constants}")
def test_constraint_does_what_it_says(case: Case) -> None:
    files = [*BASE, FILES[f"constraints/{case.constraint}.lp"]]
    assert set(all_trees(files, case.constants)) == {tree for tree in TREES if case.keeps(tree)}
    best = clingo(files, case.constants, KITCHEN_TABLE)
    if case.best is None:
        assert best == []
    else:
        assert len(best[-1]) == len(case.best)
        assert case.keeps(best[-1])


@pytest.mark.parametrize("name", CONSTRAINTS)
def test_constraint_has_cases_and_without_its_constants_no_effect(name: str) -> None:
    assert set(all_trees([*BASE, FILES[name]], {})) == TREES
    cases = [case for case in CASES if FILES[name].stem == case.constraint]
    assert {constant for case in cases for constant in case.constants} == set(parsed(name).constants)
    assert all(value in {'""', "#sup", "#inf"} for value in parsed(name).constants.values())


def test_constraints_do_not_disturb_each_other() -> None:
    assert set(all_trees([*BASE, *(FILES[name] for name in CONSTRAINTS)], {})) == TREES


@pytest.mark.parametrize(
    ("constraint", "facts", "left"),
    [
        ("forbid_ingredient", 'allergen("pectin"). allergen("salt").', {t for t in TREES if CRANK not in t}),
        ("only_sources", 'allowed("b.txt"). allowed("a.txt").', TREES),
        ("only_sources", 'allowed("b.txt"). allowed("video").', {t for t in TREES if SLICE not in t}),
        ("never_heated", 'heats("crank").', {t for t in TREES if CRANK not in t}),
    ],
)
def test_lists_are_facts_of_a_file_beside_the_constraint(
    constraint: str, facts: str, left: set[Tree]
) -> None:
    constants = {"unheated_ingredient": '"apple"'} if constraint == "never_heated" else {}
    files = [*BASE, FILES[f"constraints/{constraint}.lp"]]
    assert set(all_trees(files, constants, KITCHEN_TABLE + facts)) == left


@pytest.mark.parametrize("ingredient", ["apple", "pectin", "knife"])
def test_motions_that_heat_are_those_that_the_header_names(ingredient: str) -> None:
    """With crank, whose inputs are apples, called by each motion in turn."""
    name = "constraints/never_heated.lp"
    listed = re.search(r"heat are (.*?)\. For others", sections(name)["Purpose"], re.DOTALL)
    assert listed
    motions = re.split(r",\s+", " ".join(listed[1].split()))
    assert len(motions) == len(set(motions)) > 20
    program = FILES[name].read_text(encoding="utf-8").split("\n\n", 1)[1]
    facts = re.findall(r'heats\("(.*?)"\)\.', program)
    assert sorted(facts) == sorted(motions)
    kept = {t for t in TREES if CRANK not in t} if ingredient == "apple" else TREES
    for motion in ("bake", "stir and melt", "preheat"):
        table_ = KITCHEN_TABLE.replace('"crank"', f'"{motion}"')
        left = all_trees([*BASE, FILES[name]], {"unheated_ingredient": f'"{ingredient}"'}, table_)
        assert set(left) == (TREES if motion == "preheat" else kept)


def test_bare_clingo_wants_quotes_as_the_readme_says() -> None:
    files = [*BASE, FILES["constraints/forbid_motion.lp"]]
    assert """`-c forbidden_motion='"fry"'`""" in README
    assert set(all_trees(files, {"forbidden_motion": "slice"})) == TREES
    assert set(all_trees(files, {"forbidden_motion": '"slice"'})) == {CRANKED, CRANKED | {WASH_KNIFE}}


def test_exact_success_rules_out_seen_products_and_keeps_the_wanted_one() -> None:
    """With the rate of slice 2/3 and of all others 1/2, factors 0 and 1 being 2 and 3."""

    def trees(product: int, facts: str) -> set[Tree]:
        control = Control(["--models=0", "--opt-mode=ignore"])
        for file in (*BASE, FILES["exact_success.lp"]):
            control.load(str(file))
        control.add("base", [], KITCHEN_TABLE + exponents + facts)
        control.ground([("base", []), ("_product", [Number(product)])])
        found: set[Tree] = set()

        def model(model: Model) -> None:
            found.add(frozenset(atom.arguments[0].number for atom in model.symbols(shown=True)))

        control.solve(on_model=model)
        return found

    exponents = "_exponent(1,0,1). _exponent(1,1,-1). _exponent(2..4,0,-1)."
    sliced, quarter = "_product(0,0,1). _product(0,1,-1).", "_product(7,0,-2). _product(7,1,0)."
    third = "_product(2,0,0). _product(2,1,-1)."
    assert trees(0, sliced) == TREES
    assert trees(0, sliced + "_seen(0).") == TREES - {SLICED}
    assert trees(7, quarter + "_seen(7).") == TREES - {CRANKED}
    assert trees(
        7, quarter + f"_seen(7). _fewer(7,{len(CRANKED)}). _fewer(8,{len(CRANKED) + 1})."
    ) == TREES - {CRANKED}
    assert trees(7, quarter + f"_seen(7). _fewer(7,{len(CRANKED) + 1}).") == TREES
    assert trees(2, third + "_wanted(2).") == {SLICED | {WASH_APPLE}, SLICED | {WASH_KNIFE}}


# --- The commands of the README.


def quietly(ran: Ran) -> str:
    """Give the output of a command that ended with 0 and had nothing to say on stderr."""
    assert (ran.code, ran.err) == (0, "")
    return ran.out


@pytest.mark.sampled(4)
@pytest.mark.parametrize("name", CONSTRAINTS)
def test_example_call_changes_the_tree(
    name: str, cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    motions = (bundled_kitchen() / "motion.txt").read_text().splitlines()
    prices = {line.partition("\t")[0]: "0.5" for line in motions} | {"crush": "1.51"}
    Path("prices.txt").write_text("".join(f"{motion}\t{price}\n" for motion, price in prices.items()))
    rows = {CODE.findall(row[0])[0]: row for row in table("Ready-made constraints")}
    assert sorted(rows) == CONSTRAINTS
    program, *words = shlex.split(CODE.findall(rows[name][2])[-1])
    assert program == "foon-asp"
    assert words[words.index("--constraint") + 1] == FILES[name].stem
    settings = [words[at + 1].partition("=")[0] for at, word in enumerate(words) if word == "-c"]
    assert sorted(settings) == sorted(parsed(name).constants)
    unconstrained = words[: words.index("--constraint")]
    if name in {"constraints/at_least_videos.lp", "constraints/never_heated.lp"}:
        # the bundled kitchen names no videos, and what is heated in it has to be
        assert (cli(*words).code, cli(*unconstrained).code) == (1, 0)
        return
    # without reductions, so that of several best trees the same one is found
    calls = ([*call, "--reduce", "none", "--format", "foon"] for call in (words, unconstrained))
    constrained, free = (quietly(cli(*call)) for call in calls)
    if name == "constraints/only_sources.lp":  # the bundled kitchen has one file: it is all or nothing
        assert cli(*unconstrained, "--constraint", "only_sources", "-c", "allowed_source=x.txt").code == 1
    else:
        assert constrained != free


def test_readme_session(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, cli: Cli) -> None:
    """What the README shows of writing a constraint works as shown, through clingo's own command."""
    monkeypatch.chdir(tmp_path)
    constraint = README.split("```clingo\n", 1)[1].split("```", 1)[0]
    assert constraint.count("\n") == 5
    (tmp_path / "mine.lp").write_text(constraint, encoding="utf-8")
    optima: list[int] = []
    for block in re.findall(r"```sh\n(.*?)```", README, re.S):
        for line in block.splitlines():
            command, _, target = line.partition(" > ")
            program, *words = shlex.split(command, comments=True)
            if program == "foon-asp":
                output = quietly(cli(*words))
                found = re.search(r"(\d+) units", output)
                if words[0] == "solve" and found:
                    optima.append(int(found[1]))
            else:
                assert program == "python"
                output = subprocess.run(
                    [sys.executable, *words], capture_output=True, text=True, check=True
                ).stdout
                assert "OPTIMUM FOUND" in output
                optima.append(int(re.findall(r"Optimization: (\d+)", output)[-1]))
            if target:
                (tmp_path / target).write_text(output, encoding="utf-8")
    assert optima == [2, 7, 7, 0]  # the last one is a penalty


@pytest.mark.parametrize(
    ("rule", "objective"),
    [
        ('inputs(U,9) :- motion(U,"crush").', "inputs"),
        ('ingredients(U,9) :- motion(U,"crush").', "inputs+ingredients"),
        ('risk(U,99999999) :- motion(U,"pound").', "success"),
        ("optimize(inputs,5).", "units"),
        ("_wanted(0). _product(0,0,9). _exponent(U,0,9) :- unit(U).", "success"),
    ],
    ids=["inputs", "ingredients", "risk", "optimize", "wanted"],
)
def test_a_constraint_does_not_change_what_is_measured(
    rule: str, objective: str, tmp_path: Path, cli: Cli
) -> None:
    """Written into the predicates of objectives, it is the user's fault, and no claim is made."""
    (tmp_path / "mine.lp").write_text(rule, encoding="utf-8")
    ran = cli("solve", "--goal", "ice", "--objective", objective, "--constraint", tmp_path / "mine.lp")
    assert (ran.code, ran.out) == (2, "")
