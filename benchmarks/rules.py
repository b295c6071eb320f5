"""What rules of one's own cost: each ready-made constraint, against the question without it, in one run.

    python benchmarks/rules.py --family recipe-like --family deep --units 100000 --goals 5
    python benchmarks/rules.py --family deep --units 1000000 --store      each asked of a store
    python benchmarks/rules.py DIR...      networks in folders, such as a universal FOON

Prints a table in Markdown, a row for each network, objective and constraint, over all goals. One that deletes
units is held against the same network written without these units, another against the question without a
rule. Values of constants are chosen from the network and from the best tree without the rule, so that they
matter: a motion that many units have, one use fewer than the best tree makes, and so on. For those that look
at where units were read, a network without videos has one unit of 32 from another file, and one of 32 from a
single video. What is allowed is
1.2 times the other time for a rule that deletes, and 5 times for others, plus 0.1 s; *within* counts the
goals that took no more, and *of allowed* is the median of what they took of that. Times are seconds of
processors, after reading, those of clingo's own process included. With ``--store`` each network, also one
written without units, is imported into a store, which every question opens anew: seconds are then from
opening it to the answer, and no question has anything from one before. ``--plain SECONDS`` solves each
question with ``--reduce none`` as well, the plain program under the same options of clingo, in a process of
its own for at most so many seconds of a processor. It compares the answers, and says how many were proved so
and what they took, at the limit as well; the exit code is 1 where two differ.
"""

import argparse
import gc
import os
import pickle
import random
import resource
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from statistics import median
from typing import NamedTuple

from foon_asp.asp import Outcome, Settings, Status, solve
from foon_asp.dataset.reading_store import read_store
from foon_asp.deadline import Deadline
from foon_asp.hypergraph import NONE
from foon_asp.network import Network, NetworkBuilder, Source
from foon_asp.problem import ContainerRule, Objective, Problem, Restriction, levels, reach
from foon_asp.processes.python_process import _end_all
from foon_asp.questions.answer import answer_under_rules
from foon_asp.rules.ready_made import ready_made
from foon_asp.store.import_files import import_files
from foon_asp.text.data_folder import DataFiles, find_data, read_data
from foon_asp.text.node_lookup import nodes_of_entry
from foon_asp.text.writer import write_units

COLUMNS = (
    "data",
    "objective",
    "constraint",
    "units removed",
    "trees",
    "proved",
    "without s",
    "with s",
    "worst s",
    "of allowed",
    "within",
    "plain proved",
    "plain s",
)
DELETING = {
    *("forbid_motion", "forbid_object", "forbid_ingredient", "never_heated"),
    *("motion_only_with", "least_rate", "only_sources", "at_least_videos"),
}
_OFTEN, _VIDEOS = "often.txt", ("https://foon.example/1", "https://foon.example/2")
_SELDOM = 1 / 32  # of the units are from elsewhere
_TRIED = 8  # values of a constant, the most frequent ones, of which the one that leaves most trees is taken
_MANY = 500_000  # units, of which all are looked at for each value: so two are tried


class Asked(NamedTuple):
    """A constraint with its constants."""

    name: str
    constants: tuple[str, ...]

    @property
    def settings(self) -> Settings:
        """How to ask under it."""
        return Settings((Path(self.name),), constants=self.constants)


class Stores:
    """Stores made of networks, in a folder; what stands beside the networks is that of some files."""

    def __init__(self, folder: Path, files: DataFiles) -> None:
        self._folder, self._files = folder, files

    def of(self, network: Network, name: str, removed: Callable[[int], bool] = lambda _: False) -> Path:
        """Give the store of a network without the units removed, each from the file and videos it has.

        It is made when it is asked for by this name first.
        """
        store = self._folder / f"{name}.foon"
        if store.exists():
            return store
        texts: dict[tuple[str, tuple[str, ...]], list[int]] = {}
        for unit, (source, *_) in enumerate(network.sources):
            if not removed(unit):
                texts.setdefault((Path(source.file).name, source.videos), []).append(unit)
        files = []
        for number, ((file, videos), units) in enumerate(texts.items()):
            path = self._folder / name / str(number) / file
            path.parent.mkdir(parents=True)
            written = write_units(map(network.unit, units), [f"Source:\t{video}" for video in videos])
            path.write_text(written, encoding="utf-8")
            files.append(path)
        import_files(self._files._replace(network=tuple(files)), store, lenient=True)
        shutil.rmtree(self._folder / name)
        return store


