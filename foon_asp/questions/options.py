"""The options that questions share."""

from foon_asp.problem import ContainerRule, Objective
from foon_asp.questions.contract import Kind, Option, Part

GOALS = Option(
    "goals_named",
    "Label or one-line notation of a goal; repeat for one tree that makes all.",
    part=Part.PROBLEM,
    flags=("--goal",),
    many=True,
    metavar="NAME",
)
EACH_GOAL = GOALS._replace(help="A goal by label or notation, a question of its own; repeatable.")
CONTAINERS = Option(
    "containers",
    "Whether a unit needs every input, or takes utensils that hold one of them as given.",
    part=Part.PROBLEM,
    default="strict",
    choices=tuple(map(str, ContainerRule)),
)
OBJECTIVES = Option(
    "objectives",
    f"What is best, most important first: {', '.join(Objective)}.",
    default=("units",),
    flags=("--objective",),
    many=True,
    metavar="LIST",
)
CONSTRAINTS = Option(
    "constraints",
    "Add an encoding of yours, or one of ours by name; repeatable.",
    Kind.FILE,
    Part.COMMAND,
    flags=("--constraint",),
    many=True,
    metavar="FILE.lp",
)
ENCODINGS = Option(
    "encodings",
    "Use the encodings of a folder instead of ours.",
    Kind.FILE,
    Part.COMMAND,
    metavar="DIR",
)
CONSTANTS = Option(
    "constants",
    "Set a #const of an encoding; repeatable.",
    part=Part.COMMAND,
    flags=("-c",),
    many=True,
    metavar="NAME=VALUE",
)
RULES = (CONSTRAINTS, ENCODINGS, CONSTANTS)
SOFT = Option(
    "soft",
    "Constraints that may be broken, each way at that price; the least sum comes first.",
    Kind.WEIGHTS,
    many=True,
    metavar="FILE.lp=WEIGHT",
)
LIMITS = (
    Option(
        "time_limit",
        "Stop after this time, with the best known and its bound.",
        Kind.SECONDS,
        Part.COMMAND,
        metavar="SECONDS",
    ),
    Option(
        "memory_limit",
        "Stop likewise at this much memory: 500M, 2G. On Linux only.",
        Kind.SIZE,
        Part.COMMAND,
        metavar="SIZE",
    ),
)
EACH_LIMITS = tuple(limit._replace(part=Part.QUESTION) for limit in LIMITS)
"""The limits of each of many answers, none of which holds for the whole command."""
