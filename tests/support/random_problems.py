"""Small random problems, seeded: cycles, skipped utensils that are put out, costs that collide."""

import random
from fractions import Fraction

import pytest

from foon_asp.network import Network, NetworkBuilder, ObjectNode, Source, UnitPrices
from foon_asp.problem import ContainerRule, Objective, Problem

UTENSILS = frozenset({"bowl", "cup"})
MOTIONS = ("pour", "cut", "mix", "wash", "cook", "bake")

# Products of these collide exactly (0.3 * 0.3 = 0.09, 0.1 * 0.9 = 0.09, 0.5 * 0.18 = 0.09) or nearly
# (0.300000001 * 0.3 and 0.09 * 1 differ in the ninth digit), and 1 costs nothing.
RATES = ("0.3", "0.09", "0.1", "0.9", "0.5", "0.18", "0.300000001", "0.090000001", "1", "0.25")

# Next to 1 and next to 0, where rounded logarithms say nothing, and powers of one base, whose products are
# equal by different ways.
NEAR_1 = ("0.999999999", "0.99999999999", "0." + "9" * 30, "0." + "9" * 29 + "8", "1", "0.999999991")
NEAR_0 = ("0." + "0" * 330 + "3", "0." + "0" * 330 + "2", "0.000000001", "0." + "9" * 30, "1", "0.5")
POWERS = ("0.7", "0.49", "0.343", "0.2401", "1", "0.7")

# Sums of the first collide exactly (0.1 + 0.2 = 0.3) or nearly; others do not fit 32 bits, together or alone.
PRICES = ("0", "0.1", "0.2", "0.3", "0.30000000000000004", "1", "2.5", "12")
FREE = ("0", "0", "0", "1")
TINY = ("0." + "0" * 29 + "1", "0." + "0" * 29 + "2", "0." + "0" * 29 + "3", "0", "0.1")
HUGE = ("2147483647", "2147483648", "4294967295.5", "1" + "0" * 40, "1" + "0" * 39 + "1.1", "0.1")
LONG = ("0." + "12" * 20, "0." + "34" * 20, "0." + "46" * 20, "0." + "46" * 19 + "45", "1." + "0" * 39 + "1")

# Utensils that hold each other: a unit with both as inputs needs neither under ``implied``.
EACH_OTHER = (
    ObjectNode.of("bowl", [], [("in", "cup")], [("contains", ["cup"])]),
    ObjectNode.of("cup", [], [("in", "bowl")], [("contains", ["bowl"])]),
)

# The objectives that differ without stand-ins.
USUAL = [objective for objective in Objective if objective is not Objective.DISSIMILARITY]

# How many seeds of a series a test takes: the first third of them, and all among the slow tests.
SERIES = pytest.mark.parametrize("part", [3, pytest.param(1, marks=pytest.mark.slow)])


