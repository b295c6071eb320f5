"""Ground programs that are kept from one question to the next: multi-shot solving.

With rules of the user's all that can be made is grounded, which takes most of the time of a question. Here
it is grounded once. Goals and objectives are external atoms, which are set before each search, and so is what
has changed since: units that could run or not, items of the kitchen. What was always the case stays a
fact: searches with the whole kitchen left open were up to a hundred times as long.
"""

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence

from foon_asp.asp.program import Program
from foon_asp.deadline import Deadline
from foon_asp.encoding.facts import described, write_exponents, write_open_facts, write_product
from foon_asp.encoding.scales import Scales
from foon_asp.encoding.search import ground, refused
from foon_asp.grounding.run import ProgramError, Run
from foon_asp.network import Network
from foon_asp.problem import Objective, Problem

_KEPT = 4  # programs: the container rules, with and without some constraint
_MOST_OPEN = 50  # items of the kitchen
_MOST_PRODUCTS = 40  # each is some counting over all units that later searches carry along

Case = tuple[str, int]  # that there is a unit or an object, or that one is in the kitchen; by id


class Session:
    """Ground programs of the latest questions, for :attr:`foon_asp.asp.Settings.session`.

    An answer is what it is without: in status, proof and costs by the objectives. Among trees that are as
    good it may be another one.
    """

    def __init__(self) -> None:
        self._programs: list[OpenProgram] = []  # the one used last at the end

    def program(
        self,
        program: Program,
        problem: Problem,
        units: Sequence[int],
        levels: Sequence[Objective],
        deadline: Deadline,
    ) -> "OpenProgram":
        """Give a ground program for a question: a kept one, or a new one if none fits.

        ``units`` are those that there are, by id, and ``levels`` the objectives as optimized. Raises like
        :func:`foon_asp.encoding.search.ground`.
        """
        cases = frozenset(_cases(problem, units))
        like = next((kept for kept in self._programs if kept.is_like(program, problem)), None)
        if like is None:
            like = OpenProgram(program, problem, cases, frozenset(), _pairs(levels), deadline)
        else:
            self._programs.remove(like)
            if not like.fits(problem, cases, levels):
                before, like = like, like.extended(problem, cases, levels, deadline)
                before.close()
        for old in self._programs[: 1 - _KEPT]:
            old.close()
        self._programs = [*self._programs[1 - _KEPT :], like]
        return like

    def forget(self, program: "OpenProgram") -> None:
        """Drop a program whose search was interrupted."""
        if program in self._programs:
            self._programs.remove(program)
        program.close()


