"""Lint rules about chains of units: objects that do not fit, and objects left out of a unit."""

from collections.abc import Iterator

from foon_asp.linting.chain import MAX_DISTANCE, Chain
from foon_asp.linting.context import Context
from foon_asp.linting.habits import content_names
from foon_asp.linting.place_rules import inputs_placed_in_outputs, misplaced_nodes, unheld_nodes
from foon_asp.linting.rule import WARNING, rule
from foon_asp.text.diagnostics import Diagnostic


@rule("broken-chain", WARNING, "an object that is taken, and made a little different")
def find_broken_chains(context: Context) -> Iterator[Diagnostic]:
    """A unit takes an object that no unit makes; an earlier unit makes an object that is a little different.

    Usually no unit takes the made object either. A state, a place or an ingredient is missing in one of the
    two objects, or is spelt differently. No task tree can go through here. Both lines are reported. Only
    units near each other in one file are compared.
    """
    for chain in context.chains:
        for node, consumer in chain.unmade_nodes():
            if not (similar := chain.nearest_similar(node, consumer)):
                continue
            producer, other = similar
            taken_at = chain.copies[consumer], 0, chain.objects[node]
            made_at = chain.copies[producer], 1, chain.objects[other]
            taken_node, made_node = str(taken_at[2]), str(made_at[2])
            line = context.line_name(*made_at)
            message = f"no unit makes {taken_node!r}; is it {made_node!r}, which {line} makes?"
            yield context.finding_at_node(*taken_at, message)
            if other not in chain.consumers:
                line = context.line_name(*taken_at)
                message = f"no unit takes {made_node!r}; is it {taken_node!r}, which {line} takes?"
                yield context.finding_at_node(*made_at, message)


@rule(
    "left-out",
    WARNING,
    "a unit that has something and not the container that it is in, or the other way round",
)
def find_left_out_objects(context: Context) -> Iterator[Diagnostic]:
    """A unit makes a container with an object in it, but does not make the object; or the other way round.

    A later unit takes both, and no unit makes the missing one. Also reported is an input that is in or on
    something that the unit lists only among its outputs. For example, food is scraped from a board, and the
    board is no input. Nothing is reported again that is a `broken-chain`, `unheld` or `other-place`.
    """
    for chain in context.chains:
        for node, consumer in chain.unmade_nodes():
            if (incomplete := _producer_of_companion(chain, node, consumer)) and not chain.nearest_similar(
                node, consumer
            ):
                producer, companion = incomplete
                lacking, made = chain.objects[node], chain.objects[companion]
                motion = context.network.motions[chain.units[producer]]
                taking = chain.copies[consumer]
                message = (
                    f"{motion!r} makes {str(made)!r}, and not {str(lacking)!r}, which "
                    f"{context.line_name(taking, 0, lacking)} takes with it and no unit makes; is it "
                    "left out here?"
                )
                yield context.finding_at_node(chain.copies[producer], 1, made, message)
    labels = {node.label for node in context.network.objects}
    for side in context.sides:
        placed_inputs = [] if side.number else list(inputs_placed_in_outputs(side))
        if placed_inputs:
            reported = [*unheld_nodes(side, context.habits), *misplaced_nodes(side, labels, context.habits)]
            reported_inputs = {input_ for input_, _ in reported}
            copy, motion = context.files.copies[side.unit][0], context.network.motions[side.unit]
            for input_, message in placed_inputs:
                if input_ not in reported_inputs:
                    text = f"{message} of {motion!r} have, and the inputs have not"
                    yield context.finding_at_node(copy, 0, input_, text)


def _producer_of_companion(chain: Chain, node: int, consumer: int) -> tuple[int, int] | None:
    """Find a unit that makes a companion of a node without the node; return its position and the companion.

    A companion of the node is the container that the node is in, or an object in the node. The unit at the
    position ``consumer`` takes both. Nodes are ids. Only the last unit before ``consumer`` that makes the
    companion is considered, up to 25 units back. None of its outputs may have the label of the node. If the
    companion is the container, one of its inputs must have this label. Return ``None`` if there is no such
    unit.
    """
    unmade_node = chain.objects[node]
    for companion in chain.network.inputs[chain.units[consumer]]:
        other = chain.objects[companion]
        is_inside = unmade_node.label in content_names(other) and any(
            related == other.label for _, related in unmade_node.relations
        )
        is_around = other.label in content_names(unmade_node) and any(
            related == unmade_node.label for _, related in other.relations
        )
        earlier = [position for position in chain.producers.get(companion, ()) if position < consumer]
        if not (is_inside or is_around) or not earlier or consumer - earlier[-1] > MAX_DISTANCE:
            continue
        input_labels, output_labels = (chain.side_labels(earlier[-1], side) for side in (0, 1))
        if unmade_node.label not in output_labels and (is_around or unmade_node.label in input_labels):
            return earlier[-1], companion
    return None
