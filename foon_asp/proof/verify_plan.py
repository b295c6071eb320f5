"""Is a certificate of a plan right, where items are used up? Without a solver, a linear program or floats.

docs/dev/certificates.md describes these certificates and proves that what passes here is true. In short: how
often a plan executes each unit satisfies conditions that can be read from the network. Of every node no more
copies are used up than come (its *balance*), and each cut before a goal, or before a unit that is executed,
is crossed. Take conditions with weights from 0: whatever they say in all, each unit by itself can make it up
no more cheaply than at the least of what it costs less what it brings, over all the counts that it may have.
These add up to a bound on every plan, since a plan fulfils all of the conditions.

What becomes of the inputs of a unit, and whether a plan runs, is worked out here anew from the plain network.
"""

import math
from collections import Counter
from collections.abc import Collection, Iterator, Mapping
from fractions import Fraction
from functools import cache, cached_property, partial
from itertools import chain
from typing import Any, NamedTuple

from foon_asp.proof.constraint import LIBRARY, Rule
from foon_asp.proof.verify import (
    KEYS,
    Amount,
    Check,
    Form,
    Subject,
    UsedUp,
    Verified,
    negative,
    read_frame,
    read_list,
    read_number,
    read_numbers,
    read_object,
    read_pair,
    refusing_depth,
    require,
    verify,
)

PLAN = Form("foon-asp certificate of a plan", 1, KEYS | {"items", "unreached"})

# The rules that plans can be held against: those that remove units or ask for one, and those whose limit
# counts each execution.
COUNTING = ("at_most_units", "at_most_motion", "at_most_utensil_uses", "at_most_price")
WANTING = ("forbid_ingredient", "require_motion", "require_object", "require_ingredient")
RULES = frozenset({*COUNTING, *WANTING, *(name for name, rule in LIBRARY.items() if rule.removes)})

FINE = 10**9  # parts of a logarithm, where plans are to be as good by success as the one in hand
_MOST = 10**9  # copies in stock, and executions that a branch is about
_LEAF = {"weights", "before", "balance", "limits", "levels"}


class Flow(NamedTuple):
    """What a unit asks for, uses up and adds, one copy of each."""

    asks: frozenset[int]
    uses: frozenset[int]
    adds: frozenset[int]


class Part(NamedTuple):
    """A part of all plans: how often they execute units, and take items, at least and at most."""

    proof: Any
    least: Mapping[int, int]
    most: Mapping[int, int]


def is_of_plan(certificate: Any) -> bool:
    """Whether a certificate is of a plan, for which everything is looked at."""
    return isinstance(certificate, dict) and certificate.get("format") == PLAN.name


def verify_any(certificate: Any, subject: Subject) -> Verified:
    """Check a certificate of a tree or of a plan; raises :class:`RefusedError`."""
    check = verify_plan if is_of_plan(certificate) else verify
    return check(certificate, subject)


@refusing_depth()
def verify_plan(certificate: Any, subject: Subject) -> Verified:
    """Check a certificate of a plan against the data it speaks about.

    Raises :class:`RefusedError` with the first fault that is found.
    """
    rules = read_frame(certificate, PLAN, subject)
    require(subject.network.level == 3, "below level 3 nothing says what is used up: contents decide")
    require(RULES.issuperset(rule["rule"] for rule in rules), "a rule that plans are not held against")
    check = PlanCheck(certificate, rules, subject)
    return check.claim()._replace(used_up=UsedUp(check.stock, check.told))


