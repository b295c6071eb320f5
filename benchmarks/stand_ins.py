"""Stand-ins on real recipes: goals answered, proofs, time, what is wrong, and two threshold methods.

    python benchmarks/stand_ins.py ../shared/corpus
    python benchmarks/stand_ins.py ../shared/corpus --trees --containers implied --similar similar.txt

Every stand-in that is used is looked up in ``stand_in_verdicts.tsv``, judged once by reading: right or wrong,
and why.

The threshold methods are written here from their descriptions. *Names*: every label that the network lacks is
replaced by the most similar one that it has, if that is similar enough (0.9), and the nodes of the recipe are
looked up again (as ``foon_api`` does; here by letters, which needs no model). *Nodes*: every node that the
kitchen lacks is replaced by the most similar item, by a mean over label, states and ingredients (as Sakib's
retrieval of task trees does). Neither checks that the result executes; that is done here.
"""

import argparse
import statistics
import sys
import time
from collections.abc import Iterator, Mapping
from difflib import SequenceMatcher
from fractions import Fraction
from functools import cache, partial
from pathlib import Path
from typing import NamedTuple

import foon_asp
from foon_asp.certificate.certificate import subject_of
from foon_asp.errors import UserError
from foon_asp.network import Network, ObjectNode, StandInTable
from foon_asp.problem import Objective, Problem
from foon_asp.proof import verifier
from foon_asp.proof.simulation import Verdict, simulate_for
from foon_asp.standins.table_file import read_stand_ins
from foon_asp.text.answer_file import read_listed_tree
from foon_asp.text.reader import FoonReader

THRESHOLD = 0.9
VERDICTS = Path(__file__).with_name("stand_in_verdicts.tsv")


class Replaced(NamedTuple):
    """What one method does with a recipe: whether it answers, whether that executes, and what it replaces."""

    answered: bool
    executes: bool
    pairs: list[tuple[str, str]]  # used, and for what


def verdicts() -> dict[tuple[str, str], str]:
    """Give the verdict on each stand-in, by what is used and for what."""
    rows = (line.split("\t") for line in VERDICTS.read_text(encoding="utf-8").splitlines())
    return {(row[1], row[2]): row[0] for row in rows if not row[0].startswith("#")}


@cache
def likeness(one: str, other: str) -> float:
    """Give how similar two names are, from 0 to 1."""
    if one == other:
        return 1.0
    matcher = SequenceMatcher(None, one, other)
    return matcher.ratio() if matcher.real_quick_ratio() >= THRESHOLD else 0.0


def likeness_of_sets(ours: frozenset[str], theirs: frozenset[str]) -> float:
    """Give the mean over one set of how similar its most similar name in the other is."""
    if not ours or not theirs:
        return 1.0 if ours == theirs else 0.0
    return statistics.mean(max(likeness(name, other) for other in theirs) for name in ours)


def by_names(problem: Problem, recipe: range) -> Replaced:
    """Replace every label of a recipe that the others lack by the most similar one, and run it."""
    network = problem.network
    others = {node.label for node in others_of(network, recipe)}
    labels: dict[str, str] = {}
    for label in {node.label for node in nodes_of(network, recipe)} - others:
        best = max(others, key=partial(likeness, label))
        if likeness(label, best) >= THRESHOLD:
            labels[label] = best
    words = {
        node: node._replace(label=labels.get(node.label, node.label)) for node in nodes_of(network, recipe)
    }
    return run(problem, recipe, words)


def by_nodes(problem: Problem, recipe: range) -> Replaced:
    """Replace every node of a recipe that is neither made nor at hand by the most similar item."""
    network = problem.network
    made = {o for unit in recipe for o in network.outputs[unit]}
    items = [network.objects[o] for o in problem.kitchen]
    words: dict[ObjectNode, ObjectNode] = {}
    for node in nodes_of(network, recipe):
        words[node] = node
        o = network.object_id(node)
        if o in problem.kitchen or o in made:
            continue
        parts = frozenset(node.states), frozenset(node.ingredients)

        def score(
            item: ObjectNode, node: ObjectNode = node, parts: tuple[frozenset[str], ...] = parts
        ) -> float:
            sets = frozenset(item.states), frozenset(item.ingredients)
            return statistics.mean((likeness(node.label, item.label), *map(likeness_of_sets, parts, sets)))

        best = max(items, key=score)
        if score(best) >= THRESHOLD:
            words[node] = best
    return run(problem, recipe, words)


