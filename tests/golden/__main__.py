"""Record the transcripts anew, or compare another checkout: ``python -m tests.golden``.

Without options, every transcript is written again; read the difference before it is committed. With
``--against``, the commands are run with this checkout and with another one, and what differs is printed; with
``--data`` as well, questions about goals of a data folder are asked instead.
"""

import argparse
import difflib
import shlex
import sys
from pathlib import Path

import foon_asp
from tests.golden.transcript import KITCHEN, ROOT, commands, recorded, run_here, running_in, transcripts

_OF_A_GOAL = (
    "foon-asp solve kitchen --goal {}",
    "foon-asp solve kitchen --goal {} --objective success --format json",
    "foon-asp solve kitchen --goal {} --containers implied --format json",
    "foon-asp solve kitchen --goal {} --items used-up --format json",
    "foon-asp compare kitchen --goal {} --format json",
    "foon-asp why-not kitchen --goal {} --format json",
)


def main() -> int:
    """Record or compare; return 1 where two checkouts differ."""
    parser = argparse.ArgumentParser(prog="python -m tests.golden", description=__doc__)
    parser.add_argument("--against", type=Path, metavar="CHECKOUT", help="another checkout")
    parser.add_argument("--data", type=Path, metavar="DIR", help="a data folder with goals")
    parser.add_argument("--goals", type=int, default=20, help="how many of its goals (20)")
    options = parser.parse_args()
    if options.against is None:
        for path in transcripts():
            lines = commands(path.read_text(encoding="utf-8"))
            path.write_text("\n".join(recorded(lines, run_here, KITCHEN)), encoding="utf-8")
            print(f"recorded: {path.relative_to(ROOT)}")
        return 0
    if options.data is None:
        lines = [line for path in transcripts() for line in commands(path.read_text(encoding="utf-8"))]
        data = KITCHEN
    else:
        data = options.data.resolve()
        lines = [
            each.format(shlex.quote(goal)) for goal in _goals(data, options.goals) for each in _OF_A_GOAL
        ]
    other = options.against.resolve()
    old = list(recorded(lines, running_in(other), data, other))
    new = list(recorded(lines, running_in(ROOT), data))
    differ = [(theirs, ours) for theirs, ours in zip(old, new, strict=True) if theirs != ours]
    for theirs, ours in differ:
        sys.stdout.writelines(
            difflib.unified_diff(theirs.splitlines(True), ours.splitlines(True), str(other), str(ROOT))
        )
    print(f"{len(differ)} of {len(lines)} commands differ")
    return int(bool(differ))


def _goals(data: Path, most: int) -> list[str]:
    """Return goals of the data, spread evenly over what units make."""
    made = sorted({str(node) for unit in foon_asp.load(data).network for node in unit.outputs})
    return made[:: max(1, len(made) // most)][:most]


if __name__ == "__main__":
    sys.exit(main())
