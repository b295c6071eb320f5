"""The meanings of the ready-made constraints, computed from the plain network.

Certificates are checked by these meanings, so nothing here uses clingo. Each constraint of
``encodings/constraints`` is a few lines of Python, and :data:`LIBRARY` lists them. docs/dev/certificates.md
says how their meanings enter a proof.
"""

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from fractions import Fraction
from pathlib import PurePath
from typing import Any, NamedTuple, TypeAlias

from foon_asp.network import Network

# A constraint as a certificate states it: its name as ``rule``, and its values by name.
Rule: TypeAlias = Mapping[str, Any]
Units = frozenset[int]  # ids of units
Barred = Callable[[Units, Units], Units]  # from used and excluded units to barred ones (:class:`Meaning`)


class Question(NamedTuple):
    """The parts of a planning question that constraints depend on.

    ``network``: the network; units and nodes are given by id.
    ``kitchen``: the nodes that are available at first.
    ``goals``: the goal nodes.
    ``utensils``: the labels of utensils.
    ``rate``: a function that returns the success rate of a unit; ``None`` if unknown.
    ``price``: a function that returns the price of a unit; ``None`` if unknown.
    ``needs``, ``gives``: functions that return the preconditions and the add effects of a unit, as node ids.
    ``None`` stands for a node that is not in the network.
    """

    network: Network
    kitchen: Collection[int]
    goals: tuple[int, ...]
    utensils: frozenset[str]
    rate: Callable[[int], Fraction | None]
    price: Callable[[int], Fraction | None]
    needs: Callable[[int], frozenset[int | None]]
    gives: Callable[[int], frozenset[int | None]]

    def with_motion(self, motion: str) -> Units:
        """Return the units with a motion, by id."""
        return frozenset(unit for unit, name in enumerate(self.network.motions) if name == motion)

    def touching(self, nodes: Iterable[int]) -> Units:
        """Return the units, by id, that have one of the nodes among their inputs or outputs."""
        touched, network = frozenset(nodes), self.network
        sides = enumerate(zip(network.inputs, network.outputs, strict=True))
        return frozenset(
            unit
            for unit, (inputs, outputs) in sides
            if not (touched.isdisjoint(inputs) and touched.isdisjoint(outputs))
        )

    def labelled(self, label: str) -> list[int]:
        """Return the nodes with a label, by id, ascending."""
        return [o for o, node in enumerate(self.network.objects) if node.label == label]

    def made_with(self, names: Collection[str]) -> list[int]:
        """Return the nodes, by id, with one of the names as label or ingredient, ascending."""
        wanted_names = frozenset(names)
        return [
            o
            for o, node in enumerate(self.network.objects)
            if node.label in wanted_names or not wanted_names.isdisjoint(node.ingredients)
        ]


class Meaning(NamedTuple):
    """The meaning of a constraint: all conditions that a tree has to satisfy. Units are given by id.

    Attributes:
        removed: Units that the tree does not have.
        requirements: Each requirement is a list of alternatives, and the tree satisfies one of them. An
            alternative is a list of sets of units. The tree satisfies it if it has a unit of each set.
        counted_sets: Sets of units, each with an amount from 0. A set counts once if the tree has a unit of
            it.
        max_sum: The greatest sum of the amounts of sets that count; ``None`` for no limit.
        never: Whether no tree satisfies the constraint.
        barred: A function of two sets of units. It returns units that no tree has together with all of the
            first set and none of the second.
        limits: Further limits. Each has the amounts of units, from 0, and the greatest sum for a tree.
    """

    removed: Units = frozenset()
    requirements: Sequence[Sequence[Sequence[Units]]] = ()
    counted_sets: Sequence[tuple[Units, Fraction]] = ()
    max_sum: Fraction | None = None
    never: bool = False
    barred: Barred | None = None
    limits: Sequence[tuple[Mapping[int, Fraction], Fraction]] = ()


class Constraint(NamedTuple):
    """A ready-made constraint.

    ``values``: the type of each value of the constraint, by name; ``list`` is a list of texts.
    ``meaning``: a function from a :class:`Question` and the values, as keyword arguments, to the meaning.
    ``removes``: whether the constraint only removes units.
    ``read_sources``: a function from the network, a unit and the values to what the constraint reads of the
    unit's sources, such as file names. ``None`` if it reads no sources.
    """

    values: Mapping[str, type]
    meaning: Callable[..., Meaning]
    removes: bool = False
    read_sources: Callable[..., Collection[str]] | None = None


