"""The reasons why there is no tree, in a few lines for an answer without one."""

from collections.abc import Iterator

from foon_asp.deadline import Deadline
from foon_asp.network import counted
from foon_asp.problem import Problem, reach


def why_infeasible(problem: Problem, deadline: Deadline | None = None) -> Iterator[str]:
    """Yield lines with the reasons why there is no tree.

    If a limit or ctrl-C stops the search for reasons, yield instead one line that refers to ``why-not``. The
    interrupt is not raised.
    """
    try:
        with (deadline or Deadline()).watched("looking for the reason", late=True, grace=True):
            lines = list(_reason_lines(problem))
    except KeyboardInterrupt:
        lines = ["foon-asp why-not explains why; there was no time left for it here"]
    yield from lines


def _reason_lines(problem: Problem, shown: int = 5) -> Iterator[str]:
    """Yield lines: for each unreachable goal the inputs that its achievers lack, then the causes.

    Up to ``shown`` achievers of a goal are listed. If every goal can be made, the lines say instead that
    constraints rule out every tree, or that each plan uses up too much.
    """
    available = reach(problem).available
    network = problem.network
    if all(available[goal] for goal in problem.goals) and problem.items is not None:
        yield (
            "if items lasted, every goal could be made: each plan would use up more than there is, or break "
            "a constraint"
        )
        yield "foon-asp shopping-list says how many copies of what to buy"
        return
    if all(available[goal] for goal in problem.goals):
        yield "without the constraints there is one: together they rule out every tree"
        yield "foon-asp why-not finds those that do, and which to drop"
        return
    for goal in problem.goals:
        if available[goal]:
            continue
        makers = problem.makers[goal]
        skipping = len(network.producers[goal]) - len(makers)
        if makers:
            yield f"no unit that makes {network.objects[goal]} can run:"
        else:
            yield f"no unit makes {network.objects[goal]}, and it is not in the kitchen"
        if skipping:
            yield f"  {counted(skipping, 'unit')} took it as given, and so did not make it"
        for unit in makers[:shown]:
            yield f"  {network.motions[unit]}    [{network.sources[unit][0].short}] lacks"
            yield from (f"       {network.objects[o]}" for o in problem.needs[unit] if not available[o])
        if len(makers) > shown:
            yield f"  ... and {counted(len(makers) - shown, 'more unit')}"
    yield from _cause_lines(problem)
    yield "foon-asp why-not explains why, and foon-asp shopping-list finds what would help"


def _cause_lines(problem: Problem, shown: int = 3) -> Iterator[str]:
    """Yield a line for each of the first ``shown`` causes why there is no tree, and one for the others.

    A cause is a missing node, or a cycle of nodes that can only be made from each other. Causes are those on
    the path to the goals that lacks the fewest nodes. A missing goal is left out, since another line names
    it.
    """
    from foon_asp.problem.dead_ends import dead_ends  # noqa: PLC0415 (only where there is no tree)

    objects = problem.network.objects
    roots = [root for root in dead_ends(problem).roots if root.on_the_way]
    for root in roots[:shown]:
        if root.cycle is None:
            if root.object not in problem.goals:
                yield f"the cause: {objects[root.object]} is not in the kitchen, and no unit makes it"
            continue
        first, *others = [str(objects[o]) for o, _ in reversed(root.cycle.steps)]
        needed_nodes = (*others, first)
        cycle_text = "".join(f", and that only from {other}" for other in needed_nodes[1:3])
        if len(needed_nodes) > 3:
            cycle_text += f", and so on: {len(needed_nodes)} object nodes wait for each other"
        yield f"the cause: {first} can only be made from {needed_nodes[0]}{cycle_text}"
    if len(roots) > shown:
        yield f"  ... and {len(roots) - shown} more"
