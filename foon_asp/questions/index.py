"""The catalog of questions, for help, completion and names: it imports nothing of ours."""

from collections.abc import Mapping
from typing import Final, NamedTuple


class Entry(NamedTuple):
    """A question: the heading it stands under, one line of help, and its names in Python, if it has any.

    The module of a question is called like its verb. The first name is that of the question itself.
    """

    group: str
    line: str
    python: tuple[str, ...] = ()


INDEX: Final[Mapping[str, Entry]] = {
    "solve": Entry("Solve", "Find the best task tree for a goal, and prove that none is better.", ("solve",)),
    "optima": Entry(
        "Solve",
        "Solve every goal of the goals file under several objectives and compare the optimal trees.",
        ("optima", "Optima"),
    ),
    "search": Entry(
        "Compare",
        "Retrieve a task tree with a search of the literature, and say whether it executes.",
        ("retrieve", "Retrieved"),
    ),
    "compare": Entry(
        "Compare",
        "Compare the searches of the literature with the optimum.",
        ("compare_searches", "Compared"),
    ),
    "check": Entry(
        "Prove",
        "Simulate a task tree: does it execute, and in which order?",
        ("check", "Checked"),
    ),
    "certify": Entry(
        "Prove",
        "Write a certificate: a proof that `foon-asp verify` checks without a solver.",
        ("certify", "Certified"),
    ),
    "verify": Entry(
        "Prove",
        "Check a certificate against the data it speaks about, and say what it proves.",
        ("verify", "VerifiedCertificate"),
    ),
    "why-not": Entry(
        "Explain",
        "Explain why there is no task tree.",
        ("why_not", "Explanation"),
    ),
    "shopping-list": Entry(
        "Explain",
        "Find the fewest or cheapest object nodes to add to the kitchen so that a task tree exists.",
        ("shopping_list", "Shopping"),
    ),
    "clash": Entry(
        "Explain",
        "Find a smallest set of constraints that cannot hold together, and the cheapest ones to drop.",
        ("clash", "Clash"),
    ),
    "alternatives": Entry(
        "Explain",
        "List other trees: all that are optimal, the next best, or those that differ most.",
        ("alternatives", "Alternatives"),
    ),
    "pareto": Entry(
        "Explain",
        "Find the whole Pareto front of two or three objectives, with a tree for every point.",
        ("pareto", "Front"),
    ),
    "regret": Entry(
        "Explain",
        "Find the optimum without each unit of the best tree, and without each kitchen item it takes.",
        ("regret", "Regrets"),
    ),
    "sensitivity": Entry(
        "Explain",
        "Find how wrong each success rate may be before another tree is the best.",
        ("sensitivity", "Sensitivity"),
    ),
    "menu": Entry(
        "Solve",
        "Solve several goals by one tree, and goal by goal, and say what is shared.",
        ("menu", "Menu"),
    ),
    "assist": Entry(
        "Explain",
        "Find the best success if a person does at most 0, 1, 2, ... units, and which units.",
        ("assist", "Assistance"),
    ),
    "export": Entry(
        "Tools",
        "Write goals as a planning task in PDDL.",
        ("export", "Exported"),
    ),
    "read-plan": Entry(
        "Tools",
        "Read the plan of another planner back into a task tree, and execute it.",
        ("read_plan", "PlanRead"),
    ),
    "relax": Entry(
        "Tools",
        "Find the cheapest plan of a planning task without its deletes (h+), and prove it.",
        ("relax", "Relaxed"),
    ),
    "schedule": Entry(
        "Solve",
        "Find the shortest schedule of a plan for one or more agents, and prove it.",
        ("schedule", "Schedule"),
    ),
    "draw": Entry(
        "Tools",
        "Draw an optimal task tree, a given one, some functional units, or a whole network.",
        ("draw", "Drawn"),
    ),
    "view": Entry(
        "Explain",
        "Show a tree, other trees and the proof on a page for any browser, in one file.",
        ("view", "View"),
    ),
    "trace": Entry(
        "Solve",
        "Show what is in the kitchen after each step of a plan, and plan anew where a step failed.",
        ("trace", "Traced"),
    ),
    "units": Entry(
        "Data",
        "List the functional units of a network, and say which of their inputs are used up.",
        ("units", "Units"),
    ),
    "diff": Entry(
        "Compare",
        "Show what two task trees have in common, what only one has, what each costs, and where they part.",
        ("diff", "Difference"),
    ),
    "diff-network": Entry(
        "Compare",
        "Show what two networks have in common, and which units nearly agree and in what.",
        ("diff_networks", "NetworkDifference", "Agreement"),
    ),
}


def module_name(verb: str) -> str:
    """Give the name of a question's module."""
    return verb.replace("-", "_")


def question_name(verb: str) -> str:
    """Give the name that a question has in its module."""
    names = INDEX[verb].python
    return names[0] if names else module_name(verb)
