"""Comparisons of searches as tables: a row for each goal and search, and summaries over goals."""

from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction

from foon_asp.asp import Status
from foon_asp.comparison.comparison import MEASURED, Comparison, SearchResult
from foon_asp.comparison.published_table import PublishedTable
from foon_asp.comparison.summary import Summary
from foon_asp.json_layout import Json
from foon_asp.network import counted
from foon_asp.problem import Objective, multiplies
from foon_asp.proof.simulation import Verdict
from foon_asp.results.plain_values import plain
from foon_asp.results.table import Block, Cell, Table
from foon_asp.results.table_columns import flat_row
from foon_asp.results.values import Figure

_HEADINGS = ("search", "units", "inputs", "success", "executes", "used up")
_EXECUTES = {
    Verdict.AS_LISTED: ("as listed", "good"),
    Verdict.REORDERED: ("when reordered", ""),
    Verdict.NEVER: ("never", "bad"),
}
_NO_RATIO = " " * len("  1.00×")
_BETTER = "† better than the proved optimum, as only a tree that does not execute can be"
_PREDICATES: dict[str, Callable[[SearchResult], bool | None]] = {
    "execute": lambda result: result.executes,
    "as listed": lambda result: result.verdict is Verdict.AS_LISTED,
    "when reordered": lambda result: result.verdict is Verdict.REORDERED,
    "never": lambda result: result.verdict is Verdict.NEVER,
    "used up": lambda result: result.runs_used_up,
}
_RARE_PREDICATES: dict[str, Callable[[SearchResult], bool]] = {
    "(cycle)": lambda result: result.has_cycle,
    "break a rule": lambda result: bool(result.breaks),
    "† smaller": lambda result: result.beats_the_optimum(Objective.UNITS),
}


def tidy_rows(comparison: Comparison) -> Iterator[Json]:
    """Yield a row for each search of a goal, as plain values by column.

    A row says how the tree executes, which node it lacks, and which rules it breaks. For each objective, it
    has the measure of the tree, the optimum with its status, and the ratio of the two.
    """
    for result in comparison.searches:
        missing = result.stuck_at if result.obstacle is None else result.obstacle.missing
        row: Json = {
            "goal": comparison.goal.node,
            "search": result.search,
            "ending": result.ending,
            "verdict": result.verdict,
            "executes": result.executes,
            "runs_used_up": result.runs_used_up,
            "cycle": result.has_cycle,
            "missing": missing and missing.node,
            "breaks": result.breaks,
        }
        for objective in MEASURED:
            optimum = comparison.optimum.get(objective)
            row[objective] = result.measures.get(objective)
            row[f"{objective}_optimum"] = optimum and optimum.value
            row[f"{objective}_status"] = optimum and optimum.status
            row[f"{objective}_ratio"] = result.ratios.get(objective)
        yield flat_row(plain(row))


def comparison_table(comparisons: Sequence[Comparison], used_up_noted: bool) -> Iterator[Block]:
    """Yield a table of comparisons, and notes on the signs in it.

    Parameters:
        comparisons: The comparisons, one for each goal.
        used_up_noted: Whether to explain the column on items that are used up.
    """
    results = [result for comparison in comparisons for result in comparison.searches]
    broken = sorted({rule for result in results for rule in result.breaks})
    rows: list[Sequence[str | Cell] | str] = []
    for comparison in comparisons:
        optima = [comparison.optimum.get(objective) for objective in MEASURED]
        optimum_texts = [
            "" if best is None or best.value is None else _measure_text(objective, best.value) + _NO_RATIO
            for objective, best in zip(MEASURED, optima, strict=True)
        ]
        status = " ".join(dict.fromkeys(best.status for best in optima if best))
        rows += ["", comparison.goal.node]
        rows.append([Cell(text, "strong") for text in ("optimum", *optimum_texts, status, "")])
        rows += [tuple(_search_cells(result, broken)) for result in comparison.searches]
    yield Table(_HEADINGS, rows, frozenset({0, 4, 5}))
    yield ""
    yield "× how many times the proved optimum of that objective"
    if used_up_noted:
        yield "used up: whether the tree runs if each item is used once (--items used-up)"
    if any(result.beats_the_optimum(objective) for result in results for objective in MEASURED):
        yield _BETTER + (", or one that breaks a rule" if broken else "")
    yield from (f"({number}) breaks {rule}" for number, rule in enumerate(broken, 1))
    if any(result.has_cycle for result in results):
        yield "(cycle) units of the tree wait for each other"
    if any(best.status is Status.FEASIBLE for row in comparisons for best in row.optimum.values()):
        yield "feasible: stopped at the time limit, so that optimum is not proved and has no ratios"


