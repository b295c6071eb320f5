"""One screen for `make demo`: the five published goals, each search beside the proved optimum."""

from foon_asp import compare, load
from foon_asp.comparison.comparison import Comparison, SearchResult
from foon_asp.problem import Objective
from foon_asp.proof.simulation import Verdict

GOALS = ("greek salad", "macaroni", "whipped cream", "sweet potato", "ice")
LEFT = """In demo/: compare.txt (every goal and measure), optima.txt (the best trees),
searches.svg and .png (a chart), macaroni.svg (a tree), and macaroni.html (the
same tree, to walk through in a browser). Next: foon-asp init my-kitchen"""
_MARKS = {Verdict.AS_LISTED: " ", Verdict.REORDERED: "~", Verdict.NEVER: "!"}


def cell(result: SearchResult) -> str:
    """Give the number of units of a tree, with a mark if it does not execute as listed."""
    if result.units is None or result.verdict is None:
        return "-  "
    return f"{len(result.units)} {_MARKS[result.verdict]}"


def surprise(found: list[Comparison]) -> str:
    """Say in one sentence what is surprising about the trees of the searches."""
    trees = [result for each in found for result in each.searches if result.units is not None]
    listed = sum(result.verdict is Verdict.AS_LISTED for result in trees)
    ratio, goal, name = max(
        (ratio, each.goal.label, result.search)
        for each in found
        for result in each.searches
        if result.search != "greedy-success"  # which looks for something else
        and result.verdict is not Verdict.NEVER
        and (ratio := result.ratios.get(Objective.UNITS)) is not None
    )
    return (
        f"Only {listed} of the {len(trees)} trees execute in the order in which their search lists them,\n"
        f"and {name} takes {float(ratio):.3g} times the units that {goal} needs."
    )


def main() -> None:
    """Print the screen."""
    foon = load()
    found = [compare(foon.problem(goal, containers="implied")).comparisons[0] for goal in GOALS]
    names = [result.search for result in found[0].searches]
    print("Units of the task trees that five searches of the literature find")
    print("(bundled kitchen, implied containers; ~ executes only reordered, ! in no order)\n")
    print(f"{'goal':<14}{'optimum':>9}" + "".join(f"{name:>{len(name) + 4}}" for name in names))
    for goal, each in zip(GOALS, found, strict=True):
        cells = "".join(f"{cell(tree):>{len(tree.search) + 4}}" for tree in each.searches)
        print(f"{goal:<14}{each.optimum[Objective.UNITS].value!s:>9}{cells}")
    print(f"\n{surprise(found)}\n\n{LEFT}")


if __name__ == "__main__":
    main()
