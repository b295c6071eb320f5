"""Seeded synthetic FOONs of any size, as a folder that ``foon-asp solve --data FOLDER`` reads.

    python benchmarks/generate.py --family recipe-like --units 100000 --seed 1 --out DIR

The folder gets ``FOON.txt``, ``kitchen.json``, ``motion.txt``, ``utensils.txt`` and ``goal_nodes.json``. Same
family, size and seed give the same bytes. Three families:

- ``recipe-like``: recipes in long chains with little choice; they use dishes of earlier recipes, and the
  recipes of one kitchen share its bowls and pans, which are empty, full and empty again;
- ``deep``: short recipes, each built upon the deepest dishes there are, so that trees have many layers;
- ``adversarial``: every intermediate product may be used by any recipe and be got back from any later one,
  with two to three ways to make most things: one giant cyclic component. Its units are shuffled, 2,000
  at a time; those of the others stand in an order that executes.

What holds by construction:

*Each goal has a tree.* Units are made one after the other, and each takes only kitchen items and outputs of
units made before it (:func:`unit_stream`); so all of them execute in that order, every object node can be
made, and goals are chosen among the nodes made. Choice and cycles come from further units for nodes that are
made already; those never have to be used.

*Units are distinct.* What recipes share (washing a bowl, chopping an onion, lighting a stove) is made once,
when first asked for. Every other unit has a node with the name of the dish that its own recipe makes, which
no earlier unit can have; within a recipe doubles are dropped.

*Shape.* 1 to 5 inputs and 1 to 3 outputs to a unit, 1 to 6 state lines to a node, at most 4 producers to a
node. Goals lie up to 40 layers above the kitchen. They are listed from easy to hard: first those whose whole
cone is small in any network (some ten to some hundred units; up to a thousand in ``adversarial``), then those
whose cone grows with the network, each group by depth.
"""

import argparse
import json
import random
from collections.abc import Generator, Iterable, Iterator, Sequence
from enum import StrEnum
from itertools import count, islice
from pathlib import Path
from typing import NamedTuple

MOST_PRODUCERS = 4
DEEPEST = 40
LEAST_UNITS = 200  # below this there may be no finished dish to ask for

_KEPT = 20_000  # products at hand for later recipes; older ones give way, so memory does not grow
_BATCH = 2_000  # units written at once, and shuffled among each other where order shall tell nothing


def _words(text: str) -> tuple[str, ...]:
    return tuple(text.split())