class PlanCheck(Check):
    """One certificate of a plan, checked against its network.

    Where the objective ``kitchen`` counts items, a *member* is also an item: what never runs out is taken or
    not, and of what is in stock so many copies.
    """

    def __init__(self, certificate: dict[str, Any], rules: tuple[Rule, ...], subject: Subject) -> None:
        items = read_object(certificate["items"], ("stock", "stays"))
        self.stock = _stock(items["stock"], subject.kitchen)
        self.told = _told(items["stays"], len(subject.network.objects))
        self.endless = frozenset(subject.kitchen) - self.stock.keys()
        self.flow, self.cap, self.whole = cache(self._flow), cache(self._cap), cache(self._whole)
        super().__init__(certificate, rules, subject)

    # --- what units do

    def _flow(self, unit: int) -> Flow:
        """Return what a unit asks for, uses up and adds: none of its inputs is added."""
        network = self.network
        asks = frozenset(o for o in self.needs(unit) if o is not None)
        gives = frozenset(o for o in self.gives(unit) if o is not None)
        gone = frozenset(o for o in asks if not self._stays(unit, o))
        self._spend(len(network.inputs[unit]) * (1 + len(network.outputs[unit])))
        return Flow(asks, gone, gives.difference(network.inputs[unit]))

    def _stays(self, unit: int, o: int) -> bool:
        """Whether an input is still there when a unit has run: as somebody says, or by the rule."""
        objects, network = self.network.objects, self.network
        node = objects[o]
        for said in (o, node.label):
            if said in self.told:
                return self.told[said]
        outputs = [objects[made] for made in network.outputs[unit]]
        if any(output.label == node.label for output in outputs):
            return o in network.outputs[unit]
        if node.label in self.utensils:
            holds = any(contents.ingredients for contents in node.contents)
            if not holds or any(output.is_in(node.label) for output in outputs):
                return True
        inputs = {objects[taken].label for taken in network.inputs[unit]}
        around = {relation.object for relation in node.relations} & inputs
        return any(output.label in around and node.label in output.ingredients for output in outputs)

    @cached_property
    def idle(self) -> frozenset[int]:
        """The units that no plan executes: removed by a rule, or asking for what nothing reaches.

        No node of ``unreached`` is there at first, and whatever adds one asks for another.
        """
        network = self.network
        stated = self.certificate["unreached"]
        unreached = frozenset(read_numbers(stated, len(network.objects), ascending=stated != []))
        removed = self.ruled.removed
        for o in unreached:
            self._spend(1 + len(network.producers[o]))
            require(not self._there(o), "what is there at first is called unreached")
            for unit in network.producers[o]:
                reaches = o in self.flow(unit).adds and self.flow(unit).asks.isdisjoint(unreached)
                require(unit in removed or not reaches, "what a unit can add is called unreached")
        asking = {unit for o in unreached for unit in network.consumers[o] if o in self.flow(unit).asks}
        return removed | asking

    def _there(self, o: int) -> bool:
        return o in self.endless or self.stock.get(o, 0) > 0

    def _members(self, cut: frozenset[int]) -> Iterator[int]:
        """Yield the units that add a node of the cut and ask for none, and the kitchen items in it."""
        network, own = self.network, self.ruled.makers
        self._spend(sum(1 + len(own[o] if o in own else network.producers[o]) for o in cut))
        found: list[int] = []
        for o in cut:
            if o in own:
                found += own[o]
                continue
            if self._there(o):
                require("kitchen" in self.objectives, "a cut holds a kitchen item")
                yield len(network) + o
            if o not in self.endless:
                found += (unit for unit in network.producers[o] if o in self.flow(unit).adds)
        yield from (u for u in found if u not in self.idle and cut.isdisjoint(self.flow(u).asks))

    # --- the plan

    def _tree(self, units: list[Any]) -> tuple[Amount, list[int | Fraction]]:
        """Run the plan copy by copy; give what it costs as an amount and as figures."""
        network = self.network
        copies, taken = Counter(self.stock), set[int]()
        least: Counter[int] = Counter()  # copies of the stock that the plan cannot do without
        for place, stated in enumerate(units):
            unit = read_number(stated, range(len(network)), "ids of units in a plan")
            asks, uses, adds = self.flow(unit)
            self._spend(1 + len(asks) + len(adds))
            require(
                all(o in self.endless or copies[o] > 0 for o in asks),
                f"unit {unit} of the plan lacks a copy of an input at step {place + 1}",
            )
            taken |= asks & self.endless
            for o in asks & self.stock.keys():
                least[o] = max(least[o], 1 + self.stock[o] - copies[o])
            copies.subtract(uses - self.endless)
            copies.update(adds - self.endless)
        for goal in set(self.goals) - self.endless:
            require(copies[goal] > 0, "a copy of a goal is not there in the end")
            if goal in self.stock:
                least[goal] = max(least[goal], 1 + self.stock[goal] - copies[goal])
        self._keep_counts(Counter(units))
        first = len(network)
        members = [
            *units,
            *(first + o for o in sorted(taken)),
            *(first + o for o in sorted(least.elements())),
        ]
        total = self.sum(map(self._cost, members))
        return total, self._figures(units, total)

    def _keep_counts(self, counts: Counter[int]) -> None:
        """Hold the counts of a plan against the rules; limits count each execution."""
        ruled, units = self.ruled, frozenset(counts)
        require(not units & ruled.removed, "the plan has a unit that a rule removes")
        wanted = all(not units.isdisjoint(ruled.makers[goal]) for goal in ruled.goals)
        require(wanted and not ruled.never, "the plan lacks what a rule asks for")
        for limit in ruled.limits.values():
            total = sum((limit.amounts.get(unit, 0) * n for unit, n in counts.items()), Fraction(0))
            require(total <= limit.most, "the plan exceeds what a rule limits")

    # --- the proof

    def _prove(self, proof: Any, least: Amount | None) -> None:
        """Check a proof for each objective: plans as good by those before it cost at least so much by it.

        ``None`` as what they cost is that there is none: nothing costs anything then, and bounds are above 0.
        """
        proofs = read_list(proof)
        levels = range(max(1, len(self.objectives)))
        require(len(proofs) == len(levels), "expected a proof for each objective")
        if self.ruled.never:
            require(least is None, "a rule allows no plan")
            require(proofs == [{}], "a proof is given where a rule allows no plan")
            return
        self.least = least
        for level in levels:
            waiting = [Part(proofs[level], {}, {})]
            while waiting:
                part = waiting.pop()
                self._spend(1 + len(part.least) + len(part.most))
                if "branch" in read_object(part.proof):
                    waiting += self._divided(part)
                else:
                    self._prove_part(part, level)

    def _divided(self, part: Part) -> Iterator[Part]:
        """Divide a part by how often something is executed or taken."""
        proof = read_object(part.proof, ("branch", "most", "up_to", "above"))
        member = self._branch(proof["branch"])
        most = read_number(proof["most"], range(_MOST), "the most executions of a branch")
        up_to = min(most, part.most.get(member, most))
        yield Part(proof["up_to"], part.least, {**part.most, member: up_to})
        above = max(most + 1, part.least.get(member, 0))
        yield Part(proof["above"], {**part.least, member: above}, part.most)

    def _prove_part(self, part: Part, level: int) -> None:
        """Add up what the weights of conditions say of the plans of a part."""
        require(set(part.proof) <= _LEAF, "expected weights of conditions or a branch")
        conditions = _Conditions(self, level, part.proof)
        bound = conditions.constant
        for member in sorted({*conditions.executed, *conditions.used, *part.least, *part.most}):
            cheapest = self._cheapest(member, level, part, conditions)
            if cheapest is None:
                return  # there are no such counts
            self._add(bound, cheapest)
        self._require_enough(bound, level)

    def _cheapest(self, member: int, level: int, part: Part, conditions: "_Conditions") -> Amount | None:
        """Return the least of what a member costs less what it brings, over the counts that it may have.

        ``None`` where it may have none. It is linear in the count from 1 on, so only the ends matter.
        """
        low, most = part.least.get(member, 0), self._most(member, level, part)
        if most is not None and most < low:
            return None
        each = self.sum([self.part(member, level), conditions.executed.get(member, {})])
        each = self.sum([each, *(self.times(w, self.kept(member, at)) for at, w in conditions.levels)])
        once = conditions.used.get(member, {})
        found: list[Amount] = [{}] if low == 0 else []
        if most is None or most >= 1:
            found.append(self.sum([self.times(each, Fraction(max(low, 1))), once]))
            if self.sign(each) < 0:
                require(most is not None, f"member {member} brings more than it costs, without end")
                found.append(self.sum([self.times(each, Fraction(most or 0)), once]))
        cheapest = found[0]
        for other in found[1:]:
            if self.sign(self.sum([other, negative(cheapest)])) < 0:
                cheapest = other
        return cheapest

    def _most(self, member: int, level: int, part: Part) -> int | None:
        """Return how often a member can be executed or taken; ``None`` where nothing says so."""
        known = [part.most[member]] if member in part.most else []
        if member >= len(self.network):
            o = member - len(self.network)
            return min([*known, self.stock.get(o, 1)])
        if member in self.idle:
            return 0
        known += self._allowed(member)
        if self.least is not None:
            known += (
                cap for at in range(level + 1) if (cap := self.cap(member, at, at == level)) is not None
            )
        return min(known, default=None)

    def _allowed(self, unit: int) -> Iterator[int]:
        """Yield how often limits allow a unit to be executed, those that nothing gives back to."""
        for limit in self.ruled.limits.values():
            amount = limit.amounts.get(unit, 0)
            if amount > 0 and min(limit.amounts.values()) >= 0:
                yield max(0, math.floor(limit.most / amount))

    def _cap(self, unit: int, level: int, less: bool) -> int | None:
        """Return how often a plan can execute a unit that costs no more by an objective, or less."""
        each, most = self.kept(unit, level), self.limit(level)
        if each == 0:
            return None
        exact = less and self.objectives[level] != "success"
        return math.ceil(most / each) - 1 if exact else math.floor(most / each)

    def part(self, member: int, level: int) -> Amount:
        """Return what a member costs by one objective."""
        return {key: value for key, value in self._cost(member).items() if key[0] == level}

    def kept(self, member: int, level: int) -> Fraction:
        """Return what a member costs by an objective as one number; by success a little less."""
        if self.objectives[level] != "success":
            return self.part(member, level).get((level, None), Fraction(0))
        if member >= len(self.network):
            return Fraction(0)
        require(self.rate(member) > 0, "a unit that never succeeds is not compared")
        return Fraction(math.floor(FINE * self.minus_log(self.rate(member))[0]), FINE)

    def limit(self, level: int) -> Fraction:
        """Return what plans may cost by an objective as one number; by success a little more."""
        assert self.least is not None
        stated = {rate: value for (at, rate), value in self.least.items() if at == level}
        if self.objectives[level] != "success":
            return stated.get(None, Fraction(0))
        bounds = ([e * bound for bound in self.minus_log(rate)] for rate, e in stated.items() if rate)
        return Fraction(math.ceil(FINE * sum(map(max, bounds), Fraction(0))), FINE)

    def cut(self, number: int) -> frozenset[int]:
        """Return a cut by its number."""
        return self.cuts[read_number(number, range(len(self.cuts)), "the number of a cut")]

    def holds_goal(self, nodes: frozenset[int]) -> bool:
        """Whether a cut holds a goal that is not there without end, or what a rule asks for."""
        wanted = any(goal in nodes and goal not in self.endless for goal in self.goals)
        return wanted or not nodes.isdisjoint(self.ruled.goals)

    def weight(self, stated: Any, level: int) -> Amount:
        """Read a weight: a number, or by success the exponent of each rate."""
        parts = [*({} if objective == "success" else "0" for objective in self.objectives)] or ["0"]
        parts[level] = stated
        return {key: value for key, value in self._read(parts).items() if key[0] == level}

    def _require_enough(self, bound: Amount, level: int) -> None:
        """Require that a bound, rounded up to the next cost that there is, is what is claimed."""
        if self.least is None:
            enough = self.sign(bound) > 0
        else:
            parts = self.whole(level)
            if parts is not None:
                (at,) = bound or [(level, None)]
                bound = {at: Fraction(math.ceil(bound.get(at, Fraction(0)) * parts), parts)}
            claimed = {key: value for key, value in self.least.items() if key[0] == level}
            enough = self.sign(self.sum([bound, negative(claimed)])) >= 0
        require(enough, "the weights do not add up to enough")

    def _whole(self, level: int) -> int | None:
        """Return the common denominator of what units cost by an objective; ``None`` if not known."""
        objective = self.objectives[level]
        if objective == "success" or objective in self.measures:
            return None
        every = self.prices if objective == "price" else []
        every = (
            [1 / self.rate(unit) for unit in range(len(self.network))] if objective == "attempts" else every
        )
        return math.lcm(*(cost.denominator for cost in every))


