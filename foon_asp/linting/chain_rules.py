"""How objects come from unit to unit: chains that break, and what is left out of a unit."""

from collections.abc import Iterator

from foon_asp.linting.chain import FAR, Chain
from foon_asp.linting.context import Context
from foon_asp.linting.habits import held
from foon_asp.linting.place_rules import misplaced_nodes, only_after, unheld_nodes
from foon_asp.linting.rule import WARNING, rule
from foon_asp.text.diagnostics import Diagnostic


@rule("broken-chain", WARNING, "an object that is taken, and made a little different")
def broken_chain(context: Context) -> Iterator[Diagnostic]:
    """An object that no unit makes is taken, and a unit before it makes one that differs in a little.

    Usually no unit takes that one: a state, a place or an ingredient is missing in one of the two, or spelt
    differently. No task tree can go through here. Both ends are reported. Only units near each other in one
    file are compared.
    """
    for chain in context.chains:
        for node, taker in chain.unmade():
            if not (near := chain.nearest(node, taker)):
                continue
            maker, other = near
            ends = chain.copies[taker], 0, chain.objects[node]
            starts = chain.copies[maker], 1, chain.objects[other]
            here, there = str(ends[2]), str(starts[2])
            message = f"no unit makes {here!r}; is it {there!r}, which {context.line(*starts)} makes?"
            yield context.at_node(*ends, message)
            if other not in chain.takers:
                message = f"no unit takes {there!r}; is it {here!r}, which {context.line(*ends)} takes?"
                yield context.at_node(*starts, message)


@rule(
    "left-out",
    WARNING,
    "a unit that has something and not the container that it is in, or the other way round",
)
def left_out(context: Context) -> Iterator[Diagnostic]:
    """A unit makes a container with an object in it, but not the object, or the other way round.

    A later unit takes both, and no unit makes what is missing. Or an input is in or on something that is an
    output of the unit and no input: what was scraped from the board leaves it behind, so the board was there
    before.
    """
    for chain in context.chains:
        for node, taker in chain.unmade():
            if (place := _maker_without(chain, node, taker)) and not chain.nearest(node, taker):
                maker, beside = place
                lacking, made = chain.objects[node], chain.objects[beside]
                motion = context.network.motions[chain.units[maker]]
                message = (
                    f"{motion!r} makes {str(made)!r}, and not {str(lacking)!r}, which "
                    f"{context.line(chain.copies[taker], 0, lacking)} takes with it and no unit makes; is it "
                    "left out here?"
                )
                yield context.at_node(chain.copies[maker], 1, made, message)
    labels = {node.label for node in context.network.objects}
    for side in context.sides:
        places = [] if side.number else list(only_after(side))
        if places:
            told = [*unheld_nodes(side, context.habits), *misplaced_nodes(side, labels, context.habits)]
            others = {input_ for input_, _ in told}
            copy, motion = context.files.copies[side.unit][0], context.network.motions[side.unit]
            for input_, message in places:
                if input_ not in others:
                    text = f"{message} of {motion!r} have, and the inputs have not"
                    yield context.at_node(copy, 0, input_, text)


def _maker_without(chain: Chain, node: int, taker: int) -> tuple[int, int] | None:
    """Return the place that makes a container with an unmade node in it and not the node, and the container.

    Or that makes something in the node, and not the node, which is its container.
    """
    taken = chain.objects[node]
    for beside in chain.network.inputs[chain.units[taker]]:
        other = chain.objects[beside]
        inside = taken.label in held(other) and any(place == other.label for _, place in taken.relations)
        around = other.label in held(taken) and any(place == taken.label for _, place in other.relations)
        earlier = [place for place in chain.makers.get(beside, ()) if place < taker]
        if not (inside or around) or not earlier or taker - earlier[-1] > FAR:
            continue
        before, after = (chain.labels(earlier[-1], side) for side in (0, 1))
        if taken.label not in after and (around or taken.label in before):
            return earlier[-1], beside
    return None
