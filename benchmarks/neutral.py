"""Public instances as networks in the neutral form, each in a folder that ``--data`` takes.

    python benchmarks/neutral.py DOMAIN.pddl PROBLEM.pddl --out DIR    a planning task without its deletes
    python benchmarks/neutral.py TASK.sas --out DIR                    as Fast Downward's translator writes it
    python benchmarks/neutral.py EGRAPH.json --out DIR                 an e-graph of egraph-serialize

    foon-asp solve --data DIR --objective price --goal ...

The folder gets ``network.jsonl``, ``kitchen.json`` and ``goal_nodes.json``; all its goals belong together. A
task in PDDL is read as by ``foon-asp relax``, by the translator of Fast Downward (``pip install
'foon-asp[pddl]'``, GPL); what that wrote is read without it.
Where an e-graph has negative costs, its extraction costs less than the tree by the figure that is printed.
"""

import argparse
import json
from fractions import Fraction
from pathlib import Path

from fields.egraph import EGraph

from foon_asp.deadline import Deadline
from foon_asp.planning.strips_task import StripsTask
from foon_asp.planning.task_files import read_task
from foon_asp.text.exact_number import decimal_text
from foon_asp.text.neutral_writer import write_neutral_unit


def write_task(task: StripsTask, folder: Path) -> None:
    """Write a task as a folder of data."""
    folder.mkdir(parents=True, exist_ok=True)
    names = task.facts
    with (folder / "network.jsonl").open("w", encoding="utf-8") as file:
        for action in task.actions:
            if action.add_effects:
                preconditions, add_effects = (
                    [names[o] for o in side] for side in (action.preconditions, action.add_effects)
                )
                file.write(
                    write_neutral_unit(action.name, preconditions, add_effects, decimal_text(action.cost))
                )
    for name, facts in (("kitchen.json", sorted(task.start)), ("goal_nodes.json", task.goals)):
        listed = [{"label": names[o]} for o in facts]
        (folder / name).write_text(json.dumps(listed, indent=0) + "\n", encoding="utf-8")


def main() -> None:
    """Read the command line and write the folder."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("files", nargs="+", type=Path)
    parser.add_argument("--out", required=True, type=Path)
    options = parser.parse_args()
    if len(options.files) == 1 and options.files[0].suffix == ".json":
        task, offset = EGraph.read(options.files[0]).task()
    else:
        task, offset = read_task(options.files, Deadline()), Fraction(0)
    write_task(task, options.out)
    print(
        f"{options.out}: {len(task.actions)} units, {len(task.facts)} object nodes, {len(task.goals)} goals"
    )
    if offset:
        print(f"an extraction costs {offset} less than its tree")


if __name__ == "__main__":
    main()
