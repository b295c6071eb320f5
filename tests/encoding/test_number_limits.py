"""Numbers beyond clingo's 32 bits in rules: it goes on with others silently, and that must be an error."""

import itertools
import operator
import random
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import pytest
from clingo.ast import AST

import foon_asp
from foon_asp.asp import Settings, solve
from foon_asp.encoding.exact import LARGEST
from foon_asp.encoding.ground_program import GroundProgram
from foon_asp.encoding.number_checks import CHECKS_FILE
from foon_asp.encoding.parsing import parse
from foon_asp.encoding.run import FoundAnswer, ProgramError
from foon_asp.encoding.stated import Stated
from foon_asp.problem import Problem
from foon_asp.rules.number_limits import number_checks
from foon_asp.rules.passed_constraint import RuleText
from foon_asp.text.diagnostics import InputError
from tests.conftest import Cli

ICE = ("solve", "--goal", "ice")
OUT_OF = "leaves the whole numbers that clingo has"


@pytest.fixture(scope="module")
def ice() -> Problem:
    return foon_asp.load().problem("ice")


def checked(rules: str) -> GroundProgram:
    """Ground rules as those of a user are, with what finds numbers beyond clingo's."""
    statements: list[AST] = []
    stated = Stated("rule 1", rules)
    parse(stated, statements.append, lambda *_: None)
    return GroundProgram([stated, Stated(CHECKS_FILE, number_checks(statements))], "", [])


def answers(program: GroundProgram, predicate: tuple[str, int]) -> set[frozenset[int]]:
    """Give the numbers that a predicate has in each of all answers."""
    found: list[FoundAnswer] = []
    program.search("ignore", [predicate], found.append, lambda _: None)
    return {frozenset(row[0] for row in heard.rows[predicate[0]]) for heard in found}


def refused(rules: str) -> tuple[list[str], set[frozenset[int]]]:
    """Give what is said against rules, and otherwise the numbers of ``v`` in each answer."""
    try:
        return [], answers(checked(rules), ("v", 1))
    except ProgramError as error:
        return error.messages, set()


# --- Terms.


class _BeyondError(Exception):
    pass


OPERATORS: dict[str, Callable[[int, int], int]] = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": lambda a, b: int(abs(a) // abs(b)) * (1 if a * b >= 0 else -1),
    "\\": lambda a, b: abs(a) % abs(b) * (1 if a >= 0 else -1),
    "&": lambda a, b: a & b,
    "?": lambda a, b: a | b,
    "^": lambda a, b: a ^ b,
}
NUMBERS = (0, 1, 2, 3, 7, 31, 46340, 46341, 65536, 2**30, LARGEST)


def drawn(rng: random.Random, depth: int, x: int, y: int) -> tuple[str, int]:
    """Draw a term about X and Y; gives its text and exact value, and raises where one in it is too large."""
    if depth == 0 or rng.random() < 0.2:
        number = rng.choice(NUMBERS)
        return rng.choice((("X", x), ("Y", y), (str(number), number), (f"(-{number})", -number)))
    one, a = drawn(rng, depth - 1, x, y)
    if rng.random() < 0.15:
        text, value = rng.choice(((f"(-{one})", -a), (f"|{one}|", abs(a)), (f"(~{one})", ~a)))
        return (text, value) if abs(value) <= LARGEST else (one, a)
    other, b = drawn(rng, depth - 1, x, y)
    sign = rng.choice((*OPERATORS, "*", "+", "-", "**"))
    if (sign in "/\\" and b == 0) or (sign == "**" and abs(b) > 40):
        sign = "+"
    text = f"({one}{sign}{other})"
    if sign == "**":
        if b < 0:
            raise _BeyondError(text)
        value = a**b
    else:
        value = OPERATORS[sign](a, b)
    if abs(value) > LARGEST:
        raise _BeyondError(text)
    return text, value


PLACES = (
    "v({}) :- n(X), n(Y), X < Y.",
    "v(V) :- n(X), n(Y), X < Y, V = {}.",
    "v(V) :- n(X), n(Y), X < Y, V = #sum {{ {} }}.",
    "v(V) :- n(X), V = #max {{ {}: n(Y), X < Y }}, V > #inf.",
    "v(V) :- V = #min {{ {},X,Y : n(X), n(Y), X < Y }}.",
    "w(f({},X)) :- n(X), n(Y), X < Y. v(V) :- w(f(V,_)).",
    "{{ v({}) : n(X), X < Y }} = 1 :- n(Y), not n(X) : n(X), X > Y.",
    "1 {{ v({}) : n(X), n(Y), X < Y }}.",
    "v(V) :- n(X), n(Y), X < Y, V = (1..1)*{}.",
    "v(V) :- V = ({};{}), n(X), n(Y), X < Y.",
    "-w({}) :- n(X), n(Y), X < Y. v(V) :- -w(V).",
    "{{ u }}. :- not u. v({}) :- u, n(X), n(Y), X < Y.",
)


