"""The encodings against their own documentation, and the ready-made constraints against a network by hand.

The files are parsed here anew, with clingo's own parser and nothing of ``foon_asp.encoding.encoding``.
"""

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
from clingo import Control, Model
from clingo.ast import AST, ASTSequence, ASTType, parse_files, parse_string
from clingo.symbol import SymbolType

from foon_asp.asp import Settings
from foon_asp.asp.bare_program import bare_program
from foon_asp.encoding import encoding
from foon_asp.encoding.parsing import nodes
from foon_asp.network import UnitPrices
from foon_asp.problem import ContainerRule, Objective, Problem
from foon_asp.resources import bundled_kitchen
from foon_asp.text.data_folder import find_data, read_data
from foon_asp.text.node_lookup import find_goal
from tests.conftest import ROOT, Cli, Ran

FOLDER = ROOT / "encodings"
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


# --- What is ours is told from what is the user's by its first letter.

TERMS = {"units", "inputs", "inputs_and_ingredients", "success", "kitchen"}  # of optimize/2


def functions(statement: AST) -> Iterator[str]:
    """Give the names of constants and functions in terms, and those of atoms."""
    for node in nodes(statement):
        if node.ast_type == ASTType.Function:
            yield node.name
        elif node.ast_type == ASTType.SymbolicTerm and node.symbol.type is SymbolType.Function:
            yield node.symbol.name


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


def test_facts_are_what_the_table_says() -> None:
    """Those that every question has are printed for a bundled goal, and no others."""
    data = read_data(find_data(bundled_kitchen()))
    goal = find_goal("ice", data.network, data.goals)
    given = data.network, data.kitchen, (goal,), data.rates, data.utensils, ContainerRule.STRICT
    problem = Problem(*given, unit_prices=UnitPrices(dict.fromkeys(data.network.motions, Fraction(2)), {}))

    def printed(settings: Settings) -> set[Signature]:
        statements: list[AST] = []
        parse_string(bare_program(problem, OBJECTIVES, settings, {}).facts, statements.append)
        return survey(statements).heads

    conditions = {
        words: {each for each, row in predicates().items() if words in row.meaning}
        for words in ("only with a con", "second step", "for questions only", "only where items are used up")
    }
    always = {("_least", 2), ("_most", 2)}.union(*conditions.values())
    assert printed(Settings()) == by_python() - always
    of_constraints = conditions["only with a con"]
    assert of_constraints == {("source", 2), ("video", 2), ("price", 2)}
    settings = Settings(constraints=(Path("only_sources"),))
    assert printed(settings) == by_python() - always | of_constraints - {
        ("video", 2)
    }  # of which there is none


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


def test_only_plain_statements() -> None:
    shows = {ASTType.ShowSignature, ASTType.ShowTerm}
    assert files_where(lambda file: bool(shows & file.kinds)) == {"show.lp", "used_up/show.lp"}
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


def all_trees(files: Iterable[Path], *constants: str, facts: str = KITCHEN_TABLE) -> list[Tree]:
    """Give the answers of clingo in its order; fails at any message of clingo's."""
    messages: list[str] = []
    options = [f"-c{constant}" for constant in constants]
    control = Control(
        [*options, "--models=0", "--opt-mode=ignore"], logger=lambda _, text: messages.append(text)
    )
    for file in files:
        control.load(str(file))
    control.add("base", [], facts)
    control.ground([("base", [])])
    trees: list[Tree] = []

    def note(model: Model) -> None:
        trees.append(frozenset(symbol.arguments[0].number for symbol in model.symbols(shown=True)))

    control.solve(on_model=note)
    assert not messages
    return trees


def test_trees_of_the_network_by_hand() -> None:
    trees = all_trees(BASE)
    assert len(trees) == len(TREES)
    assert set(trees) == TREES


# What random trees do not show, against brute force; lists are facts of a file beside the constraint.
CASES: list[tuple[str, str, str, Callable[[Tree], bool]]] = [
    ("forbid_ingredient", 'forbidden_ingredient="knife"', "goal(2).", lambda _: False),
    ("forbid_ingredient", "", 'allergen("pectin"). allergen("salt").', lambda t: CRANK not in t),
    ("only_sources", 'allowed_source="video"', "", lambda t: t == CRANKED),
    ("only_sources", "", 'allowed("b.txt"). allowed("a.txt").', lambda _: True),
    ("at_most_price", "max_price=300", "", lambda t: t in {SLICED, CRANKED}),
    ("at_most_price", "max_price=299", "", lambda t: t == CRANKED),
    ("at_least_videos", "least_videos=1", "", lambda t: t == CRANKED),
    ("at_least_videos", "least_videos=2", "", lambda _: False),
    ("at_most_utensils", "max_utensils=0", 'utensil("peel").', lambda _: False),
    ("motion_only_with", 'tied_motion="crank" tied_utensil="peel"', "", lambda _: True),
    ("never_heated", 'unheated_ingredient="apple"', "", lambda _: True),
    (
        "never_heated",
        'unheated_ingredient="salt"',
        'ingredient(3,"salt"). heats("crank").',
        lambda t: CRANK not in t,
    ),
]