class OpenProgram:
    """A ground program that leaves some facts open.

    ``closed`` is always the case, ``left_open`` may be. ``pairs`` are objectives with the priorities that
    they may have. ``scales`` say how its units are measured.
    """

    def __init__(
        self,
        program: Program,
        problem: Problem,
        closed: frozenset[Case],
        left_open: frozenset[Case],
        pairs: Iterable[tuple[Objective, int]],
        deadline: Deadline,
    ) -> None:
        self._program = program._replace(understood=None)  # what the rules are, the text says
        self._problem = problem
        self._closed, self._open = closed, left_open
        self._units = _units({*closed, *left_open})
        self._pairs = frozenset(pairs)
        self._priorities = max(priority for _, priority in self._pairs)
        objectives = dict.fromkeys(objective for objective, _ in sorted(self._pairs))
        self.scales = Scales(problem, self._units, objectives)
        facts = write_open_facts(problem, closed, left_open, self.scales, program.looked_at)
        facts += "".join(
            f"#external optimize({objective.row.term},{priority}).\n"
            for objective, priority in sorted(self._pairs)
        )
        self._ground = ground(
            (*program.files, program.exact_success),
            facts,
            program.arguments,
            deadline,
            endless=program.endless,
        )
        self._true: set[str] = set()
        self._products: dict[tuple[tuple[int, int], ...], int] = {}

    def is_like(self, program: Program, problem: Problem) -> bool:
        """Whether it has the same network and rules, whatever the kitchen and the goals."""
        ours = self._problem
        return (
            program._replace(understood=None) == self._program
            and problem.network is ours.network
            and problem.containers is ours.containers
            and problem.rates == ours.rates
            and problem.own_rates == ours.own_rates
            and problem.unit_prices == ours.unit_prices
            and problem.utensils == ours.utensils
        )

    def fits(self, problem: Problem, cases: frozenset[Case], levels: Sequence[Objective]) -> bool:
        """Whether it can be set to exactly the facts of a question."""
        return (
            self._closed <= cases <= self._closed | self._open
            and self._pairs.issuperset(_pairs(levels))
            and len(self._products) <= _MOST_PRODUCTS
            and self._measures_like(problem, cases)
        )

    def extended(
        self, problem: Problem, cases: frozenset[Case], levels: Sequence[Objective], deadline: Deadline
    ) -> "OpenProgram":
        """Give a program for this question and, as far as can be, for those before it."""
        pairs = self._pairs.union(_pairs(levels))
        left_open = self._open | (self._closed ^ cases)
        if sum(kind == "kitchen" for kind, _ in left_open) <= _MOST_OPEN:
            more = OpenProgram(self._program, problem, cases - left_open, left_open, pairs, deadline)
            if more._measures_like(problem, cases):
                return more
            more.close()
        return OpenProgram(self._program, problem, cases, frozenset(), pairs, deadline)

    def _measures_like(self, problem: Problem, cases: Iterable[Case]) -> bool:
        """Whether the rates of all units have the weights that those of the question have by themselves."""
        objectives = dict.fromkeys(objective for objective, _ in sorted(self._pairs))
        return Scales(problem, _units(cases), objectives).likeness == self.scales.likeness

    def run(
        self,
        problem: Problem,
        units: Sequence[int],
        levels: Sequence[Objective],
        objectives: Sequence[Objective],
        products: Sequence[Mapping[int, int]],
        wanted: int | None,
        deadline: Deadline,
        opt_mode: str,
        on_tree: Callable[[frozenset[int]], None] | None = None,
        on_bound: Callable[[list[int]], None] | None = None,
    ) -> Run:
        """Search for the best answer by those of the levels that are among ``objectives``.

        ``products`` of success rates, by exponents, are ruled out; with ``wanted`` the one of that number is
        asked for instead. ``opt_mode`` is as for :func:`foon_asp.encoding.search.run`, its bounds those of
        the ``objectives``.
        """
        numbers = [self._product(product, deadline) for product in products]
        network = problem.network
        true = {_case(case, network) for case in self._open.intersection(_cases(problem, units))}
        true |= {_atom("goal", network.object_number(o)) for o in problem.goals}
        true |= {
            f"optimize({objective.row.term},{priority})"
            for objective, priority in _pairs(levels)
            if objective in objectives
        }
        if wanted is None:
            true |= {_atom("_seen", number) for number in numbers}
        else:
            true.add(_atom("_wanted", numbers[wanted]))
        self._ground.assign({atom: atom in true for atom in sorted(self._true ^ true)}, deadline)
        self._true = true
        above = self._priorities - len(levels)  # that nothing is measured under here
        mode, *bounds = opt_mode.split(",")
        bound_of = dict(zip(objectives, bounds, strict=False))
        if bounds:  # what is not measured costs nothing
            bounds = ["0"] * above + [bound_of.get(level, "0") for level in levels]
        ended = self._ground.search(
            deadline,
            ",".join([mode, *bounds]),
            on_tree,
            None if on_bound is None else lambda lower: on_bound(lower[above:]),
        )
        ended.cost, ended.lower = ended.cost[above:], ended.lower[above:]
        return ended

    def close(self) -> None:
        """Release the program."""
        self._ground.close()

    def _product(self, exponents: Mapping[int, int], deadline: Deadline) -> int:
        """Give the number of a product of rates, grounding its part if it is new."""
        key = tuple(sorted(exponents.items()))
        if key in self._products:
            return self._products[key]
        number = len(self._products)
        facts = (
            write_product(number, exponents) + f"#external _seen({number}). #external _wanted({number}).\n"
        )
        if not number:
            facts += write_exponents(self._problem, self.scales)
        part = f"facts of product {number}"
        try:
            self._ground.add(part, facts, number, deadline)
        except ProgramError as error:
            raise refused(error) from None
        self._products[key] = number
        return number


def _pairs(levels: Sequence[Objective]) -> list[tuple[Objective, int]]:
    """Give objectives with their priorities, the first with the highest."""
    return [(objective, len(levels) - place) for place, objective in enumerate(levels)]


def _cases(problem: Problem, units: Collection[int]) -> Iterable[Case]:
    """Give the facts of a question that are left open here, as when it is asked by itself."""
    yield from (("unit", unit) for unit in units)
    for o in described(problem, units):
        yield "object", o
        if o in problem.kitchen:
            yield "kitchen", o


def _units(cases: Iterable[Case]) -> list[int]:
    return sorted(unit for kind, unit in cases if kind == "unit")


def _case(case: Case, network: Network) -> str:
    kind, id_ = case
    return _atom(kind, network.unit_number(id_) if kind == "unit" else network.object_number(id_))


def _atom(name: str, number: int) -> str:
    return f"{name}({number})"
