"""Comparisons as tables: for a terminal, as Markdown and as CSV."""

import csv
import io
import re
from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction

from rich.box import SIMPLE_HEAD
from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from foon_asp.asp import Status
from foon_asp.compare.comparison import MEASURED, Comparison, Judgement, Optimum
from foon_asp.compare.summary import Summary
from foon_asp.document.json_document import fraction_text
from foon_asp.escapes import escaped
from foon_asp.network import counted
from foon_asp.problem import Objective, multiplies
from foon_asp.proof.simulation import Verdict
from foon_asp.report.stackable import Stackable

_NUMBER = re.compile(r"[+-]?[0-9]+(?:[./][0-9]+)?(?:e[+-]?[0-9]+)?", re.ASCII)
_HEADINGS = ("goal", "search", "units", "inputs", "success", "executes")
_EXECUTES = {Verdict.AS_LISTED: "as listed", Verdict.REORDERED: "when reordered", Verdict.NEVER: "never"}
_STYLES = {"as listed": "green", "when reordered": "yellow", "never": "red"}

BETTER = "† better than the proved optimum, as only a tree that does not execute can be"
CYCLE = "(cycle) units of the tree wait for each other"
RATIOS = "× how many times the proved optimum of that objective"

# Widths of the columns after the goal, so that the blocks of all goals stand under one heading.
_WIDTHS = {"search": 15, "units": 12, "inputs": 12, "success": 19, "executes": 18}


def comparisons_table(comparisons: Sequence[Comparison]) -> RenderableType:
    """Lay out one block of rows for each goal, the proved optimum first."""
    parts: list[RenderableType] = [
        Text(f"Searches and the optimum ({comparisons[0].conditions})", style="bold")
    ]
    names = (judgement.search for comparison in comparisons for judgement in comparison.judgements)
    broken = _broken(comparisons)
    widths = {**_WIDTHS, "search": max((_WIDTHS["search"], *(len(name) + 1 for name in names)))}
    widths["executes"] += len(_numbers(range(len(broken)))) if broken else 0
    for place, comparison in enumerate(comparisons):
        table = Table(
            box=SIMPLE_HEAD if place == 0 else None,
            show_header=place == 0,
            pad_edge=False,
            show_edge=False,
            padding=0,
        )
        for heading, width in widths.items():
            right = heading in {"units", "inputs", "success"}
            table.add_column(heading, justify="right" if right else "left", no_wrap=True, width=width)
        goal, *rows = _rows(comparison, broken)
        for row in (goal, *rows):
            verdict = Text("  " + escaped(row[5]), style=_STYLES.get(row[5].partition(" (")[0], ""))
            table.add_row(*row[1:5], verdict, style="bold" if row is goal else "")
        parts += [Text(), Text(escaped(comparison.goal), style="bold cyan"), Stackable(table)]
    return Group(*parts, Text(), *(Text(note, style="dim") for note in _notes(comparisons)))


def comparisons_markdown(comparisons: Sequence[Comparison]) -> str:
    """Give the same table as Markdown."""
    broken = _broken(comparisons)
    rows = [row for comparison in comparisons for row in _rows(comparison, broken)]
    lines = [markdown_row(_HEADINGS), "|---|---|--:|--:|--:|---|", *map(markdown_row, rows)]
    return "\n".join([*lines, "", *(f"{note}  " for note in _notes(comparisons))]) + "\n"


def comparisons_csv(comparisons: Sequence[Comparison]) -> str:
    """Give one line for each goal and search; fractions exact, ratios as decimals too."""
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(
        ["goal", "containers", "items", "level", "search", "ending", "executes", "cycle", "missing", "breaks"]
        + [f"{objective}{what}" for objective in MEASURED for what in ("", "_optimum", "_status", "_ratio")]
    )
    for comparison in comparisons:
        for judgement in comparison.judgements:
            _, missing, cycle = judgement.obstacle or ("", "", False)
            row = [comparison.goal, comparison.containers, comparison.items, str(comparison.level)]
            row += [judgement.search, judgement.ending]
            row += [judgement.executes or "", "yes" if cycle else "no", missing or judgement.stuck_at or ""]
            row += [" ".join(judgement.breaks)]
            for objective in MEASURED:
                optimum = comparison.optima.get(objective, Optimum("", None))
                ratio = comparison.ratio(judgement, objective)
                measure = judgement.measures.get(objective)
                row += ["" if measure is None else fraction_text(measure)]
                row += ["" if optimum.value is None else fraction_text(optimum.value), optimum.status]
                row += ["" if ratio is None else f"{float(ratio):.6g}"]
            writer.writerow(map(cell_text, row))
    return file.getvalue()


def cell_text(text: str) -> str:
    """Give a cell that no spreadsheet takes for a formula: one that begins like it gets an apostrophe."""
    text = escaped(text)  # of what begins a formula, tabs and line ends
    return f"'{text}" if text[:1] in {"=", "+", "-", "@"} and not _NUMBER.fullmatch(text) else text