def _search_cells(result: SearchResult, broken: Sequence[str]) -> Iterator[str | Cell]:
    """Yield the cells of the row of a search for a goal.

    A rule that the tree breaks is shown by its number from 1 in ``broken``. Without a tree, the cell on
    execution says how the search ended.
    """
    yield result.search
    yield from (_measure_cell(result, objective) for objective in MEASURED)
    if result.verdict is None:
        yield f"no tree: {result.ending}" + (f" at {result.stuck_at}" if result.stuck_at else "")
    else:
        text, style = _EXECUTES[result.verdict]
        numbers = ",".join(str(broken.index(rule) + 1) for rule in result.breaks)
        yield Cell(text + (" (cycle)" if result.has_cycle else f" ({numbers})" if numbers else ""), style)
    yield "" if result.runs_used_up is None else "yes" if result.runs_used_up else "no"


def _measure_cell(result: SearchResult, objective: Objective) -> str:
    """Return the measure of a tree and its ratio to a proved optimum: ``10  1.11×``; empty if unknown.

    A ``†`` marks a measure that is better than the optimum.
    """
    measure = result.measures.get(objective)
    if measure is None:
        return ""
    text = ("†" if result.beats_the_optimum(objective) else "") + _measure_text(objective, measure)
    ratio = result.ratios[objective]
    if ratio is None:
        return text + _NO_RATIO
    return f"{text} {float(ratio):>5.2f}×" if ratio >= Fraction(1, 100) else f"{text} {float(ratio):.0e}×"


def summary_tables(summaries: Sequence[Summary], proved: bool) -> Iterator[Block]:
    """Yield summary tables over many goals: how many trees execute, and their ratios to the optimum.

    Columns for cycles, broken rules and trees better than the optimum are there only if some tree has them.
    The share of trees that execute is of the trees that a search returned, not of all goals.

    Parameters:
        summaries: One for each search.
        proved: Whether every optimum is proved.
    """
    goal_count = max(len(summary.results) for summary in summaries)
    yield f"{counted(goal_count, 'goal')}; {'every' if proved else 'NOT every'} optimum is proved"
    rare_predicates = {
        heading: predicate
        for heading, predicate in _RARE_PREDICATES.items()
        if any(map(predicate, (result for summary in summaries for result in summary.results)))
    }
    rows = []
    for summary in summaries:
        trees = [result for result in summary.results if result.verdict is not None]
        predicates = (_PREDICATES | rare_predicates).values()
        counts = [sum(map(bool, map(predicate, trees))) for predicate in predicates]
        shares = (f"{count} ({count / max(len(trees), 1):.1%})" for count in counts)
        rows.append((summary.search, f"{len(trees)} ({len(trees) / goal_count:.1%})", *shares))
    headings = ("search", "with a tree", *_PREDICATES, *rare_predicates)
    yield from ("", Table(headings, rows, frozenset({0})))
    distances = [
        (
            summary.search,
            objective,
            f"{float(distance.share):.1%}",
            *map(_ratio_text, (distance.mean, distance.median, distance.percentile_90, distance.worst)),
            distance.worst_goal if distance.worst > 1 else "",
        )
        for summary in summaries
        for objective, distance in summary.distances.items()
    ]
    if distances:
        yield from ("", "times worse than the optimum, of the trees that execute and keep to the rules")
        statistics = ("optimal", "mean", "median", "90th percentile", "worst")
        yield Table(("search", "objective", *statistics, "worst goal"), distances, frozenset({0, 1, 7}))


def published_table(table: PublishedTable, comparisons: Sequence[Comparison]) -> Iterator[Block]:
    """Yield a table of published and measured numbers of units, and how many agree for each search.

    The last column is the optimum, or its status if no optimum is known.
    """
    yield from ("Functional units, published → measured; = where they agree", "")
    agreeing_counts = dict.fromkeys(table.columns, 0)
    rows = []
    for comparison in comparisons:
        label, best = comparison.goal.label, comparison.optimum[Objective.UNITS]
        units = {result.search: result.measures.get(Objective.UNITS) for result in comparison.searches}
        cells = []
        for search in table.columns:
            published, measured_units = table.goals[label][search], units.get(search)
            agreeing_counts[search] += measured_units == published
            measured = "no tree" if measured_units is None else str(measured_units)
            cells.append(f"{published} =" if measured_units == published else f"{published} → {measured}")
        rows.append((label, *cells, best.status if best.value is None else str(best.value)))
    yield Table(("goal", *table.columns, "optimum"), rows, frozenset({0}))
    counts = ", ".join(f"{search} {count} of {len(rows)}" for search, count in agreeing_counts.items())
    yield from ("", f"Agreeing: {counts}", "", f"Published: {table.source}")


def _measure_text(objective: Objective, value: Figure) -> str:
    """Return a measure as text: a whole number, or a success rate such as ``0.6440`` or ``6.44e-04``."""
    if not multiplies(objective):
        return str(value)
    return f"{float(value):.4f}" if value >= Fraction(1, 1000) else f"{float(value):.2e}"


def _ratio_text(value: Fraction) -> str:
    """Return a ratio in three digits, or from 1000 on in two digits with an exponent."""
    return f"{float(value):.3g}" if value < 1000 else f"{float(value):.1e}"