def opened(store: Path, problem: Problem) -> Problem:
    """Ask a store for the same goals."""
    dataset = read_store(DataFiles((store,)), 3)
    return dataset.nearby(dataset.command_goal_ids(problem.goal_nodes), problem.containers.value)


class Measured(NamedTuple):
    """A question without a rule and with it: seconds, and the outcome with it."""

    without: float
    with_: float
    outcome: Outcome
    allowed: float
    plain: float | None = None
    plain_proved: bool = False


def main() -> int:
    """Read the command line, ask everything and print; 1 where two answers differ."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("folders", nargs="*", type=Path, metavar="DIR")
    parser.add_argument("--family", action="append", default=[], metavar="NAME", help="see generate.py")
    parser.add_argument("--units", action="append", type=int, default=[])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--goals", type=int, default=5, help="the number of last goals of each")
    parser.add_argument("--any", action="store_true", help="goals at random among what can be made")
    parser.add_argument("--constraint", action="append", default=[], help="only these")
    parser.add_argument("--objectives", default="units,success")
    parser.add_argument("--containers", type=ContainerRule, default=ContainerRule.STRICT)
    parser.add_argument("--limit", type=float, default=60, metavar="SECONDS")
    parser.add_argument("--store", action="store_true", help="ask stores made of the networks")
    parser.add_argument("--plain", type=float, metavar="SECONDS", help="also without reductions")
    arguments = parser.parse_args()
    print("| " + " | ".join(COLUMNS) + " |")
    print("|" + "---|" * len(COLUMNS))
    different = 0
    for folder in arguments.folders:
        different += _folder(folder, arguments)
    with tempfile.TemporaryDirectory() as made:
        for family in arguments.family:
            for units in arguments.units or [1000]:
                folder = Path(made) / f"{family}-{units}"
                words = [f"--family={family}", f"--units={units}", f"--seed={arguments.seed}"]
                script = Path(__file__).with_name("generate.py")
                subprocess.run(
                    [sys.executable, script, *words, f"--out={folder}"], check=True, stdout=sys.stderr
                )
                different += _folder(folder, arguments)
    return 1 if different else 0


def _folder(folder: Path, arguments: argparse.Namespace) -> int:
    files = find_data(folder, (), None, None, None, None)
    data = read_data(files, lenient=True)
    network, kitchen = data.network, data.kitchen
    if not any(source.videos for sources in network.sources for source in sources):
        network = _with_sources(network, random.Random(arguments.seed))
        kitchen = _same(kitchen, data.network, network)

    def posed(goal: int) -> Problem:
        return Problem(network, kitchen, (goal,), data.rates, data.utensils, arguments.containers)

    if arguments.any:
        made = sorted(reach(posed(0)).makers)
        goals = random.Random(arguments.seed).sample(made, min(arguments.goals, len(made)))
    else:
        goals = list(dict.fromkeys(node for entry in data.goals for node in nodes_of_entry(entry, network)))
        goals = goals[-arguments.goals :]
    problems = [posed(goal) for goal in goals]
    _ = problems[0].needs, problems[0].makers  # indexes of the network
    with tempfile.TemporaryDirectory(dir=folder) as kept:
        stores = Stores(Path(kept), files) if arguments.store else None
        return _ask_all(folder.name, problems, stores, arguments)


def _ask_all(data: str, problems: list[Problem], stores: Stores | None, arguments: argparse.Namespace) -> int:
    only: list[str] = arguments.constraint
    store = stores.of(problems[0].network, "whole") if stores else None
    gc.freeze()  # a process that opens a store has no network in memory
    deleting: list[Asked] | None = None
    different = 0
    for name in arguments.objectives.split(","):
        objectives = (Objective(name),)
        best = [
            solve(problem, objectives, Settings(deadline=Deadline(arguments.limit))) for problem in problems
        ]
        trees = [outcome for outcome in best if outcome.units]
        if deleting is None:
            deleting = list(_deleting(trees, only))
        rows: dict[str, list[Measured]] = {}
        for asked, of in (*((each, trees) for each in deleting), *_others(trees)):
            if only and asked.name not in only:
                continue
            row = [_asked(outcome, objectives, asked, arguments.limit, store) for outcome in of]
            if asked.name in DELETING:
                row = list(_without_units(row, objectives, asked, arguments.limit, stores))
            if arguments.plain:
                both = [_with_plain(m, objectives, asked, arguments.plain) for m in row]
                row = [measured for measured in both if measured is not None]
                different += len(both) - len(row)
            rows.setdefault(asked.name, []).extend(row)
            if asked.name in DELETING:
                _print(data, objectives, asked, row)
        for constraint, row in rows.items():
            if constraint not in DELETING:
                _print(data, objectives, Asked(constraint, ()), row)
    return different


def _with_sources(network: Network, chance: random.Random) -> Network:
    """Give the same network with files and videos for the units."""
    builder = NetworkBuilder()
    for line, unit in enumerate(network, 1):
        file = "seldom.txt" if chance.random() < _SELDOM else _OFTEN
        videos = _VIDEOS[: 1 if chance.random() < _SELDOM else 2]
        builder.add(unit.motion, list(unit.inputs), list(unit.outputs), Source(file, line, videos=videos))
    return builder.build()


def _same(nodes: Iterable[int], before: Network, after: Network) -> frozenset[int]:
    """Give the ids of nodes in another network, of those that it has."""
    found = (after.object_id(before.objects[o]) for o in nodes)
    return frozenset(o for o in found if o is not None)


def _deleting(trees: list[Outcome], only: list[str]) -> Iterator[Asked]:
    """Give constraints that remove units, with constants that leave as many goals a tree as can be."""
    problem = trees[0].problem
    network = problem.network
    motions, labels, ingredients = _words(network)
    tried = _TRIED if len(network) < _MANY else 2
    files = Counter(source.file for sources in network.sources for source in sources)
    rates = sorted(set((problem.rates or {}).values()))
    for name, constant, values in (
        ("forbid_motion", "forbidden_motion", [f'"{m}"' for m, _ in motions.most_common(tried)]),
        ("forbid_object", "forbidden_object", [f'"{m}"' for m, _ in labels.most_common(tried)]),
        ("forbid_ingredient", "forbidden_ingredient", [f'"{m}"' for m, _ in ingredients.most_common(tried)]),
        (
            "never_heated",
            "unheated_ingredient",
            [f'"{m}"' for m, _ in ingredients.most_common(tried)],
        ),
        ("motion_only_with", "tied_motion", [f'"{m}"' for m, _ in motions.most_common(tried)]),
        ("least_rate", "least_rate", [str(int(rate * 10**6)) for rate in rates[1 : 1 + tried]][::-1]),
        ("only_sources", "allowed_source", [f'"{m}"' for m, _ in files.most_common(1)]),
        ("at_least_videos", "least_videos", ["2"]),
    ):
        tied = ('tied_utensil="knife"',) if name == "motion_only_with" else ()
        asked = [Asked(name, (f"{constant}={value}", *tied)) for value in values]
        if asked and (not only or name in only):
            yield max(asked, key=lambda each: _trees_left(each, trees))


def _words(network: Network) -> tuple[Counter[str], Counter[str], Counter[str]]:
    """Count motions, and in how many units labels and ingredients are."""
    labels, ingredients = Counter[str](), Counter[str]()
    for sides in zip(network.inputs, network.outputs, strict=True):
        nodes = [network.objects[o] for side in sides for o in side]
        labels.update({node.label for node in nodes})
        ingredients.update({item for node in nodes for item in node.ingredients})
    return Counter(network.motions), labels, ingredients


def _others(trees: list[Outcome]) -> Iterator[tuple[Asked, list[Outcome]]]:
    """Give the other constraints with constants that matter, each with the tree of whose goal it is asked."""
    problem = trees[0].problem
    network = problem.network
    motions, labels, ingredients = _words(network)
    for outcome in trees:
        used = Counter(network.motions[unit] for unit in outcome.units or ())
        [(often, uses)] = used.most_common(1)
        motion = f'limited_motion="{often}"'
        yield Asked("at_most_motion", (motion, f"max_uses={uses - 1}")), [outcome]
        yield Asked("at_most_units", (f"max_units={len(outcome.units or ())}",)), [outcome]
        touched = {o for u in outcome.units or () for o in (*network.inputs[u], *network.outputs[u])}
        held = {network.objects[o].label for o in touched}
        yield Asked("at_most_utensils", (f"max_utensils={len(held & problem.utensils) - 1}",)), [outcome]
        some = [m for m, _ in used.most_common()]
        words = (f'earlier_motion="{some[-1]}"', f'later_motion="{some[len(some) // 2]}"')
        yield Asked("before", words), [outcome]
        for name, constant, counted, there in (
            ("require_motion", "required_motion", motions, set(used)),
            ("require_object", "required_object", labels, held),
            ("require_ingredient", "required_ingredient", ingredients, held),
            ("require_intermediate", "required_intermediate", labels, held),
        ):
            other = next((value for value, _ in counted.most_common() if value not in there), None)
            if other is not None:
                yield Asked(name, (f'{constant}="{other}"',)), [outcome]


def _restricted(problem: Problem, asked: Asked) -> Problem:
    rules = ready_made(asked.settings.constraints, asked.settings.constants)
    assert rules is not None
    found = rules.restriction_of(problem, Deadline())
    assert isinstance(found, Restriction)
    return replace(problem, restriction=found)


def _trees_left(asked: Asked, trees: list[Outcome]) -> tuple[int, int]:
    """Count of how many goals a tree is left, and then the units that are removed."""
    rules = ready_made(asked.settings.constraints, asked.settings.constants)
    assert rules is not None
    problem = trees[-1].problem
    found = rules.restriction_of(problem, Deadline())
    if not isinstance(found, Restriction):
        return 0, 0
    available = reach(replace(problem, restriction=found)).available
    left = sum(available[outcome.problem.goals[0]] for outcome in trees)
    return left, sum(map(found.removed, range(len(problem.network))))


def _timed(
    problem: Problem, objectives: tuple[Objective, ...], settings: Settings, store: Path | None
) -> tuple[float, Outcome]:
    began = _spent()
    outcome: Outcome
    if store is None:
        outcome = solve(problem, objectives, settings)
    else:
        outcome = answer_under_rules(opened(store, problem), objectives, settings).outcome
    return _spent() - began, outcome


def _spent() -> float:
    """Give the seconds of processors spent so far; the processes of clingo are ended, so that they count."""
    _end_all()
    found = map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(each.ru_utime + each.ru_stime for each in found)


def _asked(
    outcome: Outcome, objectives: tuple[Objective, ...], asked: Asked, limit: float, store: Path | None
) -> Measured:
    problem = outcome.problem
    without, _ = _timed(problem, objectives, Settings(deadline=Deadline(limit)), store)
    with_, found = _timed(problem, objectives, asked.settings._replace(deadline=Deadline(limit)), store)
    return Measured(without, with_, found._replace(problem=problem), 5 * without + 0.1)


def _without_units(
    row: list[Measured],
    objectives: tuple[Objective, ...],
    asked: Asked,
    limit: float,
    stores: Stores | None,
) -> Iterator[Measured]:
    """Ask the same of the network written without the units that are removed."""
    whole = row[0].outcome.problem
    restriction = _restricted(whole, asked).restriction
    assert restriction is not None
    by = levels(objectives)
    for measured, problem in zip(row, _written(row, restriction, stores), strict=True):
        if problem is None:
            yield measured._replace(without=0.0, allowed=0.1)
            continue
        store = stores.of(whole.network, asked.name, restriction.removed) if stores else None
        without, other = _timed(problem, objectives, Settings(deadline=Deadline(limit)), store)
        if Status.UNKNOWN not in {other.status, measured.outcome.status}:
            assert other.status is measured.outcome.status
        if other.status is measured.outcome.status is Status.OPTIMAL:
            assert other.costs is not None
            assert measured.outcome.costs is not None
            assert other.costs.key(by) == measured.outcome.costs.key(by)
        yield measured._replace(without=without, allowed=1.2 * without + 0.1)


def _written(
    row: list[Measured], restriction: Restriction, stores: Stores | None
) -> Iterator[Problem | None]:
    """Give each question to the network without some units, ``None`` where the goal is not in it."""
    whole = row[0].outcome.problem
    left = [unit for unit in range(len(whole.network)) if not restriction.removed(unit)]
    if stores:
        there = {o for u in left for o in (*whole.network.inputs[u], *whole.network.outputs[u])}
        for measured in row:
            problem = measured.outcome.problem
            yield problem if problem.goals[0] in there else None
        return
    builder = NetworkBuilder()
    for unit in left:
        kept = whole.network.unit(unit)
        builder.add(kept.motion, list(kept.inputs), list(kept.outputs), whole.network.sources[unit][0])
    network = builder.build()
    ids = [network.object_id(node) for node in whole.network.objects]
    kitchen = _same(whole.kitchen, whole.network, network)
    for measured in row:
        goal = ids[measured.outcome.problem.goals[0]]
        if goal is None:
            yield None
            continue
        problem = Problem(network, kitchen, (goal,), whole.rates, whole.utensils, whole.containers)
        _ = problem.needs, problem.makers
        yield problem


def _with_plain(
    measured: Measured, objectives: tuple[Objective, ...], asked: Asked, limit: float
) -> Measured | None:
    """Ask the plain program as well; ``None`` where the answers differ."""
    outcome, by = measured.outcome, levels(objectives)
    spent, found = _plain(outcome.problem, objectives, asked, limit)
    ours = outcome.status, None if outcome.costs is None else outcome.costs.key(by)
    proved = {Status.OPTIMAL, Status.INFEASIBLE}
    if found is not None and found[0] in proved and ours[0] in proved and found != ours:
        print(f"DIFFERENT: {asked}, {outcome.problem}: {found} and {ours}")
        return None
    return measured._replace(plain=spent, plain_proved=found is not None and found[0] in proved)


def _plain(
    problem: Problem, objectives: tuple[Objective, ...], asked: Asked, limit: float
) -> tuple[float, tuple[Status, object] | None]:
    """Give what the plain program takes, and its answer, if it has one before the limit."""
    _spent()
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    read, write = os.pipe()
    child = os.fork()
    if not child:
        try:
            resource.setrlimit(resource.RLIMIT_CPU, (int(limit), int(limit)))
            found = solve(problem, objectives, asked.settings._replace(reductions=NONE))
            key = None if found.costs is None else found.costs.key(levels(objectives))
            with os.fdopen(write, "wb") as pipe:
                pickle.dump((found.status, key), pipe)
            _end_all()
        finally:  # a worker of its own may have come to the limit before it
            os._exit(0)
    os.close(write)
    with os.fdopen(read, "rb") as pipe:
        said = pipe.read()
    os.waitpid(child, 0)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    spent = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return spent, pickle.loads(said) if said else None


def _print(data: str, objectives: tuple[Objective, ...], asked: Asked, row: list[Measured]) -> None:
    removed = ""
    plain = [m.plain for m in row if m.plain is not None]
    if asked.name in DELETING:
        restriction = _restricted(row[0].outcome.problem, asked).restriction
        assert restriction is not None
        removed = f"{sum(map(restriction.removed, range(len(row[0].outcome.problem.network)))):,}"
    cells = (
        data,
        objectives[0],
        f"`{asked.name}`",
        removed,
        str(sum(m.outcome.units is not None for m in row)),
        f"{sum(m.outcome.status in {Status.OPTIMAL, Status.INFEASIBLE} for m in row)}/{len(row)}",
        f"{median(m.without for m in row):.2f}",
        f"{median(m.with_ for m in row):.2f}",
        f"{max(m.with_ for m in row):.2f}",
        f"{median(m.with_ / m.allowed for m in row):.2f}",
        f"{sum(m.with_ <= m.allowed for m in row)}/{len(row)}",
        *([] if plain else ["", ""]),
        *([f"{sum(m.plain_proved for m in row)}/{len(row)}", f"{median(plain):.2f}"] if plain else []),
    )
    print("| " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    sys.exit(main())
