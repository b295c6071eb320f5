"""Writer of facts for clingo, as text.

A number that does not fit into 32 bits raises :class:`UserError`.

If totals by a rounded objective are compared exactly, some facts are about products of rates. Product number
K is the exact total of a known tree, as a vector (:meth:`foon_asp.encoding.cost_scales.Scales.vector`). For
success, it has the exponents of the product of the tree's rates. For other objectives, the same predicates
are used with counts of costs.
"""

from collections.abc import Collection, Hashable, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cache, lru_cache
from pathlib import PurePath

from foon_asp.encoding.cost_scales import Scales
from foon_asp.encoding.exact import LARGEST
from foon_asp.errors import UserError
from foon_asp.escapes import encodable
from foon_asp.network import ObjectNode, Source
from foon_asp.problem import Objective, Problem, multiplies
from foon_asp.problem.number import INT32_MAX
from foon_asp.text.exact_number import decimal_text

# Predicates of the facts of every question, with arity; encodings/README.md has the meanings. Encodings of
# questions list further ones in their headers.
FACT_PREDICATES = {
    "unit": 1,
    "motion": 2,
    "input": 2,
    "output": 2,
    "needs": 2,
    "gives": 2,
    "object": 1,
    "label": 2,
    "state": 2,
    "ingredient": 2,
    "located": 3,
    "kitchen": 1,
    "goal": 1,
    "utensil": 1,
    "source": 2,
    "video": 2,
    "inputs": 2,
    "ingredients": 2,
    "rate": 2,
    "price": 2,
    "risk": 2,
    "cost": 3,
    "optimize": 2,
    "stays": 2,
    "uses_up": 2,
    "stock": 2,
}

# Predicates that built-in encodings read, including those of questions.
READ_BY_OURS = frozenset(
    (name, FACT_PREDICATES[name])
    for name in (
        "unit",
        "needs",
        "gives",
        "kitchen",
        "goal",
        "inputs",
        "ingredients",
        "risk",
        "cost",
        "optimize",
    )
)

OBJECT_FACTS = frozenset(("object", "label", "state", "ingredient", "located"))  # each about one object node

_Atom = tuple[str, str]  # predicate, and arguments as text

_PRICE = ("price", 2)
_OF_RULES = frozenset({("source", 2), ("video", 2), _PRICE})


def write_facts(
    problem: Problem,
    units: Sequence[int],
    scales: Scales | None = None,
    looked_at: Collection[tuple[str, int]] | None = None,
) -> str:
    """Return the facts about units of a problem, their object nodes, the kitchen and the goals.

    There is one line per unit and per object node. Units and object nodes have the numbers that users see.
    Facts ``kitchen/1`` are about the part of the kitchen that user rules see. Facts ``available/1`` are about
    the other items of the kitchen.

    ``scales`` have the weights of ``risk/2`` and ``cost/3``; without scales, ``rate/2``, ``risk/2`` and
    ``cost/3`` are omitted.

    ``looked_at`` are the predicates that user rules read; ``None`` if there are no user rules. With user
    rules, facts about sources, videos and prices of units are added. Prices are left out if some price is not
    a whole number of hundredths.

    Raises :class:`UserError` if user rules read prices and a price is no whole number of hundredths. Also
    raises it for numbers and names that clingo cannot take.
    """
    object_number = problem.network.object_number
    nodes = described_nodes(problem, units)
    prices = None if looked_at is None else prices_in_hundredths(problem, units, looked_at)
    kitchen = problem.kitchen_seen
    lines = []
    for unit in units:
        atoms = _unit_atoms(problem, unit, scales, prices)
        lines.append(". ".join([_unit_atom(problem, unit), *map(_atom_text, atoms)]) + ".")
    for o in nodes:
        atoms = _object_atoms(problem, o)
        if o in kitchen:
            atoms.append(("kitchen", f"{object_number(o)}"))
            copies = problem.stock_of(o)
            atoms += [] if copies is None else [("stock", f"{object_number(o)},{_check_int32(copies)}")]
        lines.append(". ".join([_object_atom(problem, o), *map(_atom_text, atoms)]) + ".")
    return "\n".join([*lines, *_utensil_and_goal_facts(problem, nodes)]) + "\n"