def run(problem: Problem, recipe: range, words: Mapping[ObjectNode, ObjectNode]) -> Replaced:
    """Execute the units of a recipe in other words, from the kitchen, in any order."""
    network = problem.network
    units = [
        foon_asp.FunctionalUnit.of(
            unit.motion, [words[node] for node in unit.inputs], [words[node] for node in unit.outputs]
        )
        for unit in (network.unit(number) for number in recipe)
    ]
    pairs = [(str(used), str(node)) for node, used in words.items() if used != node]
    verdict = simulate_for(problem, foon_asp.TaskTree(tuple(units))).verdict
    return Replaced(True, verdict is not Verdict.NEVER, pairs)


def nodes_of(network: Network, units: range) -> dict[ObjectNode, None]:
    """Give the nodes of some units, in order."""
    return dict.fromkeys(
        network.objects[o] for unit in units for o in (*network.inputs[unit], *network.outputs[unit])
    )


def others_of(network: Network, units: range) -> dict[ObjectNode, None]:
    """Give the nodes of the units that come after some."""
    return nodes_of(network, range(len(units), len(network)))


def recipes(corpus: Path, table: StandInTable) -> Iterator[tuple[Path, Problem, Problem, range]]:
    """Give each recipe with the universal network: with stand-ins, without, and its own units."""
    universal = corpus / "universal"
    for file in sorted((corpus / "subgraphs").glob("*.txt")):
        own = len(foon_asp.load(file, lenient=True).network)
        networks, kitchen = [file, universal / "FOON.txt"], universal / "kitchen.json"
        foon = foon_asp.load(networks, kitchen=kitchen, lenient=True, stand_ins=table)
        plain = foon_asp.load(networks, kitchen=kitchen, lenient=True)
        goal = foon.network.objects[foon.dataset.goal_ids(())[0]]
        began = time.perf_counter()
        posed = foon.problem(goal)
        posed.__dict__["seconds"] = time.perf_counter() - began
        yield file, posed, plain.problem(goal), range(own)


