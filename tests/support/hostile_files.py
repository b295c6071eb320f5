"""Files of a user's whose names meet ours: every predicate, constant, term and part of ours in every place.

What each file says is plain: it leaves out some trees, which ``keeps`` tells of a tree by its units, whatever
the names in it. So an answer is that of brute force, or the file is refused with a place.
"""

import random
from collections.abc import Callable, Iterator
from functools import cache
from itertools import product
from pathlib import Path
from typing import NamedTuple

from clingo.ast import AST, ASTType, parse_files
from clingo.symbol import SymbolType

from foon_asp.encoding.fact_writer import FACT_PREDICATES
from foon_asp.encoding.parsing import nodes
from foon_asp.network import FunctionalUnit
from foon_asp.problem import Objective

Keeps = Callable[[tuple[FunctionalUnit, ...]], bool]

ENCODINGS = Path(__file__).resolve().parents[2] / "encodings"
POURS = 'use(U), motion(U,"pour")'


class HostileFile(NamedTuple):
    """A file, what is hostile in it, and which trees it keeps; ``included`` is beside it, as ``inc.lp``."""

    name: str
    role: str
    text: str
    keeps: Keeps
    included: str = ""

    def write(self, folder: Path) -> Path:
        """Write it, and what it includes."""
        (folder / "inc.lp").write_text(self.included, encoding="utf-8")
        file = folder / "hostile.lp"
        file.write_text(self.text, encoding="utf-8")
        return file


@cache
def our_names() -> tuple[str, ...]:
    """Give every name that the program can have in it but for the user's, and each without its underscore."""
    names = {*FACT_PREDICATES, *(objective.row.term for objective in Objective), "base"}
    for file in sorted(ENCODINGS.rglob("*.lp")):
        statements: list[AST] = []
        parse_files([str(file)], statements.append)
        for statement in statements:
            names.update(_names(statement))
    plain = {name.lstrip("_") for name in names}
    return tuple(sorted(name for name in names | plain | {f"_{name}" for name in plain} if name))


def _names(statement: AST) -> Iterator[str]:
    named = {ASTType.Function, ASTType.Program, ASTType.Id, ASTType.Definition, ASTType.Defined}
    for node in nodes(statement):
        if node.ast_type in named:
            yield node.name
        elif node.ast_type == ASTType.SymbolicTerm and node.symbol.type is SymbolType.Function:
            yield node.symbol.name


def _no_pouring(tree: tuple[FunctionalUnit, ...]) -> bool:
    return all(unit.motion != "pour" for unit in tree)


def _at_most(number: int) -> Keeps:
    return lambda tree: len(tree) <= number


# What a file says with a name N, and A, terms for its arguments: that nothing is poured.
_ROLES = {
    "helper": f"N(A) :- {POURS}. :- N(A), unit(U).",
    "fact": f"N(A) :- unit(U). :- {POURS}, N(A).",
    "choice": f"{{ N(A) }} :- use(U). :- {POURS}, not N(A). :- {POURS}, N(A).",
    "conditional choice": f"1 {{ N(A) : {POURS} }} 1 :- some. some :- {POURS}. :- N(A), unit(U).",
    "aggregate head": f"1 #count {{ U : N(A) : {POURS} }} :- some. some :- {POURS}. :- N(A), unit(U).",
    "disjunction": f"N(A) ; other(U) :- {POURS}. :- N(A), unit(U). :- other(U).",
    "negated": f"-N(A) :- {POURS}. :- -N(A), unit(U).",
    "pool": f"N(A;A) :- {POURS}. :- N(A), unit(U).",
    "declared": f"#defined N/ARITY. N(A) :- {POURS}. :- N(A), unit(U).",
    "function": f"helper(N(A)) :- {POURS}. :- helper(N(A)), unit(U).",
    "shown": f"#show N/ARITY. N(A) :- {POURS}. :- N(A), unit(U).",
}
_CONSTANTS = {
    "constant": "#const N = K. :- #count { U : use(U) } > N.",
    "constant to set": "#const N = K. [default] few(N). :- #count { U : use(U) } > M, few(M).",
    "word": "few(N,K). :- #count { U : use(U) } > M, few(N,M).",
    "constant of a word": "#const mine = N. few(mine,K). :- #count { U : use(U) } > M, few(N,M).",
}


@cache
def hostile_files() -> tuple[HostileFile, ...]:
    """Give all of them, in an order that is always the same."""
    return tuple(_made())


def some_hostile_files(number: int, seed: int = 0) -> list[HostileFile]:
    """Give so many, each name of ours at least once where there is room."""
    rng = random.Random(seed)
    files = list(hostile_files())
    rng.shuffle(files)
    first = {file.name: file for file in files}
    rest = [file for file in files if first[file.name] is not file]
    return [*first.values(), *rest][:number]


def _made() -> Iterator[HostileFile]:
    for name in our_names():
        for (role, text), arity in product(_ROLES.items(), range(4)):
            arguments = ",".join(("U", "0", "1")[:arity] if arity % 2 else ("0", "U")[:arity])
            atom = f"{name}({arguments})" if arity else name
            said = text.replace("N/ARITY", f"{name}/{arity}").replace("N(A;A)", f"{name}({arguments};0)")
            if role == "pool" and arity != 1:
                continue
            said = said.replace("N(A)", atom)
            yield HostileFile(name, f"{role}/{arity}", said, _no_pouring)
        for (role, text), number in product(_CONSTANTS.items(), (0, 2, 4)):
            said = text.replace("N", name).replace("K", str(number))
            yield HostileFile(name, role, said, _at_most(number))
        yield HostileFile(
            name, "included", f'#include "inc.lp".\n:- {name}(U).', _no_pouring, f"{name}(U) :- {POURS}."
        )
        number = 3
        yield HostileFile(
            name,
            "included constant",
            f'#include "inc.lp".\n:- #count {{ U : use(U) }} > {name}.',
            _at_most(number),
            f"#const {name} = {number}.",
        )