def write_facts_read(
    problem: Problem, units: Sequence[int], read: Collection[tuple[str, int]], scales: Scales | None = None
) -> str:
    """Return the facts of :func:`write_facts` that have the predicates in ``read``.

    The facts ``utensil/1``, ``goal/1`` and ``available/1`` are always included. Without ``scales``,
    ``risk/2`` and ``cost/3`` are omitted, but ``rate/2`` is not. The fact ``stock/2`` is never written.

    Raises :class:`UserError` if prices are read and a price is no whole number of hundredths. Also raises it
    for numbers and names that clingo cannot take.
    """
    problem_seen = problem.as_seen or problem
    object_number = problem.network.object_number
    read_names = {predicate for predicate, _ in read}
    nodes = described_nodes(problem, units)
    kitchen = problem.kitchen_seen
    lines: list[str] = []
    prices = prices_in_hundredths(problem, units, read) if _OF_RULES & {*read} else None
    object_predicates = {name for name in OBJECT_FACTS if (name, FACT_PREDICATES[name]) in read}

    def add(atoms: Iterable[_Atom]) -> None:
        """Add a line with all atoms whose predicates are in ``read``, unless there are no such atoms."""
        texts = [_atom_text(atom) for atom in atoms if (atom[0], FACT_PREDICATES[atom[0]]) in read]
        if texts:
            lines.append(". ".join(texts) + ".")

    for unit in units:
        atoms = [("unit", f"{_check_int32(problem.network.unit_number(unit))}")]
        atoms += _unit_atoms(problem, unit, scales, prices, read_names)
        if "rate" in read_names and problem.rates is not None and not (scales and scales.rates):
            number = problem.network.unit_number(unit)
            atoms.append(("rate", f"{number},{millionths(problem_seen.rate(unit))}"))
        add(atoms)
    for o in nodes if object_predicates or not read_names.isdisjoint(("object", "kitchen")) else ():
        atoms = [("object", f"{_check_int32(object_number(o))}")]
        atoms += [
            (predicate, f"{object_number(o)},{arguments}")
            for predicate, arguments in object_facts(problem.network.objects[o], object_predicates)
        ]
        if o in kitchen:
            atoms.append(("kitchen", f"{object_number(o)}"))
        add(atoms)
    return "\n".join([*lines, *_utensil_and_goal_facts(problem, nodes)]) + "\n"


def _utensil_and_goal_facts(problem: Problem, nodes: Sequence[int]) -> Iterator[str]:
    """Yield the facts ``utensil/1`` and ``goal/1``, and ``available/1`` for items that user rules do not see.

    ``nodes`` are ids of object nodes. Labels of these nodes that are utensils get ``utensil/1``. A node gets
    ``available/1`` if it is in the kitchen, but not in the part of the kitchen that user rules see.
    """
    object_number = problem.network.object_number
    labels = {problem.network.objects[o].label for o in nodes}
    yield from (f"utensil({quote(label)})." for label in sorted(labels & problem.utensils))
    yield from (f"goal({object_number(o)})." for o in problem.goals)
    assumed = problem.kitchen - problem.kitchen_seen
    yield from (f"available({object_number(o)})." for o in nodes if o in assumed)


def write_worlds(
    problem: Problem, units: Iterable[int], predicates: Collection[str], world: str
) -> Iterator[str]:
    """Yield a line for each unit, with the facts about the unit and its object nodes in its own world.

    In a world, rules see no other unit. The number of its unit stands for the world.

    ``predicates`` are the names of the predicates to write. A predicate ``p`` becomes ``_p``, with the world
    as first argument. ``world`` is the name of the predicate that holds of each world. Prices are never
    written.
    """
    network = problem.network
    sees_nodes = not OBJECT_FACTS.isdisjoint(predicates)
    prices: dict[int, int] | None = {} if {"source", "video"} & set(predicates) else None

    @cache
    def object_atoms(o: int) -> list[_Atom]:
        """Return the facts about an object node that have one of the predicates to write; they are cached."""
        number = network.object_number(o)
        atoms = [
            (name, f"{number},{arguments}")
            for name, arguments in object_facts(network.objects[o], predicates)
        ]
        return [*atoms, ("object", f"{_check_int32(number)}")] if "object" in predicates else atoms

    for unit in units:
        number = network.unit_number(unit)
        atoms = [("unit", f"{_check_int32(number)}"), *_unit_atoms(problem, unit, None, prices)]
        atoms = [atom for atom in atoms if atom[0] in predicates]
        if "rate" in predicates:
            atoms.append(("rate", f"{number},{millionths((problem.as_seen or problem).rate(unit))}"))
        if sees_nodes:
            for o in dict.fromkeys((*network.inputs[unit], *network.outputs[unit])):
                atoms += object_atoms(o)
        yield f"{world}({number})." + "".join(
            [f"_{name}({number},{arguments})." for name, arguments in atoms]
        )


