"""One screen for `make demo`: the five published goals, each search beside the proved optimum."""

from foon_asp import compare_searches, load
from foon_asp.compare.comparison import Comparison, Judgement
from foon_asp.problem import Objective
from foon_asp.proof.simulation import Verdict

GOALS = ("greek salad", "macaroni", "whipped cream", "sweet potato", "ice")
LEFT = """In demo/: compare.txt (every goal and measure), optima.txt (the best trees),
searches.svg and .png (a chart), macaroni.svg (a tree), and macaroni.html (the
same tree, to walk through in a browser). Next: foon-asp init my-kitchen"""
_MARKS = {Verdict.AS_LISTED: " ", Verdict.REORDERED: "~", Verdict.NEVER: "!"}


def cell(judgement: Judgement) -> str:
    """Give the number of units of a tree, with a mark if it does not execute as listed."""
    if judgement.units is None or judgement.executes is None:
        return "-  "
    return f"{len(judgement.units)} {_MARKS[Verdict(judgement.executes)]}"


def surprise(found: list[Comparison]) -> str:
    """Say in one sentence what is surprising about the trees of the searches."""
    trees = [judgement for each in found for judgement in each.judgements if judgement.units is not None]
    listed = sum(judgement.executes == Verdict.AS_LISTED for judgement in trees)
    ratio, goal, name = max(
        (ratio, each.goal.partition(";")[0], judgement.search)
        for each in found
        for judgement in each.judgements
        if judgement.search != "greedy-success"  # which looks for something else
        and judgement.executes != Verdict.NEVER
        and (ratio := each.ratio(judgement, Objective.UNITS)) is not None
    )
    return (
        f"Only {listed} of the {len(trees)} trees execute in the order in which their search lists them,\n"
        f"and {name} takes {float(ratio):.3g} times the units that {goal} needs."
    )


def main() -> None:
    """Print the screen."""
    foon = load()
    found = [compare_searches(foon.problem(goal, containers="implied")).comparisons[0] for goal in GOALS]
    names = [judgement.search for judgement in found[0].judgements]
    print("Units of the task trees that five searches of the literature find")
    print("(bundled kitchen, implied containers; ~ executes only reordered, ! in no order)\n")
    print(f"{'goal':<14}{'optimum':>9}" + "".join(f"{name:>{len(name) + 4}}" for name in names))
    for goal, each in zip(GOALS, found, strict=True):
        cells = "".join(f"{cell(tree):>{len(tree.search) + 4}}" for tree in each.judgements)
        print(f"{goal:<14}{each.optima[Objective.UNITS].value!s:>9}{cells}")
    print(f"\n{surprise(found)}\n\n{LEFT}")


if __name__ == "__main__":
    main()