def summary_lines(summaries: Sequence[Summary], proved: bool) -> Iterator[str]:
    """Summarize many goals in the way a paper would."""
    goals = max((summary.goals for summary in summaries), default=0)
    yield f"{counted(goals, 'goal')}; " + (
        "every optimum is proved" if proved else "NOT every optimum is proved"
    )
    for summary in summaries:
        trees = summary.as_listed + summary.reordered + summary.never
        yield ""
        yield f"{summary.search}: {counted(trees, 'tree')}" + (
            f", {summary.without} without" if summary.without else ""
        )
        yield (
            f"  execute as listed {_share(summary.as_listed, trees)}, when reordered "
            f"{_share(summary.reordered, trees)}, never {_share(summary.never, trees)}"
            + (f" (a cycle is to blame for {summary.cycles})" if summary.cycles else "")
        )
        if summary.breaking:
            yield f"  {summary.breaking} of those that execute break a rule"
        if summary.smaller:
            these = "is smaller than the optimum; it does not execute"
            if summary.smaller > 1:
                these = "are smaller than the optimum; none of these executes"
            these += " and keeps to the rules" if summary.breaking else ""
            yield f"  {summary.smaller} {these}"
        for objective, distance in summary.distances.items():
            yield (
                f"  {objective}, times worse than the optimum where it executes: median "
                f"{_times(distance.median)}, 90th percentile {_times(distance.percentile_90)}, "
                f"worst {_times(distance.worst)}; optimal in {float(distance.share):.1%}"
            )
            if distance.worst > 1:
                yield f"    worst: {distance.worst_goal}"


def _share(number: int, total: int) -> str:
    return f"{number} ({number / total:.1%})" if total else str(number)


def _times(value: Fraction) -> str:
    return f"{float(value):.3g}" if value < 1000 else f"{float(value):.1e}"


def _rows(comparison: Comparison, broken: Sequence[str]) -> Iterator[list[str]]:
    optima = [comparison.optima.get(objective) for objective in MEASURED]
    status = " ".join(dict.fromkeys(o.status for o in optima if o))
    values = [
        "" if o is None or o.value is None else _figure(objective, o.value)
        for objective, o in zip(MEASURED, optima, strict=True)
    ]
    yield [comparison.goal, "optimum", *values, status]
    for judgement in comparison.judgements:
        cells = [_cell(comparison, judgement, objective) for objective in MEASURED]
        rules = _numbers(map(broken.index, judgement.breaks)) if judgement.breaks else ""
        yield ["", judgement.search, *cells, _executes(judgement) + rules]


def _numbers(places: Iterable[int]) -> str:
    """Give the numbers of rules that a tree breaks."""
    return " (" + ",".join(str(place + 1) for place in places) + ")"


def _broken(comparisons: Sequence[Comparison]) -> list[str]:
    """Give the rules that trees break, numbered by their places."""
    return sorted(
        {rule for each in comparisons for judgement in each.judgements for rule in judgement.breaks}
    )


def _cell(comparison: Comparison, judgement: Judgement, objective: Objective) -> str:
    measure = judgement.measures.get(objective)
    if measure is None:
        return ""
    text = _figure(objective, measure)
    if comparison.beats_the_optimum(judgement, objective):
        text = "†" + text
    ratio = comparison.ratio(judgement, objective)
    if ratio is None:
        return text
    return f"{text} {float(ratio):>5.2f}×" if ratio >= Fraction(1, 100) else f"{text} {float(ratio):.0e}×"


def _figure(objective: Objective, value: Fraction) -> str:
    if not multiplies(objective):
        return str(value)
    return f"{float(value):.4f}" if value >= Fraction(1, 1000) else f"{float(value):.2e}"


def _executes(judgement: Judgement) -> str:
    if judgement.executes is None:
        return f"no tree: {judgement.ending}" + (f" at {judgement.stuck_at}" if judgement.stuck_at else "")
    text = _EXECUTES[Verdict(judgement.executes)]
    return text + " (cycle)" if judgement.obstacle and judgement.obstacle[2] else text


def _notes(comparisons: Sequence[Comparison]) -> list[str]:
    judged = [(comparison, judgement) for comparison in comparisons for judgement in comparison.judgements]
    notes = [RATIOS]
    broken = _broken(comparisons)
    if any(c.beats_the_optimum(judgement, objective) for c, judgement in judged for objective in MEASURED):
        notes.append(BETTER + (", or one that breaks a rule" if broken else ""))
    notes += [f"({number}) breaks {rule}" for number, rule in enumerate(broken, 1)]
    if any(judgement.obstacle and judgement.obstacle[2] for _, judgement in judged):
        notes.append(CYCLE)
    if any(o.status == Status.FEASIBLE for comparison in comparisons for o in comparison.optima.values()):
        notes.append("feasible: stopped at the time limit, so that optimum is not proved and has no ratios")
    return notes


def markdown_row(cells: Sequence[str]) -> str:
    """Give a row of a table in Markdown."""
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"
