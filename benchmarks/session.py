"""What a session saves: the same questions one by one and in a session, without reading.

A series of questions about goals that can be made, by two objectives; before each of the later ones an item
of the kitchen is gone. Each is asked without rules of the user's (nothing is kept then: reductions come
first), with a constraint, and with the same constraint in a session. Answers are compared. Times are those of
the processor, which other programs do not change.

    python benchmarks/session.py                  the bundled kitchen
    python benchmarks/session.py --data DIR --goals 20
    python benchmarks/session.py --reduce none    with constraints, clingo searches all that can be made
"""

import argparse
import random
import statistics
import sys
import time
from dataclasses import replace
from pathlib import Path

from foon_asp.asp import Settings, solve
from foon_asp.asp.session import Session
from foon_asp.compare.many import makeable
from foon_asp.problem import ContainerRule, Objective, Problem, levels
from foon_asp.reduce import NONE
from foon_asp.resources import bundled_kitchen
from foon_asp.text.data_folder import find_data, read_data


def main() -> None:
    """Ask, compare and print."""
    parser = argparse.ArgumentParser(description="Measure what a session saves.")
    parser.add_argument("--data", type=Path, default=bundled_kitchen())
    parser.add_argument("--goals", type=int, default=20, help="the number of goals, drawn by chance")
    parser.add_argument("--reduce", choices=("all", "none"), default="all", help="under the constraint")
    options = parser.parse_args()
    data = read_data(find_data(options.data))
    rng = random.Random(1)
    constraint = Settings(constraints=(Path("forbid_motion"),), constants=("forbidden_motion=fry",))
    if options.reduce == "none":
        constraint = constraint._replace(reductions=NONE)
    for rule in ContainerRule:
        one = Problem(data.network, data.kitchen, (0,), data.rates, data.utensils, rule)
        goals = makeable(one)
        kept = constraint._replace(session=Session())
        ways = {"no constraint": Settings(), "one by one": constraint, "in a session": kept}
        seconds: dict[tuple[str, Objective], list[float]] = {}
        for number, goal in enumerate(rng.sample(goals, min(options.goals, len(goals)))):
            if number > options.goals // 2:
                one = replace(one, kitchen=one.kitchen - {rng.choice(sorted(one.kitchen))})
            asked = replace(one, goals=(goal,))
            for objective in (Objective.UNITS, Objective.SUCCESS):
                answers = []
                for way, settings in ways.items():
                    began = time.process_time()
                    outcome = solve(asked, (objective,), settings)
                    seconds.setdefault((way, objective), []).append(time.process_time() - began)
                    costs = outcome.costs.key(levels((objective,))) if outcome.costs else None
                    answers.append((outcome.status, costs))
                if answers[1] != answers[2]:
                    sys.exit(f"the session answers otherwise: {answers[1:]}")
        for (way, objective), times in seconds.items():
            print(
                f"{rule:<8}{objective:<8}{way:<14} first {1000 * times[0]:6.0f} ms, "
                f"then {1000 * statistics.median(times[1:]):6.1f} ms (median of {len(times) - 1}), "
                f"at most {1000 * max(times[1:]):6.0f} ms"
            )


if __name__ == "__main__":
    main()