_INGREDIENTS = _words("""
almond anise apple apricot barley basil bean beet berry bran butter cacao caper carob carrot cashew celery
chard cheese cherry chili chive cinnamon clove cocoa coconut cod corn crab cream cress cumin currant curry
date dill duck egg endive fennel fig flour garlic ghee ginger grape guava ham hazelnut honey juniper kale
kiwi lamb leek lemon lentil lime lychee mace maize malt mango maple melon milk millet mint miso molasses
mushroom mussel nettle nutmeg oat okra olive onion orange orzo papaya parsley parsnip pea peach peanut pear
pecan pepper pickle plum polenta potato prawn prune pumpkin quince quinoa radish raisin rhubarb rice rye
saffron sage salmon salt sesame shallot sorrel soy spelt spinach squash sugar swede tahini tarragon thyme
tofu tomato trout tuna turnip vanilla vinegar walnut yam yeast yogurt zucchini
""")
_STYLES = _words("""
airy baked bitter blond bold bright brown clear coarse cold cool crisp dark dense dry early easy extra fair
fiery fine firm fluffy fresh frosty glazed gold green hearty herbal icy jolly late lean light lively lush
mellow merry mild misty moist mossy nutty pale plain plump quick red rich royal rustic salty sharp silky slow
smoky smooth soft sour spicy sunny sweet tangy tart tender thick warm white wild
""")
_KINDS = _words("""
bake bar batter bisque bites bread broth bun cake casserole chowder cobbler compote crepe crisps crumble
cutlet dip dough drink dumpling filling fritter glaze gratin hash jam jelly loaf mash mousse muffin paste
patty pie pilaf pudding puree ragout relish risotto roast roll salad sauce sherbet skewer soup spread stew
stir-fry stuffing syrup tart terrine toast topping wrap
""")
_SIZES = _words("big deep flat large little long low narrow new old round short small spare tall wide")
_VESSELS = _words(
    "basin beaker bowl cauldron crock dish form jug kettle mold pan pot skillet tin tray tub wok"
)
_MATERIALS = _words("""
ash birch brass cedar clay copper cork elm glass granite iron larch linen maple marble oak pine plastic slate
steel stone teak tiled tin walnut
""")
_FURNITURE = _words(
    "bench board cart counter desk hob island ledge rack shelf sill stand stool table trolley"
)
_HOLDERS = _words("bag bottle box can cup jar packet sack")
_RAW = _words("whole fresh raw dried ripe")
_CUTTING = {"chop": "chopped", "slice": "sliced", "dice": "diced", "grate": "grated", "mince": "minced"}
_BOARDS = ("cutting board", "chopping board")
_KNIVES = ("knife", "paring knife", "cleaver", "grater", "mandoline", "mezzaluna")
_TOOLS = _words("fork ladle masher scoop spatula spoon tongs turner whisk brush")
_APPLIANCES = tuple(
    f"{kind} {what}" for kind in ("electric", "gas", "steam") for what in ("grill", "oven", "stove")
)
_COOKING = {
    "bake": "baked", "beat": "beaten", "blend": "blended", "boil": "boiled", "braise": "braised",
    "brown": "browned", "chill": "chilled", "cook": "cooked", "cool": "cooled", "fold": "folded",
    "fry": "fried", "glaze": "glazed", "grill": "grilled", "heat": "heated", "knead": "kneaded",
    "mash": "mashed", "melt": "melted", "mix": "mixed", "poach": "poached", "press": "pressed",
    "reduce": "reduced", "rest": "rested", "roast": "roasted", "sear": "seared", "shape": "shaped",
    "simmer": "simmered", "steam": "steamed", "stir": "stirred", "strain": "strained", "toast": "toasted",
    "toss": "tossed", "whip": "whipped",
}  # fmt: skip
_ADDING = ["add", "pour", "sprinkle", "scoop", "drizzle", "place", "spread", "drop"]
_MOVING = ["pour", "scoop and pour", "scrape", "pick-and-place", "tip", "ladle", "turn out"]
_REUSING = ["rework", "reheat and mix", "stretch", "trim and add", "thin out", "thicken", "season again"]
_TAKING = ["set aside", "skim off", "spoon off", "pour off", "divide", "separate"]
_WARMTHS = ["warm", "hot", "covered", "steaming", "bubbling"]
_WAYS_TO_COOK = [*_COOKING, *(f"{verb} and {other}" for verb in ("stir", "turn") for other in _COOKING)]
_SHARED = ("wash", "rinse", "dry", "wipe", "turn on", "combine", "serve")
_MOTIONS = tuple(
    dict.fromkeys([*_CUTTING, *_WAYS_TO_COOK, *_ADDING, *_MOVING, *_REUSING, *_TAKING, *_SHARED])
)


class Family(StrEnum):
    """What kind of network; see the top of this file."""

    RECIPE_LIKE = "recipe-like"
    DEEP = "deep"
    ADVERSARIAL = "adversarial"


class Dialect(StrEnum):
    """How the text is written: ``plain`` as merged networks are, or with ids, motion flags and times."""

    PLAIN = "plain"
    IDS = "ids"


class _Shape(NamedTuple):
    """What makes a family. What is a float is a chance."""

    steps: tuple[int, int]  # fewest and most motions from the first mixture to the dish
    start: float  # the first mixture is of another recipe's product
    dish: float  # an ingredient added is
    tries: int  # so many such products are looked at, and the deepest is taken
    extra: tuple[float, float, float]  # a product has at least two, three, four ways to be made
    parallel: float  # a further way is another motion on the same inputs ...
    exchange: float  # ... or takes another tool or form of an ingredient; else it uses leftovers
    take_back: float  # after a step, an earlier product is got back from the present one
    exported: float  # a product on the way is left for other recipes; dishes always are
    simple: float  # a recipe uses only the kitchen and what recipes like it made
    recipes: int | None  # so many share vessels; ``None`` when all do
    vessels: int  # there is one for so many units