def meaning_of_rule(rule: Rule, question: Question) -> Meaning:
    """Return the meaning of a rule of a certificate.

    A rule is one of three: a ready-made constraint with its values, claims about user rules (:data:`OWN`), or
    a list of units that every tree has (:data:`ALL_STEPS`).
    """
    if rule["rule"] == OWN:
        return meaning_of_user_rules(rule)
    if rule["rule"] == ALL_STEPS:
        return Meaning(requirements=[[[frozenset({unit})]] for unit in rule["units"]])
    return LIBRARY[rule["rule"]].meaning(question, **_values_of_rule(rule))


def sources_read(rule: Rule, network: Network) -> list[list[str]] | None:
    """Return for each unit, by id, what a rule reads of the unit's sources, sorted.

    Return ``None`` if the rule reads no sources.
    """
    read_sources = None if rule["rule"] in {OWN, ALL_STEPS} else LIBRARY[rule["rule"]].read_sources
    if read_sources is None:
        return None
    return [sorted(read_sources(network, unit, **_values_of_rule(rule))) for unit in range(len(network))]


def _values_of_rule(rule: Rule) -> dict[str, Any]:
    """Return the values of a ready-made constraint by name, without its own name."""
    return {name: value for name, value in rule.items() if name != "rule"}


def _forbid_motion(question: Question, forbidden_motion: str) -> Meaning:
    """Return a meaning that removes the units with the motion."""
    return Meaning(question.with_motion(forbidden_motion))


def _forbid_object(question: Question, forbidden_object: str) -> Meaning:
    """Return a meaning that removes the units with an object of this label among inputs or outputs."""
    return Meaning(question.touching(question.labelled(forbidden_object)))


def _forbid_ingredient(question: Question, allergen: list[str]) -> Meaning:
    """Return a meaning that removes the units with a tainted object among inputs or outputs.

    A *tainted* object has one of the names in ``allergen`` as its label or as an ingredient. If a goal is
    tainted, no tree satisfies the constraint.
    """
    tainted = question.made_with(allergen)
    return Meaning(question.touching(tainted), never=not set(tainted).isdisjoint(question.goals))