def _atom_text(atom: _Atom) -> str:
    """Return an atom as text."""
    return f"{atom[0]}({atom[1]})"


def _unit_atom(problem: Problem, unit: int) -> str:
    """Return the fact ``unit(U)`` as text; raises :class:`UserError` for a number above 32 bits."""
    return f"unit({_check_int32(problem.network.unit_number(unit))})"


def _unit_atoms(
    problem: Problem,
    unit: int,
    scales: Scales | None,
    prices: Mapping[int, int] | None,
    read: Collection[str] = FACT_PREDICATES,
) -> list[_Atom]:
    """Return the facts about a unit, except ``unit/1``.

    ``read`` has the names of predicates to write. Some facts are written whether they are in ``read`` or not:

    - ``rate/2``, ``risk/2`` and ``cost/3`` if there are scales,
    - ``stays/2`` and ``uses_up/2`` if items are used up,
    - sources, videos and the price, unless ``prices`` is ``None``.
    """
    network = problem.network
    inputs, object_number = network.inputs[unit], network.object_number
    number = network.unit_number(unit)
    atoms = [("motion", f"{number},{quote(network.motions[unit])}")] if "motion" in read else []
    for predicate, nodes in (
        ("input", inputs),
        ("needs", problem.needs[unit]),
        ("output", network.outputs[unit]),
        ("gives", problem.gives[unit]),
    ):
        if predicate in read:
            atoms += [(predicate, f"{number},{object_number(o)}") for o in nodes]
    if problem.items is not None:
        used_up = problem.flows[unit].uses
        atoms += [
            ("uses_up" if o in used_up else "stays", f"{number},{object_number(o)}")
            for o in problem.needs[unit]
        ]
    if "inputs" in read:
        atoms.append(("inputs", f"{number},{len(inputs)}"))
    if "ingredients" in read:
        ingredients = sum(len(network.objects[o].ingredients) for o in inputs)
        atoms.append(("ingredients", f"{number},{_check_int32(ingredients)}"))
    if scales and scales.rates:
        weight = scales.rates.weights[problem.rate(unit)]
        rate_seen = (problem.as_seen or problem).rate(unit)
        atoms += [("rate", f"{number},{millionths(rate_seen)}"), ("risk", f"{number},{_check_int32(weight)}")]
    if scales:
        weights = ((objective.row.term, scales.weight(objective, [unit])) for objective in scales.facts)
        atoms += [("cost", f"{term},{number},{_check_int32(weight)}") for term, weight in weights]
    if prices is not None:
        sources = network.sources[unit]
        atoms += [("source", f"{number},{quote(text)}") for text in source_names(sources)]
        videos = dict.fromkeys(video for source in sources for video in source.videos)
        atoms += [("video", f"{number},{quote(encodable(video))}") for video in videos]
        atoms += [("price", f"{number},{prices[unit]}")] if unit in prices else []
    return atoms