def seeds(few: int, many: int) -> pytest.MarkDecorator:
    return pytest.mark.parametrize(
        "seeds", [range(few), pytest.param(range(few, many), marks=pytest.mark.slow)], ids=["few", "many"]
    )


@seeds(60, 600)
def test_terms_have_their_exact_value_or_are_refused(seeds: range) -> None:
    met: Counter[tuple[int, bool]] = Counter()
    for seed in seeds:
        rng = random.Random(seed)
        x, y = sorted(rng.sample((*NUMBERS, -1, -5, -LARGEST), 2))
        rules = PLACES[seed % len(PLACES)]
        try:
            term, value = drawn(rng, 3, x, y)
            wanted: frozenset[int] | None = frozenset({value})
        except _BeyondError as beyond:
            term, wanted = str(beyond), None
        text = f"n({x}). n({y}). {rules.replace('{{', '{').replace('}}', '}').replace('{}', term)}"
        met[seed % len(PLACES), wanted is None] += 1
        messages, found = refused(text)
        if any("operation undefined" in message for message in messages):
            continue  # of other values, too, which the rule leaves out later
        assert found == {wanted} if wanted is not None else any(OUT_OF in each for each in messages), text
    assert {kind for _, kind in met} == {False, True}


@pytest.mark.parametrize(
    "rules",
    [
        "p(-2147483646). q(X) :- p(X+1000).",  # as clingo solves it for X
        "p(-2147483646). q(X) :- p(2*X+1000).",
        "p(2147483646). q(X) :- p(X-1000).",
        "n(50000). p(1). q :- not p(X*X), n(X).",
        "n(50000). p(1). q :- p(X) : X = Y*Y, n(Y).",
        "n(5). n(50000). p(X) : n(X), X*X < 0 :- n(5).",
        "n(50000). p(X*X) ; p(5) :- n(X).",
        "n(1..50000). q :- { n(X) : X*X*X < 5 } > 3.",
        "n(1..50000). q :- #count { X : n(X) } > 50000*X*X, n(X).",
        "n(1..50000). q :- 5 < X*X < 9, n(X).",
        "q :- X = 3..4, M = X*1000000000.",  # an equality that clingo drops, and what binds M with it
        "q :- M = (3..3)*1000000000.",
        "q :- 5 = 2*X-1, M = X*1000000000, M > 5.",
        "n(1..4). q :- n(Y), 8 = X*Y, X = Y*1000000000.",
        "n(50000). q((X*X..X*X)-1) :- n(X).",
        "n(1..4). q :- #count { X : n(X), M = X*1000000000 } > 2.",
        "n(1..50000). q :- N = { n(X) }, N*N < 9.",
        "n(1..50000). p(1..X*X) :- n(X), X > 46340, X*X < 0.",
        "#const n = 50000. #const m = n*n. p(m).",
        "#const n = 2. p(n**40).",
        "p(2**(-1)).",
        "p(1**(-1)).",
        "n(2147483646). p(X+1) :- n(X).",
        "n(2147483646). p(-X-2) :- n(X).",  # fits 32 bits, and nothing else does with it
        "p(1..4). { q(X) : p(X) }. r :- #sum { 1073741824,X : q(X) } > 5.",
        "p(1..4). { q(X) : p(X) }. r :- not #sum { 1073741824,X : q(X) } > 5.",
        "p(1..4). r(N) :- N = #sum { 1073741824,X : p(X) }.",
        "p(1..4). r(N) :- N = #sum+ { 1073741824,X : p(X) }.",
        "p(1..4). r :- #sum { 1073741824,X : p(X); -1073741824,X,0 : p(X) } > 5.",
        "p(1..4). #sum { 1073741824,X : q(X) : p(X) } > 5.",
    ],
)
def test_where_numbers_beyond_those_of_clingo_are(rules: str) -> None:
    with pytest.raises(ProgramError) as refused:
        checked(rules)
    assert any(OUT_OF in message for message in refused.value.messages), refused.value.messages


@pytest.mark.parametrize(
    "rules",
    [
        'n("a"). n(3). n(#sup). p(X) :- n(X), X < 5, X*2 > 1.',
        "p(3). q :- p(_+50000).",
        "n(46340). p(X*X) :- n(X).",
        "n(1073741823). p(X+X) :- n(X).",
        "p(1..4). { q(X) : p(X) }. r :- #sum { 536870911,X : q(X) } > 5.",
        "p(1..3). r(N) :- N = #sum { -700000000,X : p(X) }.",
        "p(1..4). r :- #count { 1073741824,X : p(X) } > 5.",
    ],
)
def test_what_fits_is_not_refused(rules: str) -> None:
    checked(rules).close()


# --- Sums.

COMPARE: dict[str, Callable[[int, int], bool]] = {
    ">": operator.gt,
    "<": operator.lt,
    ">=": operator.ge,
    "<=": operator.le,
    "=": operator.eq,
    "!=": operator.ne,
}