_SHAPES = {
    Family.RECIPE_LIKE: _Shape((9, 18), 0.3, 0.12, 1, (0.12, 0.04, 0.01), 0.4, 0.4, 0.0, 0.1, 0.12, 48, 18),
    Family.DEEP: _Shape((5, 9), 0.9, 0.2, 12, (0.2, 0.07, 0.02), 0.3, 0.3, 0.0, 0.1, 0.12, 48, 10),
    Family.ADVERSARIAL: _Shape((4, 10), 0.6, 0.6, 1, (0.8, 0.45, 0.15), 0.1, 0.1, 0.6, 1.0, 0.04, None, 60),
}


class Node:
    """An object node while the network is made.

    ``depth`` is how many layers of units lie below it in the way known when it was last looked at (0 in the
    kitchen); ``producers`` counts the units made so far that give it. ``simple`` is set where everything
    that can lead to it are kitchen items, what is shared, and recipes that are simple themselves.
    """

    __slots__ = (
        "contents", "depth", "kitchen", "label", "lines", "number", "producers", "relations", "simple",
        "states",
    )  # fmt: skip

    def __init__(
        self,
        number: int,
        label: str,
        states: tuple[str, ...],
        relations: tuple[tuple[str, str], ...],
        contents: tuple[str, ...],
        kitchen: bool,
        simple: bool,
    ) -> None:
        self.number = number
        self.label = label
        self.states = states
        self.relations = relations
        self.contents = contents
        self.kitchen = kitchen
        self.simple = simple
        self.depth = 0 if kitchen else DEEPEST
        self.producers = 0
        self.lines = ""  # the state lines, once they were written

    @property
    def entry(self) -> dict[str, object]:
        """What a kitchen or goals file says of it."""
        return {
            "label": self.label,
            "states": list(self.states),
            "ingredients": list(self.contents),
            "container": self.relations[0][1] if self.relations else None,
        }


class Unit(NamedTuple):
    """A functional unit: a motion from input nodes to output nodes, the main one first."""

    motion: str
    inputs: tuple[Node, ...]
    outputs: tuple[Node, ...]