class _Conditions:
    """Conditions with weights from 0, all in one: what each execution brings, each use, and what is left.

    ``executed`` and ``used`` have what comes to a member for each execution (or copy that is taken) and for
    being used at all; it is below 0 where it brings something. ``levels`` are weights of earlier objectives.
    """

    def __init__(self, check: PlanCheck, level: int, proof: Mapping[str, Any]) -> None:
        self.check, self.level, self.proof = check, level, proof
        self.constant: Amount = {}
        self.executed: dict[int, Amount] = {}
        self.used: dict[int, Amount] = {}
        self.levels: list[tuple[int, Amount]] = []
        units = len(check.network)
        for (cut,), weight in self._read("weights"):
            self._cross(cut, weight, check.holds_goal(check.cut(cut)))
        for (cut, stated), weight in self._read("before", 2):
            unit = read_number(stated, range(units), "the id of a unit that a cut is before")
            self._cross(cut, weight, not check.cut(cut).isdisjoint(check.flow(unit).asks))
            self._bring(self.used, unit, weight, 1)
            self._demand(weight, -1)
        for (o,), weight in self._read("balance"):
            self._balance(o, weight)
        for (place,), weight in self._read("limits"):
            limit = check.limit_at(place)
            self._demand(weight, -limit.most)
            for member, amount in limit.amounts.items():
                self._bring(self.executed, member, weight, amount)
        for (place,), weight in self._read("levels"):
            require(0 <= place < level, "an objective that is not before this one is given a weight")
            self._demand(weight, -check.limit(place))
            self.levels.append((place, weight))

    def _read(self, key: str, numbers: int = 1) -> Iterator[tuple[list[int], Amount]]:
        """Read the weights of conditions under a key, each named by so many numbers."""
        read = partial(self.check.weight, level=self.level)
        return self.check.read_weights(key, self.proof.get(key, []), read, numbers)

    def _cross(self, cut: int, weight: Amount, holds: bool) -> None:
        """A cut is crossed at least once: a member is used, or a copy of an item in it is taken."""
        check = self.check
        require(holds, f"cut {cut} holds neither a goal nor what the unit asks for")
        check.met.add(cut)
        self._demand(weight, 1)
        for member in check.members[cut]:
            self._bring(self.used if member < len(check.network) else self.executed, member, weight, -1)

    def _balance(self, o: int, weight: Amount) -> None:
        """Of a node no more copies are used up than come, and one of a goal is left."""
        check, network = self.check, self.check.network
        read_number(o, range(len(network.objects)), "the id of a node in a balance")
        require(o not in check.endless, "what never runs out has no balance")
        there = check.stock.get(o, 0)
        if "kitchen" in check.objectives and there:
            self._bring(self.executed, len(network) + o, weight, -1)
            there = 0
        self._demand(weight, (o in check.goals) - there)
        for unit in {*network.producers[o], *network.consumers[o]}:
            flow = check.flow(unit)
            if change := (o in flow.adds) - (o in flow.uses):
                self._bring(self.executed, unit, weight, -change)

    def _demand(self, weight: Amount, factor: int | Fraction) -> None:
        """Add to what all plans have to bring, and members bring some of."""
        self.constant = self._added(self.constant, weight, factor)

    def _bring(self, to: dict[int, Amount], member: int, weight: Amount, factor: int | Fraction) -> None:
        to[member] = self._added(to.get(member, {}), weight, factor)

    def _added(self, amount: Amount, weight: Amount, factor: int | Fraction) -> Amount:
        return self.check.sum([amount, self.check.times(weight, Fraction(factor))])


