"""Ground programs that are kept from one question to the next: multi-shot solving.

With rules of the user's all that can be made is grounded, which takes most of the time of a question. Here
it is grounded once, and what a question changes is left open: which units and object nodes there are, the
kitchen, the goals and the objectives are external atoms, which are set before each search.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence

from clingo.symbol import Function, Number, Symbol

from foon_asp.asp.deadline import Deadline
from foon_asp.asp.exact_success import RateScale, problem_scale
from foon_asp.asp.facts import OBJECTIVE_TERMS, described, write_exponents, write_open_facts, write_product
from foon_asp.asp.program import Program
from foon_asp.asp.run import Run
from foon_asp.asp.search import ground, search
from foon_asp.problem import Objective, Problem

_KEPT = 4  # programs: the container rules, with and without some constraint
_MOST_PRODUCTS = 40  # each is some counting over all units that later searches carry along

Atom = tuple[str, int] | tuple[str, str, int]


class Session:
    """Ground programs of the questions asked last, for :attr:`foon_asp.asp.Settings.session`.

    An answer is what it is without: in status, proof and costs by the objectives. Among trees that are as
    good it may be another one.
    """

    def __init__(self) -> None:
        self._programs: list[OpenProgram] = []  # the one used last at the end

    def program(
        self, program: Program, problem: Problem, units: Sequence[int], levels: Sequence[Objective]
    ) -> "OpenProgram":
        """Give a ground program for a question: one at hand, or a new one where none fits.

        ``units`` are those that there are, by id, and ``levels`` the objectives as optimized. Raises like
        :func:`foon_asp.asp.search.ground`.
        """
        like = next((kept for kept in self._programs if kept.is_like(program, problem)), None)
        if like is not None:
            self._programs.remove(like)
            if not like.fits(problem, units, levels):
                like = like.extended(problem, units, levels)
        else:
            like = OpenProgram(program, problem, units, _pairs(levels))
        self._programs = [*self._programs[1 - _KEPT :], like]
        return like

    def forget(self, program: "OpenProgram") -> None:
        """Drop a program that was left halfway."""
        if program in self._programs:
            self._programs.remove(program)


class OpenProgram:
    """A ground program that leaves open which of its units and object nodes there are, and what is asked.

    ``pairs`` are objectives with the priorities that they may have. ``scale`` is that of the success rates,
    ``None`` where no rates are known.
    """

    def __init__(
        self,
        program: Program,
        problem: Problem,
        units: Iterable[int],
        pairs: Iterable[tuple[Objective, int]],
    ) -> None:
        self._program = program
        self._problem = problem
        self._units = frozenset(units)
        self._objects = frozenset(described(problem, self._units))
        self._pairs = frozenset(pairs)
        self._priorities = max(priority for _, priority in self._pairs)
        ordered = sorted(self._units)
        self.scale: RateScale | None = None if problem.rates is None else problem_scale(problem, ordered)
        facts = write_open_facts(problem, ordered, self.scale, program.looked_at)
        facts += "".join(
            f"#external optimize({OBJECTIVE_TERMS[objective]},{priority}).\n"
            for objective, priority in sorted(self._pairs)
        )
        self._control = ground((*program.files, program.exact_success), facts, program.arguments)
        self._true: set[Atom] = set()
        self._products: dict[tuple[tuple[int, int], ...], int] = {}

    def is_like(self, program: Program, problem: Problem) -> bool:
        """Whether it speaks of the same network and rules, whatever is in the kitchen and asked for."""
        ours = self._problem
        return (
            program == self._program
            and problem.network is ours.network
            and problem.containers is ours.containers
            and problem.rates == ours.rates
            and problem.utensils == ours.utensils
        )

    def fits(self, problem: Problem, units: Sequence[int], levels: Sequence[Objective]) -> bool:
        """Whether everything that a question needs is there."""
        return (
            self._units.issuperset(units)
            and self._objects.issuperset(problem.goals)
            and self._pairs.issuperset(_pairs(levels))
            and len(self._products) <= _MOST_PRODUCTS
            and self._measures_like(problem, units)
        )

    def extended(self, problem: Problem, units: Sequence[int], levels: Sequence[Objective]) -> "OpenProgram":
        """Give a program for this question and, as far as can be, for those before it."""
        pairs = self._pairs.union(_pairs(levels))
        more = OpenProgram(self._program, problem, self._units.union(units), pairs)
        if more._measures_like(problem, units):
            return more
        return OpenProgram(self._program, problem, units, pairs)

    def _measures_like(self, problem: Problem, units: Sequence[int]) -> bool:
        """Whether the rates of all units have the weights that those of the question have by themselves."""
        return self.scale is None or problem_scale(problem, units).scale == self.scale.scale

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
        asked for instead. ``opt_mode`` is as for :func:`foon_asp.asp.search.run`, its bounds those of the
        levels from the first on.
        """
        numbers = [self._product(product) for product in products]
        pairs = [pair for pair in _pairs(levels) if pair[0] in objectives]
        true = set(self._atoms(problem, units))
        true.update(("optimize", OBJECTIVE_TERMS[objective], priority) for objective, priority in pairs)
        if wanted is None:
            true.update(("seen", number) for number in numbers)
        else:
            true.add(("wanted", numbers[wanted]))
        for atom in self._true - true:
            self._control.assign_external(_symbol(atom), False)
        for atom in true - self._true:
            self._control.assign_external(_symbol(atom), True)
        self._true = true
        above = self._priorities - len(levels)  # that nothing is measured under here
        mode, *bounds = opt_mode.split(",")
        ended = search(
            self._control,
            deadline,
            ",".join([mode, *["0"] * (above if bounds else 0), *bounds]),
            on_tree,
            None if on_bound is None else lambda lower: on_bound(lower[above:]),
        )
        ended.cost, ended.lower = ended.cost[above:], ended.lower[above:]
        return ended

    def _atoms(self, problem: Problem, units: Sequence[int]) -> Iterable[Atom]:
        """Give what is the case in a question; just what the facts of it alone would say."""
        network = problem.network
        for unit in units:
            yield "unit", network.unit_number(unit)
        for o in described(problem, units):
            number = network.object_number(o)
            yield "object", number
            if o in problem.kitchen:
                yield "kitchen", number
        for o in problem.goals:
            yield "goal", network.object_number(o)

    def _product(self, exponents: Mapping[int, int]) -> int:
        """Give the number of a product of rates, grounding what is said of it when it is new."""
        key = tuple(sorted(exponents.items()))
        if key in self._products:
            return self._products[key]
        number = len(self._products)
        facts = write_product(number, exponents) + f"#external seen({number}). #external wanted({number}).\n"
        if not number and self.scale is not None:
            facts += write_exponents(self._problem, sorted(self._units), self.scale)
        part = f"facts of product {number}"
        self._control.add(part, [], facts)
        self._control.ground([(part, []), ("product", [Number(number)])])
        self._products[key] = number
        return number


def _pairs(levels: Sequence[Objective]) -> list[tuple[Objective, int]]:
    """Give objectives with their priorities, the first with the highest."""
    return [(objective, len(levels) - place) for place, objective in enumerate(levels)]


def _symbol(atom: Atom) -> Symbol:
    return Function(atom[0], [Function(a, []) if isinstance(a, str) else Number(a) for a in atom[1:]])