def _least_rate(question: Question, least_rate: int) -> Meaning:
    """Return a meaning that removes the units whose success rate is unknown or below ``least_rate``.

    ``least_rate`` is in millionths. Rates are rounded down to millionths before they are compared.
    """
    rates = map(question.rate, range(len(question.network)))
    reaches_least = [rate is not None and rate * 1_000_000 // 1 >= least_rate for rate in rates]
    return Meaning(frozenset(unit for unit, reaches in enumerate(reaches_least) if not reaches))


def _matching_source_names(network: Network, unit: int, allowed: list[str]) -> set[str]:
    """Return the names in ``allowed`` that name a source of a unit: its path, file name or video address.

    Half letters (surrogates) in a source are replaced by escapes before it is compared.
    """
    return {
        name
        for source in network.sources[unit]
        for name in (source.file, PurePath(source.file).name, *source.videos)
        for name in [name.encode("utf-8", "backslashreplace").decode()]
    }.intersection(allowed)


def _only_sources(question: Question, allowed: list[str]) -> Meaning:
    """Return a meaning that removes the units without an allowed source.

    A source is allowed if ``allowed`` has its path, its file name or its video address.
    """
    network = question.network
    return Meaning(
        frozenset(u for u in range(len(network)) if not _matching_source_names(network, u, allowed))
    )


def _videos(network: Network, unit: int, least_videos: int) -> set[str]:
    """Return the video addresses of all sources of a unit; ``least_videos`` is not read."""
    return {video for source in network.sources[unit] for video in source.videos}


def _at_least_videos(question: Question, least_videos: int) -> Meaning:
    """Return a meaning that removes the units whose sources have fewer videos than ``least_videos``.

    Equal video addresses count once.
    """
    network = question.network
    video_counts = [len(_videos(network, unit, least_videos)) for unit in range(len(network))]
    return Meaning(frozenset(unit for unit, count in enumerate(video_counts) if count < least_videos))


def _motion_only_with(question: Question, tied_motion: str, tied_utensil: str) -> Meaning:
    """Return a meaning that removes the units with the motion but without the utensil.

    A unit has the utensil if an input or output has its label.
    """
    return Meaning(question.with_motion(tied_motion) - question.touching(question.labelled(tied_utensil)))


def _never_heated(question: Question, unheated_ingredient: str, heats: list[str]) -> Meaning:
    """Return a meaning that removes the units that heat the ingredient.

    They have a motion in ``heats``, and an input with the ingredient as its label or among its ingredients.
    """
    network, hot = question.network, frozenset(heats)
    tainted = frozenset(question.made_with([unheated_ingredient]))
    heating = (unit for unit, motion in enumerate(network.motions) if motion in hot)
    return Meaning(frozenset(unit for unit in heating if not tainted.isdisjoint(network.inputs[unit])))


def _require_motion(question: Question, required_motion: str) -> Meaning:
    """Return a meaning that requires a unit with the motion."""
    return Meaning(requirements=[[[question.with_motion(required_motion)]]])


def _require_object(question: Question, required_object: str) -> Meaning:
    """Return a meaning that requires a unit with an object of this label among inputs or outputs."""
    return Meaning(requirements=[[[question.touching(question.labelled(required_object))]]])


def _require_ingredient(question: Question, required_ingredient: str) -> Meaning:
    """Return a meaning that requires a unit with the ingredient in an input or output.

    An input or output with the ingredient as its label counts as well.
    """
    return Meaning(requirements=[[[question.touching(question.made_with([required_ingredient]))]]])


def _require_intermediate(question: Question, required_intermediate: str) -> Meaning:
    """Return a meaning that requires that an object of this label is made and used.

    The tree has to make and to use at least one node of the label that the kitchen does not have. One unit
    needs this node. Another unit makes it and does not need it.
    """
    network = question.network
    alternatives = []
    for o in question.labelled(required_intermediate):
        if o not in question.kitchen:
            consumers = frozenset(unit for unit in network.consumers[o] if o in question.needs(unit))
            alternatives.append([frozenset(network.producers[o]) - consumers, consumers])
    return Meaning(requirements=[alternatives])


def _singletons(units: Iterable[int]) -> list[tuple[Units, Fraction]]:
    """Return for each unit, ascending, a pair: the set of this unit alone, and the amount 1."""
    one = Fraction(1)
    return [(frozenset({unit}), one) for unit in sorted(units)]


def _at_most_units(question: Question, max_units: int) -> Meaning:
    """Return a meaning that limits the number of units."""
    return Meaning(counted_sets=_singletons(range(len(question.network))), max_sum=Fraction(max_units))


def _at_most_motion(question: Question, limited_motion: str, max_uses: int) -> Meaning:
    """Return a meaning that limits the number of units with the motion."""
    return Meaning(counted_sets=_singletons(question.with_motion(limited_motion)), max_sum=Fraction(max_uses))


def _at_most_utensils(question: Question, max_utensils: int) -> Meaning:
    """Return a meaning that limits the number of different labels of utensils.

    It counts the labels of utensils among the inputs and outputs of the tree's units.
    """
    network, utensils = question.network, question.utensils
    labels = {o: node.label for o, node in enumerate(network.objects) if node.label in utensils}
    touching: dict[str, list[int]] = {label: [] for label in sorted(utensils)}
    for unit, sides in enumerate(zip(network.inputs, network.outputs, strict=True)):
        for label in {labels[o] for nodes in sides for o in nodes if o in labels}:
            touching[label].append(unit)
    one = Fraction(1)
    touched = [(frozenset(units), one) for units in touching.values() if units]
    return Meaning(counted_sets=touched, max_sum=Fraction(max_utensils))


def _at_most_utensil_uses(question: Question, limited_utensil: str, max_utensil_uses: int) -> Meaning:
    """Return a meaning that limits the number of units with an input or output of the utensil's label."""
    units = question.touching(question.labelled(limited_utensil))
    return Meaning(counted_sets=_singletons(units), max_sum=Fraction(max_utensil_uses))


def _at_most_price(question: Question, max_price: int) -> Meaning:
    """Return a meaning that limits the sum of the units' prices to ``max_price`` hundredths.

    It removes the units without a known price.
    """
    prices = {unit: question.price(unit) for unit in range(len(question.network))}
    unknown = frozenset(unit for unit, price in prices.items() if price is None)
    priced_units = [(frozenset({unit}), price * 100) for unit, price in prices.items() if price is not None]
    return Meaning(unknown, counted_sets=priced_units, max_sum=Fraction(max_price))


def _not_both_motions(question: Question, one_motion: str, other_motion: str) -> Meaning:
    """Return a meaning by which a tree has units with at most one of the two motions."""
    motions = [question.with_motion(motion) for motion in (one_motion, other_motion)]
    return Meaning(counted_sets=[(units, Fraction(1)) for units in motions], max_sum=Fraction(1))


def _before(question: Question, earlier_motion: str, later_motion: str) -> Meaning:
    """Return a meaning that bars units with the later motion that cannot come after the earlier motion.

    On a branch of a proof, some units are used and others excluded. A node is *early* if it is in the
    kitchen, or if the used units can make it without the earlier motion. Another node is *late* if a unit
    that is not excluded makes it, and has the earlier motion or needs a late node. A unit with the later
    motion is barred if it needs no late node. If both motions are equal, no unit is barred.
    """
    network, needs, gives = question.network, question.needs, question.gives
    with_earlier = question.with_motion(earlier_motion)
    with_later = question.with_motion(later_motion) - with_earlier

    def early(used: Units) -> set[int | None]:
        """Return the early nodes: kitchen nodes, and those that ``used`` units make without the motion."""
        early_nodes: set[int | None] = set(question.kitchen)
        waiting = used - with_earlier
        while running := {unit for unit in waiting if needs(unit) <= early_nodes}:
            early_nodes.update(o for unit in running for o in gives(unit))
            waiting -= running
        return early_nodes

    def barred(used: Units, without: Units) -> Units:
        """Return the units with the later motion that need no late node."""
        early_nodes = early(used)
        late: set[int | None] = set()
        stack = list(with_earlier - without)
        for unit in stack:  # grows while it is walked through
            for o in gives(unit) - early_nodes - late:
                late.add(o)
                consumers = network.consumers[o] if o is not None else ()
                stack += (u for u in consumers if u not in without and o in needs(u))
        return frozenset(unit for unit in with_later if late.isdisjoint(needs(unit)))

    return Meaning(barred=barred)


ALL_STEPS = "all_steps"  # in place of a constraint's name: units that every tree has, by id
OWN = "own"  # in place of a constraint's name: user rules


def meaning_of_user_rules(rule: Rule) -> Meaning:
    """Return the meaning of claims about user rules, which a certificate takes on trust.

    A claim is a pair of sets of units: no tree has all units of the first and none of the second. If the
    first set has one unit and the second is empty, this unit is removed. If the first set is empty, a unit of
    the second is required. Other claims bar units. ``rule`` also has limits on sums of amounts.
    """
    claims = [(frozenset(used), frozenset(without)) for used, without in rule["claims"]]
    removed = [used for used, without in claims if len(used) == 1 and not without]
    requirements = [[[without]] for used, without in claims if not used]
    barring_claims = [(used, without) for used, without in claims if used and (len(used) > 1 or without)]

    def barred(used: Units, without: Units) -> Units:
        """Return the units that claims bar (unit propagation).

        A claim bars units only if all units of its second set are excluded. If all units of its first set but
        one are used, the claim bars this one. If all of them are used, it bars the whole first set.
        """
        unused = [used_together - used for used_together, excluded in barring_claims if excluded <= without]
        broken = [
            used_together
            for used_together, excluded in barring_claims
            if excluded <= without and used_together <= used
        ]
        return frozenset().union(*(remaining for remaining in unused if len(remaining) == 1), *broken)

    limits = [
        ({unit: Fraction(amount) for amount, units in amounts.items() for unit in units}, Fraction(max_sum))
        for amounts, max_sum in rule["limits"]
    ]
    bars = barred if barring_claims else None
    return Meaning(frozenset().union(*removed), requirements, barred=bars, limits=limits)


LIBRARY: Mapping[str, Constraint] = {
    "forbid_motion": Constraint({"forbidden_motion": str}, _forbid_motion, removes=True),
    "forbid_object": Constraint({"forbidden_object": str}, _forbid_object, removes=True),
    "forbid_ingredient": Constraint({"allergen": list}, _forbid_ingredient),
    "least_rate": Constraint({"least_rate": int}, _least_rate, removes=True),
    "only_sources": Constraint(
        {"allowed": list}, _only_sources, removes=True, read_sources=_matching_source_names
    ),
    "at_least_videos": Constraint(
        {"least_videos": int}, _at_least_videos, removes=True, read_sources=_videos
    ),
    "motion_only_with": Constraint(
        {"tied_motion": str, "tied_utensil": str}, _motion_only_with, removes=True
    ),
    "never_heated": Constraint({"unheated_ingredient": str, "heats": list}, _never_heated, removes=True),
    "require_motion": Constraint({"required_motion": str}, _require_motion),
    "require_object": Constraint({"required_object": str}, _require_object),
    "require_ingredient": Constraint({"required_ingredient": str}, _require_ingredient),
    "require_intermediate": Constraint({"required_intermediate": str}, _require_intermediate),
    "at_most_units": Constraint({"max_units": int}, _at_most_units),
    "at_most_motion": Constraint({"limited_motion": str, "max_uses": int}, _at_most_motion),
    "at_most_utensils": Constraint({"max_utensils": int}, _at_most_utensils),
    "at_most_utensil_uses": Constraint(
        {"limited_utensil": str, "max_utensil_uses": int}, _at_most_utensil_uses
    ),
    "at_most_price": Constraint({"max_price": int}, _at_most_price),
    "not_both_motions": Constraint({"one_motion": str, "other_motion": str}, _not_both_motions),
    "before": Constraint({"earlier_motion": str, "later_motion": str}, _before),
}
