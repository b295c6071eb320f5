"""What a replay of a plan found where items are used up: a text, and what is missing."""

from collections import Counter
from collections.abc import Iterator

from foon_asp.document.json_document import listed_unit_json, named_json
from foon_asp.problem import Problem
from foon_asp.proof.replay import Replay, Shortage
from foon_asp.report.answer import costs_text
from foon_asp.report.verdict import Listed
from foon_asp.text.json_value import Json


def replay_text(problem: Problem, listed: Listed, replay: Replay) -> str:
    """Say whether a plan runs; else which copy is missing, at which step, and who took it."""
    return "\n".join(_lines(problem, listed, replay)) + "\n"


def _lines(problem: Problem, listed: Listed, replay: Replay) -> Iterator[str]:
    shortage = replay.shortage
    yield f"{'runs as listed' if shortage is None else 'does not run'} ({problem.conditions})"
    if shortage is not None:
        yield shortage_text(listed, shortage)
    ids = [problem.network.unit_id(unit) for unit, _ in listed]
    for number, unit in enumerate(ids, 1):
        if unit is None:
            yield f"step {number} is not in the network: {_step_text(listed, number - 1)}"
    known = [unit for unit in ids if unit is not None]
    if len(known) == len(ids):
        yield costs_text(problem.costs(known))
    for node, copies in replay.stock.items():
        if copies:
            yield f"takes {copies} from the stock of {node}"


def shortage_text(listed: Listed, shortage: Shortage) -> str:
    """Say which copy is missing, at which step, and which steps took those that there were."""
    if shortage.step is None:
        text = f"every step runs, but in the end no copy is left of the goal: {shortage.node}"
    else:
        step = _step_text(listed, shortage.step)
        text = f"step {shortage.step + 1}, {step}, lacks a copy of {shortage.node}"
    if not shortage.taken:
        return text + "; there never was one"
    takers = ", ".join(f"step {n + 1} ({listed[n][0].motion})" for n in shortage.taken)
    return text + f"; used up by {takers}"


def _step_text(listed: Listed, position: int) -> str:
    unit, source = listed[position]
    return f"{unit.motion}    [{source}]"


def replay_json(problem: Problem, listed: Listed, replay: Replay) -> Json:
    """Give the same; positions count from 1."""
    network, shortage = problem.network, replay.shortage
    lacking = None
    if shortage is not None:
        step = shortage.step
        lacking = {
            "position": None if step is None else step + 1,
            "unit": None if step is None else listed_unit_json(network, *listed[step]),
            "missing": named_json(network, shortage.node),
            "used_up_by": [position + 1 for position in shortage.taken],
        }
    left = Counter(copy.node for copy in replay.left)
    return {
        "runs": shortage is None,
        "shortage": lacking,
        "left": [{"object": named_json(network, node), "copies": count} for node, count in left.items()],
        "stock_taken": [
            {"object": named_json(network, node), "copies": count} for node, count in replay.stock.items()
        ],
    }