class Goals:
    """Picks goals while nodes are made: two of each difficulty, all nodes being as likely as another."""

    _EACH = 2

    def __init__(self, rng: random.Random) -> None:
        self._rng = rng
        self._met: dict[tuple[bool, int], int] = {}
        self._chosen: dict[tuple[bool, int], list[Node]] = {}

    def offer(self, node: Node) -> None:
        """Note a node that has been made."""
        difficulty = (not node.simple, min(node.depth, DEEPEST - 1) // 10)
        met = self._met[difficulty] = self._met.get(difficulty, 0) + 1
        chosen = self._chosen.setdefault(difficulty, [])
        if len(chosen) < self._EACH:
            chosen.append(node)
        elif (place := int(self._rng.random() * met)) < self._EACH:
            chosen[place] = node

    @property
    def nodes(self) -> list[Node]:
        """The goals from easy to hard; no two have one label, so that each can be asked for by it."""
        chosen = [node for nodes in self._chosen.values() for node in nodes]
        chosen.sort(key=lambda node: (not node.simple, node.depth, node.number))
        return list({node.label: node for node in chosen}.values())


class _Vessel(NamedTuple):
    """A vessel in its place. Where ``empty`` is not in the kitchen, ``dirty`` is, to be washed and dried."""

    label: str
    place: tuple[str, str]
    dirty: Node
    empty: Node


_Making = Generator[Unit, None, None]
_Taking = Generator[Unit, None, tuple[Node, ...]]  # gives the units that are needed first, then the nodes


class _World:
    """What recipes share: vessels, ingredients, tools, appliances, and the products that others made.

    It does not grow with the number of units, but for the vessels, of which there are far fewer.
    """

    def __init__(self, family: Family, units: int, rng: random.Random) -> None:
        self.shape = _SHAPES[family]
        # The one method of Random that gives the same numbers in every version of Python.
        self.chance = rng.random
        self._numbers = 0
        self._items: dict[tuple[str, ...], Node] = {}
        self._products: tuple[list[Node], list[Node]] = ([], [])  # all, and the simple ones
        self._seen: set[tuple[str, frozenset[int], frozenset[int]]] = set()
        places = [f"{material} {furniture}" for material in _MATERIALS for furniture in _FURNITURE]
        kinds = [f"{size} {vessel}" for size in _SIZES for vessel in _VESSELS]
        count = min(max(24, units // self.shape.vessels), len(kinds) * len(places))
        self._vessels = [
            self._vessel(kinds[i % len(kinds)], ("on", places[i // len(kinds)]), at_hand=i % 3 == 0)
            for i in range(count)
        ]

    def recipes(self, goals: Goals) -> _Making:
        """Give the units of one recipe after the other, without end."""
        for number in count():
            self._seen.clear()
            yield from _Recipe(self, number, goals).units()

    def node(
        self,
        label: str,
        states: tuple[str, ...] = (),
        relations: tuple[tuple[str, str], ...] = (),
        contents: tuple[str, ...] = (),
        kitchen: bool = False,
        simple: bool = True,
    ) -> Node:
        """Make a new node."""
        self._numbers += 1
        return Node(self._numbers, label, states, relations, contents, kitchen, simple)

    def pick(self, words: Sequence[str]) -> str:
        """Give any of some words."""
        return words[int(self.chance() * len(words))]

    def unit(self, motion: str, inputs: Iterable[Node], outputs: Sequence[Node]) -> _Making:
        """Make a unit that this recipe does not have, unless its main output has enough producers.

        Other outputs that have enough are left out.
        """
        ins = tuple(dict.fromkeys(inputs))
        outs = (outputs[0], *(node for node in outputs[1:] if node.producers < MOST_PRODUCERS))
        key = (motion, frozenset(node.number for node in ins), frozenset(node.number for node in outs))
        if outs[0].producers >= MOST_PRODUCERS or key in self._seen:
            return
        self._seen.add(key)
        depth = 1 + max(node.depth for node in ins)
        for node in outs:
            node.producers += 1
            node.depth = min(node.depth, depth)
        yield Unit(motion, ins, outs)

    def vessels(self, recipe: int, simple: bool) -> list[_Vessel]:
        """Choose two to five vessels of different labels; a simple recipe's are in the kitchen."""
        together = self.shape.recipes or len(self._vessels)
        first = recipe // together * together
        chosen: dict[str, _Vessel] = {}
        for drawn in count():
            if len(chosen) == 5 or (drawn >= 30 and len(chosen) >= 2):
                break
            vessel = self._vessels[(first + int(self.chance() * together)) % len(self._vessels)]
            if vessel.empty.kitchen or not simple:
                chosen.setdefault(vessel.label, vessel)
        return list(chosen.values())

    def cleaned(self, vessel: _Vessel) -> _Making:
        """Make a vessel empty that never was."""
        if not vessel.empty.kitchen and not vessel.empty.producers:
            wet = self.node(vessel.label, ("wet",), (vessel.place,), simple=False)
            sponge, towel = self._item("sponge", "wet"), self._item("towel", "dry")
            yield from self.unit(self.pick(("wash", "rinse")), (vessel.dirty, sponge), (wet,))
            yield from self.unit(self.pick(("dry", "wipe")), (wet, towel), (vessel.empty,))

    def ingredient(self, name: str) -> _Taking:
        """Take an ingredient in any form: as the kitchen has it, or cut."""
        raw = _RAW[len(name) % len(_RAW)]
        if self.chance() < 0.6:
            holder = self.pick(_HOLDERS)
            loose = self._item(name, "", ("in", holder))
            return (loose, self._item(holder, contents=name)) if self.chance() < 0.4 else (loose,)
        motion, board = self.pick(list(_CUTTING)), self.pick(_BOARDS)
        cut = self._item(name, _CUTTING[motion], ("on", board), kitchen=False)
        if not cut.producers:
            inputs = (
                self._item(name, raw),
                self._item(self.pick(_KNIVES), "clean"),
                self._item(board, "clean"),
            )
            full = self._item(board, contents=name, kitchen=False)
            yield from self.unit(motion, inputs, (cut, full))
        return (cut,)

    def tool(self) -> Node:
        """Take a tool that is always at hand."""
        return self._item(self.pick(_TOOLS), "clean")

    def appliance(self) -> _Taking:
        """Take an oven or stove, which has to be turned on once."""
        label = self.pick(_APPLIANCES)
        on = self._item(label, "on", kitchen=False)
        if not on.producers:
            yield from self.unit("turn on", (self._item(label, "off"),), (on,))
        return (on,)

    def keep(self, product: Node) -> None:
        """Leave a product for other recipes, in place of another one when there are many."""
        for products in self._products[: 1 + product.simple]:
            if len(products) < _KEPT:
                products.append(product)
            else:
                products[int(self.chance() * _KEPT)] = product

    def kept(self, depths: range, simple: bool, tries: int) -> Node | None:
        """Take a product with a depth in a range, the deepest of so many looked at."""
        products = self._products[simple]
        looked_at = [products[int(self.chance() * len(products))] for _ in range(tries if products else 0)]
        fitting = [node for node in looked_at if node.depth in depths]
        return max(fitting, key=lambda node: node.depth, default=None)

    def _item(
        self,
        label: str,
        state: str = "",
        *relations: tuple[str, str],
        contents: str = "",
        kitchen: bool = True,
    ) -> Node:
        """Give the one node of this kind; ``contents`` is a single ingredient."""
        key = (label, state, contents, *(part for relation in relations for part in relation))
        if key not in self._items:
            states, held = (state,) if state else (), (contents,) if contents else ()
            self._items[key] = self.node(label, states, relations, held, kitchen)
        return self._items[key]

    def _vessel(self, label: str, place: tuple[str, str], at_hand: bool) -> _Vessel:
        dirty = self.node(label, ("dirty",), (place,), kitchen=True)
        return _Vessel(label, place, dirty, self.node(label, ("empty",), (place,), (), at_hand, at_hand))


class _Recipe:
    """One dish: a first mixture, to which is added, which is cooked and moved about, and which is served.

    Every node made here has the dish's name as its label, as contents or in a relation. The product is a new
    node after every step, since each adds an ingredient, or gives a state or goes to a vessel that the dish
    has not had before.
    """

    def __init__(self, world: _World, number: int, goals: Goals) -> None:
        self._world = world
        self._goals = goals
        self._dish = dish_name(number)
        self._simple = world.chance() < world.shape.simple
        self._vessels = world.vessels(number, self._simple)
        self._verbs = list(_COOKING)  # each cooks a dish once
        self._warmths: list[str] = []  # what the vessel in use has not been
        self._had: set[str] = {self._dish}  # the ingredients
        # The product and what is known of it.
        self._contents: tuple[str, ...] = ()
        self._states: tuple[str, ...] = ("combined",)
        self._vessel = self._vessels.pop()
        self._full: Node
        self._product: Node

    def units(self) -> _Making:
        """Give the units of the recipe, each after all that it needs."""
        world, shape = self._world, self._world.shape
        fewest, most = shape.steps
        steps = fewest + int(world.chance() * (most - fewest + 1))
        yield from self._mix(range(DEEPEST - steps - 2))
        for step in range(steps):
            kind = world.chance()
            if step == steps - 1:
                yield from self._move("serve", ("served",))
            elif kind < 0.2 and len(self._vessels) > 1:
                yield from self._move(world.pick(_MOVING), self._states)
            elif kind < 0.65 and len(self._contents) < 3:
                yield from self._add()
            else:
                yield from self._cook()
            if step == 2 and self._simple:
                self._goals.offer(self._product)
            if step == steps - 1 or world.chance() < shape.exported:
                world.keep(self._product)
            if world.chance() < shape.take_back:
                yield from self._take_back()
        self._goals.offer(self._product)

    def _mix(self, depths: range) -> _Making:
        yield from self._world.cleaned(self._vessel)
        start = yield from self._ingredient(self._world.shape.start, depths)
        other = yield from self._ingredient(0, depths)
        empty = self._vessel.empty
        self._warmths = list(_WARMTHS)
        self._full = self._holding()
        self._product = self._current()
        yield from self._made("combine", (*start, *other, empty), (self._product, self._full), start[0])

    def _add(self) -> _Making:
        chance, before = self._world.chance, self._product
        taken = yield from self._ingredient(self._world.shape.dish, range(before.depth + 1))
        name = taken[0].label
        self._contents = (*self._contents, name)
        self._product = self._current()
        inputs = [before, *taken]
        if chance() < 0.8:
            inputs.append(self._full)
        if chance() < 0.25:
            inputs.append(self._world.tool())
        outputs = [self._product]
        if chance() < 0.7:
            within = (("in", self._vessel.label), ("with", self._dish))
            outputs.append(self._world.node(name, (), within, simple=self._simple))
        yield from self._made(self._world.pick(_ADDING), inputs, outputs, taken[0])

    def _cook(self) -> _Making:
        world, before, full = self._world, self._product, self._full
        verb = self._verbs.pop(int(world.chance() * len(self._verbs)))
        kept = self._states[-3:] if world.chance() < 0.2 else ()
        self._states = (*kept, _COOKING[verb])
        if len(self._contents) > 2:
            self._contents = ()  # they have become one thing
        self._product = self._current()
        inputs = [before]
        if world.chance() < 0.9:
            inputs.append(full)
        exchangeable = (yield from world.appliance())[0] if world.chance() < 0.5 else world.tool()
        if world.chance() < 0.85:
            inputs.append(exchangeable)
        outputs = [self._product]
        if self._warmths and world.chance() < 0.75:
            self._full = self._holding(self._warmths.pop(int(world.chance() * len(self._warmths))))
            outputs.append(self._full)
        yield from self._made(verb, inputs, outputs, exchangeable)

    def _move(self, motion: str, states: tuple[str, ...]) -> _Making:
        world, before, full, emptied = self._world, self._product, self._full, self._vessel
        self._vessel = self._vessels.pop()
        yield from world.cleaned(self._vessel)
        self._states = states
        self._warmths = list(_WARMTHS)
        self._full = self._holding()
        self._product = self._current()
        tool = world.tool()
        inputs = [before, full, self._vessel.empty]
        if world.chance() < 0.3:
            inputs.append(tool)
        yield from self._made(motion, inputs, (self._product, self._full, emptied.empty), tool)

    def _current(self) -> Node:
        within = (("in", self._vessel.label),)
        return self._world.node(self._dish, self._states, within, self._contents, simple=self._simple)

    def _holding(self, warmth: str = "") -> Node:
        return self._world.node(
            self._vessel.label, (warmth,) if warmth else (), (), (self._dish,), simple=self._simple
        )

    def _ingredient(self, dish: float, depths: range) -> _Taking:
        """Take something that the recipe has not had: by chance the product of another, with such a depth."""
        world = self._world
        if world.chance() < dish:
            product = world.kept(depths, self._simple, world.shape.tries)
            if product is not None and product.label not in self._had:
                self._had.add(product.label)
                return (product,)
        name = world.pick(_INGREDIENTS)
        while name in self._had:
            name = world.pick(_INGREDIENTS)
        self._had.add(name)
        return (yield from world.ingredient(name))

    def _made(
        self, motion: str, inputs: Iterable[Node], outputs: Sequence[Node], exchangeable: Node
    ) -> _Making:
        """Make a unit, and by chance other ways to its main output."""
        world, shape = self._world, self._world.shape
        inputs = tuple(inputs)
        yield from world.unit(motion, inputs, outputs)
        how_many = world.chance()
        for chance in shape.extra:
            if how_many >= chance:
                break
            kind = world.chance()
            if kind < shape.parallel:
                yield from world.unit(world.pick(_MOTIONS), inputs, outputs)
            elif kind < shape.parallel + shape.exchange:
                other = yield from self._in_place_of(exchangeable)
                exchanged = (node for node in inputs if node is not exchangeable)
                yield from world.unit(motion, (*exchanged, other), outputs)
            else:
                yield from self._reused(outputs)

    def _in_place_of(self, node: Node) -> Generator[Unit, None, Node]:
        world = self._world
        if node.label in _INGREDIENTS:
            return (yield from world.ingredient(node.label))[0]
        if node.label in _APPLIANCES:
            return (yield from world.appliance())[0]
        product = None if node.label in _TOOLS else world.kept(range(node.depth + 1), self._simple, 4)
        return product or world.tool()

    def _reused(self, outputs: Sequence[Node]) -> _Making:
        """Make the product out of what other recipes made, at most a few layers lower."""
        world, depth = self._world, outputs[0].depth
        found = [world.kept(range(max(1, depth - 3), depth + 3), self._simple, 6) for _ in range(2)]
        used = [node for node in found if node is not None and node.label != self._dish]
        if used:
            used += [world.tool()] if len(used) == 1 or world.chance() < 0.5 else []
            yield from world.unit(world.pick(_REUSING), used, outputs[: 1 + (world.chance() < 0.7)])

    def _take_back(self) -> _Making:
        """Get a product of another recipe out of the present one: the way back in a cycle."""
        world, product = self._world, self._product
        target = world.kept(range(1, product.depth + 2), False, 4)
        if target is not None and not target.simple and target.label != self._dish:
            inputs = [product, self._full]
            if world.chance() < 0.5:
                inputs.append(world.tool())
            yield from world.unit(world.pick(_TAKING), inputs, (target,))


class _Text:
    """Writes units in one dialect."""

    def __init__(self, dialect: Dialect) -> None:
        self._with_ids = dialect is Dialect.IDS
        self._ids: dict[tuple[str, str], int] = {}
        self._last: dict[str, int] = {}

    def unit(self, unit: Unit, index: int) -> str:
        """Give the lines of a unit, the closing ``//`` included."""
        if not self._with_ids:
            inputs = "".join([f"O\t{node.label}\n{self._states(node)}" for node in unit.inputs])
            outputs = "".join([f"O\t{node.label}\n{self._states(node)}" for node in unit.outputs])
            return f"{inputs}M\t{unit.motion}\n{outputs}//\n"
        lines = [self._object(node, index + place) for place, node in enumerate(unit.inputs)]
        begin = index * 37 % 3000
        times = "Assumed\tAssumed"
        if index % 3:
            end = begin + 1 + index % 50
            times = f"{begin // 60}:{begin % 60:02}\t{end // 60}:{end % 60:02}"
        star = "*" * (index % 7 == 0)
        lines.append(f"{self._id('M', unit.motion)}\t{unit.motion}{star}\t{times}\n")
        lines += [self._object(node, index) for node in unit.outputs]
        return f"{''.join(lines)}//\n".replace("\n", "\r\n")

    def _object(self, node: Node, flag: int) -> str:
        return f"{self._id('O', node.label)}\t{node.label}\t{flag % 2}\n{self._states(node)}"

    def _states(self, node: Node) -> str:
        if not node.lines:
            lines = [f"{self._id('S', state)}\t{state}\n" for state in node.states]
            lines += [f"{self._id('S', word)}\t{word}\t[{what}]\n" for word, what in node.relations]
            if node.contents:
                lines.append(f"{self._id('S', 'contains')}\tcontains\t{{{','.join(node.contents)}}}\n")
            node.lines = "".join(lines)
        return node.lines

    def _id(self, letter: str, name: str) -> str:
        """Give the letter and the id of a name, which counts the names of that letter."""
        if not self._with_ids:
            return letter
        found = self._ids.get((letter, name))
        if found is None:
            found = self._ids[letter, name] = self._last[letter] = self._last.get(letter, -1) + 1
        return f"{letter}{found}"


class Written(NamedTuple):
    """How much was written."""

    units: int
    kitchen: int
    goals: int


def dish_name(recipe: int) -> str:
    """Give a name that no other recipe has: ``smoky pumpkin stew``."""
    names = len(_STYLES) * len(_INGREDIENTS) * len(_KINDS)
    again, index = divmod(recipe, names)
    index = index * 7_919 % names  # a prime that divides no such number: neighbours get unlike names
    index, style = divmod(index, len(_STYLES))
    kind, ingredient = divmod(index, len(_INGREDIENTS))
    name = f"{_STYLES[style]} {_INGREDIENTS[ingredient]} {_KINDS[kind]}"
    return f"{name} no. {again + 1}" if again else name


def unit_stream(family: Family, units: int, seed: int, goals: Goals) -> Iterator[Unit]:
    """Give that many distinct units, each after units that make what it needs and the kitchen lacks.

    ``goals`` is told of the products made; all of them are outputs of units given before.
    """
    world = _World(family, units, random.Random(f"{family} {seed} units"))
    return islice(world.recipes(goals), units)


def generate(
    family: Family, units: int, seed: int, folder: Path, dialect: Dialect = Dialect.PLAIN
) -> Written:
    """Write a network of exactly so many distinct units, and what stands beside it, into a folder.

    The folder is made where it is missing; files of the same names are replaced, the network last. Raises
    :class:`ValueError` for fewer than :data:`LEAST_UNITS` units.
    """
    if units < LEAST_UNITS:
        raise ValueError(f"{units} units: expected at least {LEAST_UNITS}")
    folder.mkdir(parents=True, exist_ok=True)
    goals = Goals(random.Random(f"{family} {seed} goals"))
    kitchen: dict[int, Node] = {}
    text = _Text(dialect)
    order = random.Random(f"{family} {seed} order") if family is Family.ADVERSARIAL else None
    partial = folder / ".FOON.partial"
    stream = unit_stream(family, units, seed, goals)
    try:
        with partial.open("w", encoding="utf-8", newline="") as file:
            end = "\r\n" if dialect is Dialect.IDS else "\n"
            file.write(f"# Synthetic: {family}, {units} units, seed {seed}{end}//{end}")
            written = 0
            while batch := list(islice(stream, _BATCH)):
                lines = [text.unit(unit, index) for index, unit in enumerate(batch, written)]
                if order is not None:
                    lines = [lines[i] for i in _shuffled(len(lines), order)]
                file.write("".join(lines))
                written += len(batch)
                kitchen.update((node.number, node) for unit in batch for node in unit.inputs if node.kitchen)
        labels = {*_TOOLS, *_KNIVES, *_BOARDS, *_HOLDERS, *_APPLIANCES, "sponge", "towel"}
        labels.update(f"{size} {vessel}" for size in _SIZES for vessel in _VESSELS)
        (folder / "utensils.txt").write_text(
            "".join(f"{label}\n" for label in sorted(labels)), encoding="utf-8"
        )
        (folder / "motion.txt").write_text("".join(_rates(family, seed)), encoding="utf-8")
        _write_entries(folder / "kitchen.json", kitchen.values())
        _write_entries(folder / "goal_nodes.json", goals.nodes)
        partial.replace(folder / "FOON.txt")
    finally:
        partial.unlink(missing_ok=True)
    return Written(written, len(kitchen), len(goals.nodes))


def _shuffled(size: int, rng: random.Random) -> list[int]:
    drawn = [rng.random() for _ in range(size)]
    return sorted(range(size), key=drawn.__getitem__)


def _rates(family: Family, seed: int) -> Iterator[str]:
    """Give the lines of the rates: decimals from 0.5 to 1, one in four with three digits."""
    rng = random.Random(f"{family} {seed} rates")
    for motion in _MOTIONS:
        thousandths = 500 + int(rng.random() * 501)
        if rng.random() < 0.75:
            thousandths = thousandths // 10 * 10
        yield f"{motion}\t{thousandths // 1000}.{f'{thousandths % 1000:03}'.removesuffix('0')}\n"


def _write_entries(file: Path, nodes: Iterable[Node]) -> None:
    entries = ",\n".join(json.dumps(node.entry, indent=4) for node in nodes)
    file.write_text(f"[\n{entries}\n]\n", encoding="utf-8")


def main() -> None:
    """Write the instance that the command line asks for, and say what was written."""
    parser = argparse.ArgumentParser(description="Write a synthetic FOON into a folder.")
    parser.add_argument("--family", type=Family, choices=list(Family), required=True)
    parser.add_argument("--units", type=int, required=True, help=f"how many; at least {LEAST_UNITS}")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--dialect", type=Dialect, choices=list(Dialect), default=Dialect.PLAIN)
    parser.add_argument("--out", type=Path, required=True, help="the folder")
    options = parser.parse_args()
    if options.units < LEAST_UNITS:
        parser.error(f"--units: expected at least {LEAST_UNITS}")
    written = generate(options.family, options.units, options.seed, options.out, options.dialect)
    print(f"{options.out}: {written.units} units, {written.kitchen} kitchen items, {written.goals} goals")


if __name__ == "__main__":
    main()