def main() -> None:
    """Print a line for each recipe, and the sums."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("corpus", type=Path)
    parser.add_argument("--table", type=Path, action="append", default=[], metavar="FILE")
    parser.add_argument("--similar", type=Path, action="append", default=[], metavar="FILE")
    parser.add_argument("--trees", action="store_true", help="Repair the trees of language models.")
    parser.add_argument("--containers", choices=("strict", "implied"), default="strict")
    options = parser.parse_args()
    table = read_stand_ins(options.table, options.similar)
    if options.trees:
        repair_trees(options.corpus, table, options.containers)
    else:
        answer_recipes(options.corpus, table)


def answer_recipes(corpus: Path, table: StandInTable) -> None:
    """Answer each recipe by stand-ins and by the threshold methods."""
    judged, seconds, makeable = verdicts(), [], 0
    methods: dict[str, list[Replaced]] = {"stand-ins": [], "names": [], "nodes": []}
    total, proved = Fraction(0), 0
    for file, posed, plain, own in recipes(corpus, table):
        began = time.perf_counter()
        answer = foon_asp.solve(posed)
        took = posed.__dict__["seconds"] + time.perf_counter() - began
        seconds.append(took)
        certified = foon_asp.solve(posed, certificate="/dev/null").certificate
        if certified is not None:
            verifier.verify(certified.content, subject_of(posed))
            proved += certified.claim != "bound"
        pairs = [(str(s.used), str(s.stands_in_for)) for s in answer.stand_ins or ()]
        methods["stand-ins"].append(Replaced(bool(answer), bool(answer), pairs))
        methods["names"].append(by_names(plain, own))
        methods["nodes"].append(by_nodes(plain, own))
        makeable += bool(foon_asp.solve(plain))
        cost = answer.costs.measure(Objective.DISSIMILARITY) if answer.costs else Fraction(0)
        total += cost
        sys.stdout.write(f"{file.name}\t{answer.status}\t{cost}\t{len(pairs)}\t{took:.3f}\n")
    sys.stdout.write(
        f"\n{len(seconds)} recipes, {makeable} without stand-ins; {proved} certificates verified; "
        f"median {statistics.median(seconds):.3f} s, greatest {max(seconds):.3f} s; dissimilarity {total}\n"
    )
    for name, replaced in methods.items():
        pairs = [pair for each in replaced for pair in each.pairs]
        wrong = [pair for pair in pairs if judged.get(pair) == "wrong"]
        unjudged = [pair for pair in pairs if pair not in judged]
        prices = [priced(table, *pair) for pair in pairs]
        sys.stdout.write(
            f"{name}\tanswered {sum(each.answered for each in replaced)}\t"
            f"executes {sum(each.executes for each in replaced)}\treplacements {len(pairs)}\t"
            f"wrong {len(wrong)}\t"
            f"not judged {len(unjudged)}\tnever by the table {prices.count(None)}\n"
        )
        sys.stdout.writelines(f"  not judged\t{used}\t{served}\n" for used, served in unjudged)


def priced(table: StandInTable, used: str, served: str) -> object:
    """Give the dissimilarity of a replacement, ``None`` for one that the table never allows."""
    return table.dissimilarity(foon_asp.parse_node(used), foon_asp.parse_node(served))


def repair_trees(corpus: Path, table: StandInTable, containers: str) -> None:
    """Repair each tree of a language model, and verify the certificate of the repair."""
    universal, seconds = corpus / "universal", []
    counts = {"before": 0, "after": 0, "proved": 0, "verified": 0, "read": 0}
    files = sorted((corpus / "llm-trees").glob("*.json"))
    for file in files:
        utensils = universal / "utensils.txt"
        try:
            networks = [universal / "FOON.txt", file]
            foon = foon_asp.load(
                networks, kitchen=universal / "kitchen.json", utensils=utensils, stand_ins=table
            )
            tree = [unit for unit, _ in read_listed_tree(file, FoonReader(lenient=True)).units or ()]
        except UserError as error:
            sys.stdout.write(f"{file.name}\tnot read: {str(error).splitlines()[0][-60:]}\n")
            continue
        counts["read"] += 1
        began = time.perf_counter()
        problem = foon.problem(tree[-1].outputs[-1], containers=containers)
        repaired = foon_asp.repair(problem, tree)
        seconds.append(time.perf_counter() - began)
        certified = foon_asp.repair(problem, tree, certificate="/dev/null").certificate
        if certified is not None:
            counts["verified"] += foon_asp.verify(foon, certified).claim != "bound"
        counts["before"] += repaired.verdict is not Verdict.NEVER
        counts["after"] += repaired.units is not None
        counts["proved"] += repaired.proof is not None
        cost = repaired.costs.measure(Objective.DISSIMILARITY) if repaired.costs else "-"
        sys.stdout.write(
            f"{file.name}\t{repaired.status}\t{cost}\t{len(repaired.stand_ins)} stand-ins\t"
            f"{len(repaired.added)} added\t{seconds[-1]:.2f} s\t{', '.join(map(str, repaired.lacking))}\n"
        )
    sys.stdout.write(
        f"\n{len(files)} trees, {counts['read']} read; execute before {counts['before']}, "
        f"after {counts['after']}; proved {counts['proved']}; {counts['verified']} certificates verified; "
        f"median {statistics.median(seconds):.2f} s\n"
    )


if __name__ == "__main__":
    main()
