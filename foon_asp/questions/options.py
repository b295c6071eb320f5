"""The options that questions share."""

from foon_asp.problem import DEFAULT_RULE, ContainerRule, Objective
from foon_asp.problem import ITEMS as ITEM_WORDS
from foon_asp.questions.question import Kind, Option, Role

GOALS = Option(
    "goals_named",
    "A goal, by label or in one-line notation; one tree makes all the goals given.",
    role=Role.PROBLEM,
    flags=("--goal",),
    many=True,
    metavar="NAME",
)
GOAL_OF_PLAN = GOALS._replace(
    help="A goal of the tree; without it, those of the answer, or what the last step makes."
)
EACH_GOAL = GOALS._replace(help="A goal, by label or in one-line notation; each goal is answered by itself.")
CONTAINERS = Option(
    "containers",
    "Whether a unit needs all its inputs (strict), or need not be given a container whose only ingredient is "
    "an input too (implied).",
    role=Role.PROBLEM,
    default=DEFAULT_RULE.value,
    choices=tuple(map(str, ContainerRule)),
)
ITEMS = (
    Option(
        "items",
        "Whether what is there can be used again and again (lasting), or a plan uses it up (used-up).",
        role=Role.PROBLEM,
        default="lasting",
        choices=ITEM_WORDS,
    ),
    Option(
        "stock",
        "If items are used up: how many copies the kitchen has of some object nodes; others never run out.",
        Kind.FILE,
        Role.PROBLEM,
        metavar="FILE",
    ),
    Option(
        "stays",
        "If items are used up: labels and object nodes that stay, or are used up, whatever the rule says.",
        Kind.FILE,
        Role.PROBLEM,
        metavar="FILE",
    ),
)
AMOUNT = Option(
    "amounts",
    "How many copies of the goal are wanted, one number for each --goal; items are used up then.",
    Kind.WHOLE,
    Role.PROBLEM,
    flags=("--amount",),
    many=True,
    metavar="N",
    least=1,
)
PLAN_ITEMS = (
    ITEMS[0]._replace(
        help="Whether the plan uses up what is there (used-up), or all of it can be used again and again "
        "(lasting).",
        role=Role.PROBLEM | Role.QUESTION,
        default="used-up",
        python="With ``used-up``, a problem whose items are used up says what stays and what is in stock.",
    ),
    *ITEMS[1:],
)
"""The options that say whether a given plan uses items up."""
OBJECTIVES = Option(
    "objectives",
    f"What is best, the most important first: {', '.join(Objective)}.",
    default=("units",),
    flags=("--objective",),
    many=True,
    metavar="LIST",
    python="A name, names separated by commas, or several names. The number of units decides last.",
)
CONSTRAINTS = Option(
    "constraints",
    "A file with rules of yours, or a ready-made constraint, which may have constants of its own.",
    Kind.CONSTRAINT,
    Role.COMMAND,
    flags=("--constraint",),
    many=True,
    metavar="FILE.lp|NAME[:CONSTANT=VALUE,...]",
    python="One or several of them. A text that has :- or ends in a full stop is a rule, unless it is an "
    "existing path or a name; a pathlib.Path is always a path.",
)
RULE = Option(
    "rules",
    "A rule of yours, such as ':- use(U), motion(U,\"fry\").'.",
    role=Role.EXTRA_VALUES,
    flags=("--rule",),
    many=True,
    metavar="RULE",
)
ENCODINGS = Option(
    "encodings",
    "A folder of encodings to use instead of the built-in ones.",
    Kind.FILE,
    Role.COMMAND,
    metavar="DIR",
)
CONSTANTS = Option(
    "constants",
    "The value of a #const in a constraint or an encoding.",
    role=Role.COMMAND,
    flags=("-c",),
    many=True,
    metavar="NAME=VALUE",
    python="Values by name, or texts NAME=VALUE.",
)
RULES = (CONSTRAINTS, RULE, ENCODINGS, CONSTANTS)
TREE = (GOALS, OBJECTIVES, CONTAINERS)
"""The options that say which tree is the best."""
SOFT = Option(
    "soft",
    "Constraints that may be broken, each way at this price; the lowest sum comes before all objectives.",
    Kind.WEIGHTS,
    many=True,
    metavar="FILE.lp=WEIGHT",
    python="Weights, whole numbers from 1, of constraints as above.",
)
LIMITS = (
    Option(
        "time_limit",
        "Stop after this many seconds, with what was found by then.",
        Kind.SECONDS,
        Role.COMMAND,
        metavar="SECONDS",
    ),
    Option(
        "memory_limit",
        "Stop at this much memory (500M, 2G), with what was found by then; on Linux only.",
        Kind.SIZE,
        Role.COMMAND,
        metavar="SIZE",
        python="A number counts bytes.",
    ),
)
EACH_LIMITS = tuple(limit._replace(role=Role.QUESTION) for limit in LIMITS)
"""The limits for each of many answers; the whole command has no limit."""
CHART = Option(
    "charts",
    "A file for a chart (.svg or .png).",
    Kind.WRITTEN,
    Role.CHART,
    flags=("--chart",),
    many=True,
)
JOBS = Option("jobs", "How many processes to use.", Kind.WHOLE, default=1, least=1)