@pytest.mark.parametrize(("constraint", "constants", "facts", "keeps"), CASES)
def test_constraint_does_what_it_says(
    constraint: str, constants: str, facts: str, keeps: Callable[[Tree], bool]
) -> None:
    files = [*BASE, FILES[f"constraints/{constraint}.lp"]]
    found = all_trees(files, *constants.split(), facts=KITCHEN_TABLE + facts)
    assert set(found) == {tree for tree in TREES if keeps(tree)}


@pytest.mark.parametrize("name", CONSTRAINTS)
def test_constraint_without_one_of_its_constants_has_no_effect(name: str) -> None:
    constants = parsed(name).constants
    assert {*constants.values()} <= {'""', "#sup", "#inf"}
    settings = [f'{name}="wash"' if own == '""' else f"{name}=0" for name, own in constants.items()]
    for set_ in ([], *([one] for one in settings if len(settings) > 1)):
        assert set(all_trees([*BASE, FILES[name]], *set_)) == TREES


def test_constraints_do_not_disturb_each_other() -> None:
    assert set(all_trees([*BASE, *(FILES[name] for name in CONSTRAINTS)])) == TREES


def test_motions_that_heat_are_those_that_the_header_names() -> None:
    name = "constraints/never_heated.lp"
    listed = re.search(r"heat are (.*?)\. For others", sections(name)["Purpose"], re.DOTALL)
    assert listed
    program = FILES[name].read_text(encoding="utf-8").split("\n\n", 1)[1]
    facts = re.findall(r'heats\("(.*?)"\)\.', program)
    assert sorted(facts) == sorted(re.split(r",\s+", " ".join(listed[1].split())))


def test_bare_clingo_wants_quotes_as_the_readme_says() -> None:
    files = [*BASE, FILES["constraints/forbid_motion.lp"]]
    assert """`-c forbidden_motion='"fry"'`""" in README
    assert set(all_trees(files, "forbidden_motion=slice")) == TREES
    assert set(all_trees(files, 'forbidden_motion="slice"')) == {CRANKED, CRANKED | {WASH_KNIFE}}


# --- The commands of the README.


def quietly(ran: Ran) -> str:
    """Return the output of a command that ended with 0 and had no warning on stderr."""
    assert ran.code == 0
    assert all(line.startswith("note: ") for line in ran.err.splitlines()), ran.err
    return ran.out


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
    _, *words = shlex.split(CODE.findall(rows[name][2])[-1])
    assert words[words.index("--constraint") + 1] == FILES[name].stem
    settings = [words[at + 1].partition("=")[0] for at, word in enumerate(words) if word == "-c"]
    assert sorted(settings) == sorted(parsed(name).constants)
    # without reductions, so that of several best trees the same one is found
    calls = words, words[: words.index("--constraint")]
    constrained, free = (cli(*call, "--reduce", "none", "--format", "foon") for call in calls)
    assert free.code == 0
    if name != "constraints/only_sources.lp":  # the bundled kitchen has one file: it is all or nothing
        assert constrained.code in {0, 1}
        assert constrained.out != free.out


def test_readme_session(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, cli: Cli) -> None:
    """What the README shows of writing a constraint works as shown, through clingo's own command."""
    monkeypatch.chdir(tmp_path)
    Path("mine.lp").write_text(README.split("```clingo\n", 1)[1].split("```", 1)[0], encoding="utf-8")
    optima: list[int] = []
    for line in "".join(re.findall(r"```sh\n(.*?)```", README, re.S)).splitlines():
        command, _, target = line.partition(" > ")
        program, *words = shlex.split(command, comments=True)
        if program == "foon-asp":
            output = quietly(cli(*words))
            optima += map(int, re.findall(r"(\d+) units", output)[:1] if words[0] == "solve" else [])
        else:
            assert program == "python"
            asked = [sys.executable, *words]
            output = subprocess.run(asked, capture_output=True, text=True, check=True).stdout
            assert "OPTIMUM FOUND" in output
            optima.append(int(re.findall(r"Optimization: (\d+)", output)[-1]))
        if target:
            Path(target).write_text(output, encoding="utf-8")
    assert optima == [2, 7, 7, 0]  # the last one is a penalty