def prices_in_hundredths(
    problem: Problem, units: Iterable[int], looked_at: Collection[tuple[str, int]]
) -> dict[int, int]:
    """Return the price of each unit that has one, in hundredths, by unit id.

    The result is empty if no prices are known, if a price is no whole number of hundredths, or if the sum of
    the prices overflows. ``looked_at`` are the predicates that rules read. If ``price/2`` is among them,
    :class:`UserError` is raised instead of an empty result.
    """
    if problem.unit_prices is None:
        if _PRICE in looked_at:
            raise UserError(
                "a rule looks at price/2, and no prices of units are known: "
                "give a file of prices, with --unit-prices FILE or in Python load(..., unit_prices=FILE)"
            )
        return {}
    prices = [(unit, price) for unit in units if (price := problem.prices[unit]) is not None]
    by_unit = {unit: price.numerator * 100 // price.denominator for unit, price in prices}
    inexact = next((pair for pair in prices if pair[1].numerator * 100 % pair[1].denominator), None)
    if inexact is None and sum(by_unit.values()) <= LARGEST:
        return by_unit
    if _PRICE not in looked_at:
        return {}
    if inexact is None:
        raise UserError(
            f"a rule looks at price/2, and the prices of all units together are more than {LARGEST // 100}, "
            "which is more than clingo's numbers of 32 bits can tell in hundredths: divide all prices by 10"
        )
    unit, price = inexact
    text = decimal_text(price) if 10**18 % price.denominator == 0 else f"{price}"
    raise UserError(
        f"a rule looks at price/2, and the price {text} of the unit "
        f"{problem.network.motions[unit]!r} is not a whole number of hundredths: round it, or multiply all "
        "prices by 10"
    )


def _object_atom(problem: Problem, o: int) -> str:
    """Return the fact ``object(O)`` as text."""
    return f"object({_check_int32(problem.network.object_number(o))})"


def _object_atoms(problem: Problem, o: int) -> list[_Atom]:
    """Return the facts about an object node, except ``object/1`` and ``kitchen/1``."""
    number = problem.network.object_number(o)
    return [(name, f"{number},{arguments}") for name, arguments in object_facts(problem.network.objects[o])]


def object_facts(node: ObjectNode, predicates: Collection[str] = OBJECT_FACTS) -> list[_Atom]:
    """Return the facts about an object node, without its number, which is their first argument.

    ``predicates`` are the names of the predicates to write; ``object/1`` is never written. Each fact is a
    predicate with its other arguments as text: ``("state", '"sliced"')``.
    """
    atoms = [("label", quote(node.label))] if "label" in predicates else []
    if "state" in predicates:
        atoms += [("state", quote(state)) for state in sorted(node.states)]
    if "located" in predicates:
        atoms += [("located", f"{quote(word)},{quote(related)}") for word, related in sorted(node.relations)]
    if "ingredient" in predicates:
        atoms += [("ingredient", quote(item)) for item in dict.fromkeys(node.ingredients)]
    return atoms


def described_nodes(problem: Problem, units: Iterable[int]) -> list[int]:
    """Return the ids of all goals, and of the inputs and outputs of units, in ascending order."""
    network = problem.network
    touched = {
        o for unit in units for objects_of in (network.inputs, network.outputs) for o in objects_of[unit]
    }
    return sorted(touched.union(problem.goals))


def write_times(times: Mapping[int, tuple[int, int]]) -> str:
    """Return facts ``_least(U,N)`` and ``_most(U,N)``: bounds on the number of executions of units.

    ``times`` has the least and greatest number by unit number.
    """
    return "".join(
        f"_least({unit},{least}). _most({unit},{_check_int32(greatest)}).\n"
        for unit, (least, greatest) in times.items()
    )


def write_objectives(objectives: Sequence[Objective]) -> str:
    """Return facts ``optimize(Objective,Priority)``; the first objective has the highest priority."""
    return "".join(
        f"optimize({objective.row.term},{len(objectives) - position}).\n"
        for position, objective in enumerate(objectives)
    )


def write_exponents(problem: Problem, scales: Scales) -> str:
    """Return facts ``_exponent(U,F,E)``: entry F of the :meth:`Scales.unit_vector` of unit U is E.

    For success, E is the exponent of factor F in the unit's rate.
    """
    return "".join(
        f"_exponent({problem.network.unit_number(unit)},{factor},{_check_int32(number)}).\n"
        for unit, vector in scales.unit_vectors().items()
        for factor, number in vector.items()
    )


def write_product(number: int, exponents: Mapping[int, int]) -> str:
    """Return facts ``_product(K,F,E)``: in product number K of rates, factor number F has the exponent E.

    ``number`` is K; ``exponents`` has E by F. For an objective other than success, ``exponents`` is any
    :meth:`Scales.vector`, and E is its entry F.
    """
    return "".join(f"_product({number},{factor},{_check_int32(e)}).\n" for factor, e in exponents.items())


def write_seen(numbers: Iterable[int]) -> str:
    """Return facts ``_seen(K)``: no tree may have product number K of rates."""
    return "".join(f"_seen({number}).\n" for number in numbers)


def write_fewer(units: Mapping[int, int]) -> str:
    """Return facts ``_fewer(K,N)``: trees of fewer than N units may have product number K of rates.

    They are exceptions to the facts of :func:`write_seen`. ``units`` maps K to N.
    """
    return "".join(f"_fewer({number},{count}).\n" for number, count in units.items())


def write_wanted(number: int) -> str:
    """Return the fact ``_wanted(K)``: a tree has to have product number K of rates."""
    return f"_wanted({number}).\n"


def write_for_sale(prices: Mapping[int, int], second_choices: Iterable[int]) -> str:
    """Return facts ``_for_sale(O,Price)`` and ``_second_choice(O)`` about object nodes that may be bought.

    ``prices`` has integers by node number. Of two shopping lists of the same cost and length, the one with
    fewer nodes of second choice is better.
    """
    facts = [f"_for_sale({o},{_check_int32(price)}).\n" for o, price in prices.items()]
    return "".join([*facts, *(f"_second_choice({o}).\n" for o in second_choices)])


def write_found_list(number: int, items: Iterable[int]) -> str:
    """Return facts ``_found_list(K)`` and ``_on_list(K,O)``: a shopping list that is known.

    No further list may contain all items of the known one. ``number`` is K; ``items`` are the numbers of its
    nodes.
    """
    return f"_found_list({number}).\n" + "".join(f"_on_list({number},{o}).\n" for o in items)


def write_constraints(weights: Mapping[int, int], kept: Iterable[int]) -> str:
    """Return facts ``_constraint(C,Weight)``, the cost of dropping constraint C, and ``_kept(C)``.

    Constraints are given by number. Constraints in ``kept`` may not be dropped.
    """
    facts = [f"_constraint({number},{_check_int32(weight)}).\n" for number, weight in weights.items()]
    return "".join([*facts, *(f"_kept({number}).\n" for number in kept)])


def write_corrections(corrections: Iterable[Iterable[int]]) -> str:
    """Return facts ``_correction(K,C)``: constraint C is in correction set number K, from 0.

    If all constraints of a correction set are dropped, there is a tree. Constraints are given by number.
    """
    return "".join(
        f"_correction({index},{number}).\n"
        for index, correction in enumerate(corrections)
        for number in correction
    )


def write_soft(weights: Mapping[int, int]) -> str:
    """Return facts ``_soft(C,Weight)``: the weight of each soft constraint, by number."""
    return "".join(f"_soft({number},{_check_int32(weight)}).\n" for number, weight in weights.items())


def write_least_penalty(priority: int) -> str:
    """Return the fact ``optimize(_soft,Priority)``: the total weight of broken constraints is minimized."""
    return f"optimize(_soft,{priority}).\n"


def write_greatest_penalty(penalty: int) -> str:
    """Return the fact ``_greatest_penalty(N)``: broken constraints may weigh at most N in all."""
    return f"_greatest_penalty({_check_int32(penalty)}).\n"


def write_at_most(number: int, bounds: Mapping[Objective, int]) -> str:
    """Return facts ``_at_most(K,Objective,N)``: at least one of the upper bounds N in set K has to hold.

    ``number`` is K; ``bounds`` has N by objective. Raises ``ValueError`` for ``success``, which is no sum.
    """
    if any(map(multiplies, bounds)):
        raise ValueError("success is a product, and no sum that a bound could be put on")
    return "".join(
        f"_at_most({number},{objective.row.term},{_check_int32(bound)}).\n"
        for objective, bound in bounds.items()
    )


def write_below(below: Iterable[Mapping[Objective, int | Fraction]], scales: Scales) -> str:
    """Return facts ``_at_most(K,Objective,N)``: for each set K of costs, a tree has to undercut at least one.

    Each set in ``below`` has costs by objective; K is its index. Raises :class:`UserError` for an objective
    that is rounded, or by which all units together weigh more than 32 bits.
    """
    return "".join(
        write_at_most(number, {o: scales.cost_weight(o, cost) - 1 for o, cost in costs.items()})
        for number, costs in enumerate(below)
    )


def write_assisted(twins: Mapping[int, int], max_assisted: int) -> str:
    """Return facts ``_takes_over(P,U)`` and ``_at_most_assisted(N)`` about units done by a person.

    ``twins`` maps the number P of a person's unit to the number U of the same unit done by the robot. A tree
    may have at most N units of the person (``max_assisted``).
    """
    facts = [
        f"_takes_over({_check_int32(person_unit)},{robot_unit}).\n"
        for person_unit, robot_unit in twins.items()
    ]
    return "".join([*facts, f"_at_most_assisted({_check_int32(max_assisted)}).\n"])


def write_required(sets: Sequence[Iterable[int]]) -> str:
    """Return facts ``_required(K)`` and ``_one_of(K,U)``: a tree has to have a unit U of each set K.

    ``sets`` have numbers of units; K is the index of a set.
    """
    return "".join(
        "".join(
            [f"_required({index}).\n", *(f"_one_of({index},{_check_int32(number)}).\n" for number in numbers)]
        )
        for index, numbers in enumerate(sets)
    )


def write_known(numbers: Iterable[int]) -> str:
    """Return facts ``_known(U)``: all achievers of the inputs of unit number U are in the facts."""
    return "".join(f"_known({_check_int32(number)}).\n" for number in numbers)


def write_tree(units: Collection[int]) -> str:
    """Return facts ``_tree_size(N)`` and ``_in_tree(U)``: the tree has exactly these units, by number."""
    return f"_tree_size({len(units)}).\n" + "".join(f"_in_tree({unit}).\n" for unit in units)


def write_avoided(number: int, units: Iterable[int]) -> str:
    """Return facts ``_avoid(K,U)``: no tree may have all units U of known tree number K.

    ``number`` is K; ``units`` are the numbers of its units.
    """
    return "".join(f"_avoid({number},{_check_int32(unit)}).\n" for unit in units)


def write_unseen(units: Iterable[int]) -> str:
    """Return a fact ``_unseen(U)`` for each unit number: a tree has to have at least one unit U."""
    return "".join(f"_unseen({_check_int32(unit)}).\n" for unit in units)


def write_in_all(units: Iterable[int]) -> str:
    """Return a fact ``_in_all(U)`` for each unit number: a tree has to lack at least one unit U."""
    return "".join(f"_in_all({_check_int32(unit)}).\n" for unit in units)


def write_avoided_plans(plans: Sequence[Mapping[int, int]]) -> str:
    """Return facts ``_avoid(K,U,N)``: no plan may execute each unit U of known plan K at least N times.

    ``plans`` are the known plans: the number of executions by unit number. K is the index of a plan.
    """
    return "".join(
        f"_avoid({number},{_check_int32(unit)},{count}).\n"
        for number, plan in enumerate(plans)
        for unit, count in plan.items()
    )


def write_given(numbers: Collection[int]) -> str:
    """Return facts ``_given_units(N)`` and ``_given(U)``: the N units that are to be checked as a tree."""
    return f"_given_units({len(numbers)}).\n" + "".join(f"_given({number}).\n" for number in numbers)


def write_same_rates(classes: Sequence[Iterable[int]]) -> str:
    """Return facts ``_same_rate(R,U)``: unit number U has success rate number R.

    ``classes`` has the numbers of the units with each rate; R is the index in ``classes``.
    """
    return "".join(
        f"_same_rate({rate},{number}).\n" for rate, numbers in enumerate(classes) for number in numbers
    )


def write_most_alike(limits: Sequence[int]) -> str:
    """Return facts ``_most_alike(R,N)``: a tree has at most N units of success rate number R, from 0."""
    return "".join(f"_most_alike({rate},{_check_int32(number)}).\n" for rate, number in enumerate(limits))


def write_exactly_alike(numbers: Sequence[int]) -> str:
    """Return facts ``_exactly_alike(R,N)``: a tree has exactly N units of success rate number R, from 0."""
    return "".join(f"_exactly_alike({rate},{_check_int32(number)}).\n" for rate, number in enumerate(numbers))


def write_distances(trees: Sequence[Collection[Hashable]], chosen: int) -> str:
    """Return facts of the distances between trees, and of the number of trees to choose (``chosen``).

    They are ``_tree(T)``, ``_distance(T,S,D)`` for T below S, and ``_chosen_trees(N)``. T and S are indices
    in ``trees``, which are sets of units or of executions. A distance is the number of elements that only one
    of two trees has.
    """
    sets = list(map(frozenset, trees))
    facts = [f"_chosen_trees({chosen}).", *(f"_tree({number})." for number in range(len(sets)))]
    for number, tree in enumerate(sets):
        facts += [
            f"_distance({number},{other_number},{len(tree ^ sets[other_number])})."
            for other_number in range(number + 1, len(sets))
        ]
    return "\n".join(facts) + "\n"


def write_tool_order(
    tools: Sequence[int],
    uses: Iterable[tuple[int, Iterable[int]]],
    after: Iterable[Iterable[int]],
    may_lack: bool,
) -> str:
    """Return facts of tools, their uses, and the order of steps; kinds of tools and steps are numbers from 0.

    They are ``_tools(K,N)``, ``_may_lack(K)``, ``_tool_use(I,K)``, ``_in_use(I,S)`` and ``_waits(S,R)``.

    Parameters:
        tools: The number of tools of each kind.
        uses: For each use of a tool, its kind and the steps during which the tool is in use.
        after: For each step, the steps that have to be done before it.
        may_lack: Whether tools of each kind may be lacking.
    """
    facts = [f"_tools({kind},{_check_int32(count)}).\n" for kind, count in enumerate(tools)]
    facts += [f"_may_lack({kind}).\n" for kind in range(len(tools)) if may_lack]
    for use, (kind, steps) in enumerate(uses):
        facts += [f"_tool_use({use},{kind}).\n", *(f"_in_use({use},{step}).\n" for step in steps)]
    facts += [
        f"_waits({step},{earlier_step}).\n"
        for step, earlier_steps in enumerate(after)
        for earlier_step in sorted(earlier_steps)
    ]
    return "".join(facts)


def quote(text: str) -> str:
    """Return a text as a string of clingo, in quotes; backslashes, quotes and line ends are escaped.

    Raises :class:`UserError` for a text with a zero character or half a character (a surrogate).
    """
    if not text.isascii() or "\0" in text:
        if "\0" in text:
            raise UserError(f"the name {text!r} has a zero character, which the solver cannot be given")
        try:
            text.encode()
        except UnicodeEncodeError:
            raise UserError(
                f"the name {text!r} has half a character, which the solver cannot be given"
            ) from None
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'


def source_names(sources: Iterable[Source]) -> dict[str, None]:
    """Return the names of the sources of a unit: files, with folders and without, and videos.

    They are the keys of the result, each once.
    """
    names: dict[str, None] = {}
    for source in sources:
        names.update(_file_names(source.file))
        names.update(dict.fromkeys(map(encodable, source.videos)))
    return names


@lru_cache(maxsize=1000)  # most units are from the file of the one before
def _file_names(file: str) -> dict[str, None]:
    """Return the names of a file, its path and the path without folders, as keys."""
    return dict.fromkeys(map(encodable, (file, PurePath(file).name)))


def millionths(rate: Fraction) -> int:
    """Return a success rate in millionths, rounded down, as rules read it."""
    return rate.numerator * 1_000_000 // rate.denominator


def _check_int32(number: int) -> int:
    """Return a number unchanged; raises :class:`UserError` if it does not fit into 32 bits."""
    if abs(number) > INT32_MAX:
        raise UserError(f"the number {number} is too large for clingo, whose numbers have 32 bits")
    return number