def _stock(value: Any, kitchen: Collection[int]) -> dict[int, int]:
    """Read how many copies there are of kitchen items, by id."""
    what = "items and their copies in stock"
    pairs = [read_pair(pair, what) for pair in read_list(value)]
    for number in chain.from_iterable(pairs):
        read_number(number, range(_MOST), what)
    ids = [o for o, _ in pairs]
    require(ids == sorted(set(ids)), "expected items of the stock in order, each of them once")
    require(all(o in kitchen for o in ids), "expected kitchen items in stock")
    return dict(pairs)


def _told(value: Any, nodes: int) -> dict[str | int, bool]:
    """Read what is said of labels and of nodes: whether they stay."""
    what = "labels and nodes, and whether they stay"
    pairs = [read_pair(pair, what) for pair in read_list(value)]
    known = all(type(name) in (int, str) and type(stays) is bool for name, stays in pairs)
    require(known, f"expected {what}")
    labels = [name for name, _ in pairs if type(name) is str]
    ids = [name for name, _ in pairs if type(name) is int]
    require([*labels, *ids] == [name for name, _ in pairs], "expected labels, and then nodes")
    require(labels == sorted(set(labels)) and ids == sorted(set(ids)), "expected each of them once, in order")
    require(all(0 <= o < nodes for o in ids), "expected ids of nodes that stay or go")
    require(all(label.isprintable() for label in labels), "a label has letters that cannot be printed")
    return dict(pairs)
