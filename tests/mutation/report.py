"""What a run found: a table by room, and every survivor with its change."""

import json
from collections import Counter
from collections.abc import Mapping, Sequence

from tests.mutation.mutant import Mutant
from tests.mutation.trials import Outcome, Reach, Tried

_NOTICED = (Outcome.KILLED, Outcome.TIMEOUT)


def share(tried: Sequence[Tried]) -> float:
    """Give which part was noticed by a test, or ran without end."""
    return sum(each.outcome in _NOTICED for each in tried) / len(tried) if tried else 0.0


def table(tried: Sequence[Tried], known: Sequence[Mutant]) -> str:
    """Give the counts by room; ``known`` are equivalents, which are not tried."""
    head = ("room", "mutants", "killed", "timeout", "survived", "equivalent", "share")
    rooms = sorted({each.mutant.room for each in tried} | {mutant.room for mutant in known})
    rows = [head, *(_row(room, tried, known) for room in rooms), _row("", tried, known)]
    widths = [max(len(row[column]) for row in rows) for column in range(len(head))]
    return "\n".join(
        row[0].ljust(widths[0])
        + "".join(f"  {cell:>{width}}" for cell, width in zip(row[1:], widths[1:], strict=True))
        for row in rows
    )


def _row(room: str, tried: Sequence[Tried], known: Sequence[Mutant]) -> tuple[str, ...]:
    here = [each for each in tried if room in {"", each.mutant.room}]
    equivalent = sum(room in {"", mutant.room} for mutant in known)
    counts = [sum(each.outcome is outcome for each in here) for outcome in _NOTICED]
    survived = len(here) - sum(counts)
    shown = f"{100 * share(here):.1f} %" if here else ""
    return (room or "all", str(len(here) + equivalent), *map(str, (*counts, survived, equivalent)), shown)


def survivors(tried: Sequence[Tried], texts: Mapping[str, str]) -> str:
    """Give every survivor: where it is, the change as the list of equivalents has it, and the lines."""
    parts = []
    for each in sorted(tried, key=lambda t: (t.mutant.file, t.mutant.first)):
        if each.outcome in _NOTICED:
            continue
        mutant = each.mutant
        note = ", which no test reaches" if each.outcome is Outcome.UNREACHED else ""
        parts.append(
            f"{mutant.file}:{mutant.first} in {mutant.function or 'the module'}{note}\n"
            f"  {mutant.operator}: {mutant.change}\n{mutant.diff(texts[mutant.file])}\n"
        )
    return "\n".join(parts)


def matrix(tried: Sequence[Tried], reach: Mapping[str, Reach]) -> str:
    """Return, as JSON, which tests notice which mutant, and how long each of these tests takes."""
    rows = [
        {
            "mutant": [*each.mutant.key],
            "line": each.mutant.first,
            "outcome": each.outcome,
            "by": each.by.splitlines(),
        }
        for each in tried
    ]
    killers = {test for each in tried for test in each.by.splitlines()}
    seconds = {test: round(reach[test].seconds, 3) for test in sorted(killers) if test in reach}
    return json.dumps({"mutants": rows, "seconds": seconds}, indent=1, ensure_ascii=False)


def only_killers(tried: Sequence[Tried]) -> str:
    """Return a line for each test function that alone notices a mutant, with how many."""
    alone: Counter[str] = Counter()
    for each in tried:
        functions = {test.partition("[")[0] for test in each.by.splitlines()}
        if len(functions) == 1:
            alone.update(functions)
    lines = [f"{count:5}  {function}" for function, count in alone.most_common()]
    return "\n".join(["mutants that one test function alone notices:", *lines])