@seeds(40, 300)
def test_sums_are_exact_or_refused(seeds: range) -> None:
    """Compare a sum over facts and choices, of sizes that fit together or do not."""
    met: Counter[bool] = Counter()
    for seed in seeds:
        rng = random.Random(seed)
        fact = [rng.random() < 0.4 for _ in range(rng.randint(1, 5))]
        weights = [
            max(rng.choice((-1, 1)) * (LARGEST >> rng.randint(0, 12)) - rng.randint(0, 3), -LARGEST)
            for _ in fact
        ]
        bound = rng.choice((0, 5, -5, rng.randint(-LARGEST, LARGEST)))
        word, sign = rng.choice(tuple(COMPARE)), rng.choice(("", "not "))
        rules = "".join(f"q({n}). " if each else f"{{ q({n}) }}. " for n, each in enumerate(fact))
        terms = "; ".join(f"{weight},{n} : q({n})" for n, weight in enumerate(weights))
        rules += f"v(10) :- {sign}#sum {{ {terms} }} {word} {bound}. v(N) :- q(N)."
        fits = sum(map(abs, weights)) <= LARGEST
        met[fits] += 1
        wanted = set()
        for chosen in itertools.product(*[[True] if each else [False, True] for each in fact]):
            used = {n for n, each in enumerate(chosen) if each}
            holds = COMPARE[word](sum(weights[n] for n in used), bound) != bool(sign)
            wanted.add(frozenset(used | {10} if holds else used))
        for rule, expected in (("", wanted), (" :- v(10).", {each for each in wanted if 10 not in each})):
            messages, found = refused(rules + rule)
            assert bool(messages) != fits, rules
            assert not fits or (found <= expected and bool(found) == bool(expected)), rules
    assert len(met) == 2


# --- In questions.


@pytest.mark.parametrize(
    ("rule", "place"),
    [
        (":- #sum { N*100000000,U : use(U), inputs(U,N) } > 5.", "1:4"),
        ("big(U,N*1000000000) :- inputs(U,N). :- use(U), big(U,N), N < 0.", "1:7"),
        (":- use(U), inputs(U,N), N*1000000000 < 0.", "1:25"),  # a unit by itself breaks it
        (":- not use(U) : inputs(U,N), N*1000000000 < 0.", "1:30"),  # it asks for one of a set
        ("#const big = 50000*50000. :- use(U), inputs(U,N), N < big.", "1:14"),
        (":- use(U), inputs(U,N), 2**(N-100) < 0.", "1:25"),
    ],
)
def test_rules_have_the_place(rule: str, place: str, cli: Cli, tmp_path: Path) -> None:
    for options in (("--rule", rule), ("--soft", f"{rule}=3"), ("--reduce", "none", "--rule", rule)):
        if options[0] == "--soft" and ". :-" in rule:
            continue
        ran = cli(*ICE, *options)
        assert (ran.code, ran.out) == (2, ""), options
        assert f"rule 1:{place}: error: " in ran.err
        assert OUT_OF in ran.err
    mine = tmp_path / "mine.lp"
    mine.write_text(f"% mine\n{rule}\n", encoding="utf-8")
    ran = cli(*ICE, "--constraint", str(mine))
    assert f"mine.lp:{place.replace('1:', '2:', 1)}: error: " in ran.err


def test_rules_that_calculate_little_hold(ice: Problem) -> None:
    for most, possible in ((599, False), (600, True)):
        rule = RuleText(f":- #sum {{ N*100,U : use(U), inputs(U,N) }} > {most}.")
        assert (solve(ice, settings=Settings(constraints=(rule,))).units is not None) == possible


def test_facts_of_the_users_own_are_looked_at_too(ice: Problem) -> None:
    rule = RuleText("pay(2147483646). :- use(U), pay(N), N+U > 0, U > 0.")
    with pytest.raises(InputError, match=OUT_OF):
        solve(ice, settings=Settings(constraints=(rule,)))


def test_functions_of_ours_are_no_ones(cli: Cli) -> None:
    for call in ('@_exact("0",1)', "@__class__(1)", "@print(1)"):
        ran = cli(*ICE, "--rule", f":- use(U), U = {call}.")
        assert (ran.code, ran.out) == (2, ""), call


@pytest.mark.parametrize("word", ["/", "\\"])
def test_a_division_at_which_clingo_breaks_down(word: str, cli: Cli, tmp_path: Path) -> None:
    calculated = f"X = -2147483646-2, Y = -1, X{word}Y > 0"
    mine = tmp_path / "mine.lp"
    mine.write_text(f"cost(mine,U,1) :- unit(U), {calculated}.", encoding="utf-8")
    for options in (("--rule", f":- use(U), {calculated}."), ("--measure", str(mine), "--objective", "mine")):
        ran = cli(*ICE, *options)
        assert (ran.code, ran.out) == (2, "")
        assert "clingo broke down at a division" in ran.err
