"""Several trees for one question, for people and for programs."""

import json
from collections.abc import Iterator

from foon_asp.explain.alternatives import Alternatives
from foon_asp.report.answer import costs_json, costs_text, counted, goal_lines, unit_json, unit_lines

_SHOWN = 20  # trees that are listed one by one for people


def alternatives_text(found: Alternatives) -> str:
    """Say how many trees there are, what each costs, and in what it differs from the first.

    Where all optimal ones were asked for, also what they have in common.
    """
    if found.wanted is None:
        return "\n".join([*goal_lines(found.problem), *_optimal_lines(found)]) + "\n"
    return _trees_text(found, found.wanted)


def _trees_text(found: Alternatives, wanted: int) -> str:
    lines = list(goal_lines(found.problem))
    rule = found.problem.conditions
    if not found.trees:
        return "\n".join([*lines, _no_tree(found)]) + "\n"
    if len(found.trees) < wanted and found.complete:
        lines.append(f"there are {counted(len(found.trees), 'tree')} and no more ({rule})")
    elif not found.complete:
        lines.append(f"{counted(len(found.trees), 'tree')} of those found before a limit ({rule})")
        if found.unproved:
            lines.append(f"before the last {found.unproved} of them others may come")
    else:
        lines.append(f"{counted(len(found.trees), 'tree')} ({rule})")
    lines += _trees(found)
    return "\n".join(lines) + "\n"


def alternatives_json(found: Alternatives) -> str:
    """Give the trees with what they cost, and the units that all optimal ones or some of them have."""
    network = found.problem.network
    return (
        json.dumps(
            {
                "goals": [str(network.objects[goal]) for goal in found.problem.goals],
                "containers": str(found.problem.containers),
                "level": network.level,
                "objective": [str(objective) for objective in found.objectives],
                "complete": found.complete,
                "unproved": found.unproved,
                "optimal": len(found.optimal),
                "in_every_optimal": sorted(map(network.unit_number, found.in_every)),
                "in_some_optimal": sorted(map(network.unit_number, found.in_some)),
                "trees": [
                    {
                        "costs": costs_json(tree.costs),
                        "units": [unit_json(network, unit) for unit in tree.units],
                    }
                    for tree in found.trees
                ],
            },
            indent=2,
            ensure_ascii=False,
        )
        + "\n"
    )


def _optimal_lines(found: Alternatives) -> Iterator[str]:
    rule, best = found.problem.conditions, ", then ".join(found.objectives)
    if not found.trees:
        yield _no_tree(found)
        return
    costs = costs_text(found.trees[0].costs)
    number = len(found.trees)
    if number == found.unproved:
        yield f"feasible, not proved best by {best} ({rule}; stopped at a limit): {costs}"
    elif not found.complete:
        yield f"at least {counted(number, 'optimal tree')} by {best} ({rule}; stopped at a limit): {costs}"
    elif number == 1:
        yield f"the optimal tree by {best} is the only one: proved ({rule}): {costs}"
    else:
        yield f"{number} optimal trees by {best}, and no others: proved ({rule}): {costs}"
    if number > 1 and found.optimal:
        yield f"in every one{' found' * (not found.complete)}: {counted(len(found.in_every), 'unit')}"
        yield from unit_lines(found.problem.network, found.in_every)
    yield from _trees(found)


def _trees(found: Alternatives) -> Iterator[str]:
    """List the trees, each but the first by what it has instead."""
    first, network = found.trees[0], found.problem.network
    for number, tree in enumerate(found.trees[:_SHOWN], 1):
        yield f"tree {number}: {costs_text(tree.costs)}"
        if number == 1:
            yield from unit_lines(network, tree.units)
            continue
        gone, new = set(first.units) - set(tree.units), set(tree.units) - set(first.units)
        yield from unit_lines(network, (unit for unit in first.units if unit in gone), "-")
        yield from unit_lines(network, (unit for unit in tree.units if unit in new), "+")
    if len(found.trees) > _SHOWN:
        yield f"... and {len(found.trees) - _SHOWN} more trees; --format json lists all"


def _no_tree(found: Alternatives) -> str:
    rule = found.problem.conditions
    if found.complete:
        return f"infeasible: proved that no task tree exists ({rule})"
    return f"unknown: stopped at a limit before any task tree was found ({rule})"