def random_problem(seed: int, rule: ContainerRule, units: int = 8, readable: bool = False) -> Problem:
    """Make a problem of at most so many units; the rule changes nothing else.

    Many a unit with salt in a cup has the cup of salt as an input and as an output, which it does not make
    under ``implied``. So has a unit with flour in a bowl, and some of the problems ask for just that.
    """
    rng = random.Random(seed)
    held = random.Random(f"what is held {seed}")  # of its own, so that nothing else changes with it
    odd = random.Random(f"what is odd {seed}")
    salt, cup = (
        ObjectNode.of("salt", [], [("in", "cup")]),
        ObjectNode.of("cup", [], [], [("contains", ["salt"])]),
    )
    flour = ObjectNode.of("flour", [], [("in", "bowl")])
    bowl = ObjectNode.of("bowl", [], [], [("contains", ["flour"])])
    nodes = [
        ObjectNode.of("salt"),
        salt,
        cup,
        ObjectNode.of("cup", ["empty"]),
        ObjectNode.of("bowl", ["empty"]),
        bowl,
        flour,
        ObjectNode.of("bowl", [], [], [("contains", ["flour", "salt"])]),
        ObjectNode.of("dough", ["raw"], [("in", "bowl")]),
        ObjectNode.of("dough", ["baked"], [("on", "tray")]),
        ObjectNode.of("tray", ["hot"], [], [("contains", ["dough"]), ("greased", ["butter"])]),
        ObjectNode.of("knife"),
    ]
    nodes = rng.sample(nodes, rng.randint(6, len(nodes)))
    builder = NetworkBuilder()
    for line in range(rng.randint(units // 2, units)):
        inputs: list[ObjectNode] = rng.sample(nodes, rng.choice((1, 1, 2, 2, 3)))
        if salt in inputs and rng.random() < 0.7:
            inputs.append(cup)
        outputs = rng.sample(nodes, rng.choice((1, 1, 2)))
        for item, vessel in ((salt, cup), (flour, bowl)):
            if item in inputs and held.random() < 0.6:
                inputs.append(vessel)
                outputs.append(vessel)
        if odd.random() < 0.1:
            outputs.append(odd.choice(inputs))
        elif odd.random() < 0.06:
            inputs = list(odd.choice((EACH_OTHER, EACH_OTHER if readable else ())))
        builder.add(rng.choice(MOTIONS), inputs, outputs, Source("random", line + 1))
    network = builder.build()
    objects = range(len(network.objects))
    kitchen = frozenset(rng.sample(objects, min(len(objects), rng.randint(1, 4))))
    if odd.random() < 0.7:  # what some of the units need, so that more can be made, in more steps
        begun = odd.sample(range(len(network)), min(len(network), 2))
        kitchen = frozenset(o for unit in begun for o in network.inputs[unit]) or kitchen
    others = [o for o in objects if o not in kitchen] or list(objects)
    made = set(kitchen)
    late: list[int] = []
    for _ in range(len(network)):
        new = {
            o
            for needs, gives in zip(network.inputs, network.outputs, strict=True)
            if made.issuperset(needs)
            for o in gives
        }
        late = sorted(new - made) or late
        made |= new
    if rng.random() < 0.8:  # mostly ask for what can be made, and sometimes for anything
        others = sorted(made - kitchen) or others
    goals = tuple(rng.sample(others, min(len(others), rng.choice((1, 1, 1, 2)))))
    if late and odd.random() < 0.5:
        goals = (odd.choice(late), *goals[1:])
    vessels = [o for o in objects if network.objects[o] in (cup, bowl) and o not in kitchen]
    if vessels and held.random() < 0.2:
        goals = (held.choice(vessels),)
    if odd.random() < 0.1:
        goals = (*goals, odd.choice((goals[0], *kitchen)))
    rates = {motion: Fraction(rng.choice(RATES)) for motion in MOTIONS}
    if odd.random() < 0.4:
        family = odd.choice((NEAR_1, NEAR_1, NEAR_0, POWERS, POWERS))
        rates = {motion: Fraction(odd.choice(family)) for motion in MOTIONS}
    prices = random_prices(network, seed)
    return Problem(network, kitchen, goals, rates, UTENSILS, rule, unit_prices=prices)


def random_steps(seed: int, rule: ContainerRule, units: int = 9) -> Problem:
    """Make a problem of a few steps, each done by one of several units that differ in all that counts.

    Some need what others need and more, or give more, or less; some skip a step, go back or give what they
    need; what a unit takes from the kitchen costs by some objectives and not by others.
    """
    rng = random.Random(f"steps {seed}")
    steps = [ObjectNode.of("dough", [str(step)]) for step in range(rng.choice((3, 3, 4)))]
    sides = [ObjectNode.of("filling", [str(side)]) for side in range(2)]
    at_hand = [ObjectNode.of(label) for label in ("salt", "yeast", "water", "milk")]
    at_hand[0] = ObjectNode.of("salt", [], [], [("contains", ["grain", "iodine"])])
    builder = NetworkBuilder()
    last = len(steps) - 1
    for line in range(units):
        step = line % last if line < 2 * last else rng.randrange(last)
        inputs = [steps[step], *rng.sample(at_hand, rng.choice((0, 0, 1, 2, 3)))]
        outputs = [steps[step + 1]]
        kind = rng.random()
        if kind < 0.15:
            inputs = [*inputs[1:], rng.choice(at_hand), rng.choice(sides)]
        elif kind < 0.3:
            outputs = [rng.choice(sides)]
        elif kind < 0.45:
            inputs.append(rng.choice(sides))
        elif kind < 0.6:
            outputs.append(rng.choice((*sides, *steps)))
        elif kind < 0.65:
            outputs.append(rng.choice(inputs))
        builder.add(rng.choice(MOTIONS), inputs, outputs, Source("steps", line + 1))
    network = builder.build()
    start = [o for node in (steps[0], *at_hand) if (o := network.object_id(node)) is not None]
    goals = [o for node in (steps[-1], *sides) if (o := network.object_id(node)) is not None]
    goals = goals[: rng.choice((1, 1, 1, 2))]
    family = rng.choice((RATES, RATES, NEAR_1, NEAR_0, POWERS))
    rates = {motion: Fraction(rng.choice(family)) for motion in MOTIONS}
    prices = random_prices(network, seed)
    return Problem(network, frozenset(start), tuple(goals), rates, UTENSILS, rule, unit_prices=prices)


def random_prices(network: Network, seed: int) -> UnitPrices:
    """Give all motions a price, and some of the units one of their own."""
    rng = random.Random(f"prices {seed}")
    family = rng.choice((PRICES, PRICES, PRICES, FREE, TINY, HUGE, LONG))
    every = dict.fromkeys((*MOTIONS, *network.motions))
    motions = {motion: Fraction(rng.choice(family)) for motion in every}
    chosen = [unit for unit in range(len(network)) if rng.random() < 0.4]
    return UnitPrices(motions, {network.unit(unit): Fraction(rng.choice(family)) for unit in chosen})


def random_objectives(rng: random.Random, number: int) -> tuple[Objective, ...]:
    """Draw a list of objectives; of those that may have to be rounded only the first stays."""
    drawn = rng.sample(sorted(USUAL), number)
    rounded = [objective for objective in drawn if not objective.row.whole]
    return tuple(objective for objective in drawn if objective not in rounded[1:])
