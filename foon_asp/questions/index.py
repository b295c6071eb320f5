"""The catalog of questions, for help, completion and names: it imports no other module of the package."""

from collections.abc import Mapping
from typing import Final, NamedTuple


class Entry(NamedTuple):
    """A verb in the help: its heading, one line of help, and the names in Python of its question and result.

    The first name is that of the question itself. Without names, the verb has no function in Python.
    """

    group: str
    line: str
    python: tuple[str, ...] = ()


INDEX: Final[Mapping[str, Entry]] = {
    "solve": Entry("Solve", "Find the best task tree for a goal, and prove it optimal.", ("solve",)),
    "compare": Entry(
        "Compare",
        "Compare the published searches with the optimum.",
        ("compare", "Compared"),
    ),
    "check": Entry(
        "Prove",
        "Simulate a task tree: does it execute, and in which order?",
        ("check", "Checked"),
    ),
    "verify": Entry(
        "Prove",
        "Check a certificate against the data it speaks about, and say what it proves.",
        ("verify", "VerifiedCertificate"),
    ),
    "why-not": Entry(
        "Explain",
        "Explain why there is no task tree, or which rules clash.",
        ("why_not", "Explanation"),
    ),
    "shopping-list": Entry(
        "Explain",
        "Find the fewest or cheapest object nodes to add to the kitchen so that a task tree exists.",
        ("shopping_list", "Shopping"),
    ),
    "alternatives": Entry(
        "Solve",
        "List other trees: all optimal, next best, or most different.",
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
        "Find the shortest schedule of a plan, and prove it.",
        ("schedule", "Schedule"),
    ),
    "view": Entry(
        "Explain",
        "Show a tree with its proof, or a network, as a page or a picture.",
        ("view", "View"),
    ),
    "trace": Entry(
        "Solve",
        "Show what is in the kitchen after each step of a plan, and plan anew where a step failed.",
        ("trace", "Traced"),
    ),
    "stats": Entry(
        "Data",
        "Count what is in a network, or list its functional units.",
        ("stats", "Stats"),
    ),
    "align": Entry(
        "Data",
        "Compare the nodes of a recipe with those of a network: known, one edit away, or new.",
        ("align", "Aligned"),
    ),
    "diff": Entry(
        "Compare",
        "Show what two task trees or two networks have in common, and in what they differ.",
        ("diff", "TreeDifference", "NetworkDifference"),
    ),
}


def module_name(verb: str) -> str:
    """Return the name of the module of a verb's question: ``why_not`` for ``why-not``."""
    return verb.replace("-", "_")


def question_name(verb: str) -> str:
    """Return the name that a verb's question has in its module; by default, the name of the module."""
    names = INDEX[verb].python
    return names[0] if names else module_name(verb)
