"""Settings and user rules that plans support, for items that are used up; all others are refused."""

from pathlib import Path

from foon_asp.asp.program import Program
from foon_asp.asp.settings import Settings
from foon_asp.errors import UserError

# Ready-made constraints about order, or that count units and not executions, and predicates about order.
_NOT_BUILT = ("before", "require_intermediate")
_NOT_READ = frozenset({"available", "executes", "taken", "makes"})


def require_built_for_plans(settings: Settings) -> None:
    """Raise :class:`UserError`, naming the feature, if settings ask for what plans do not support.

    They do not support other encodings, soft constraints, bounds by rules, and the ready-made constraints
    ``before`` and ``require_intermediate``.
    """
    for constraint in settings.constraints:
        name = Path(constraint.name.partition(":")[0]).stem
        if name in _NOT_BUILT:
            raise UserError(f"the constraint {name} is not built for items that are used up")
    for setting, feature in (
        (settings.encodings, "other encodings (--encodings)"),
        (settings.relaxed, "soft constraints"),
        (settings.bounded and settings.bounded.rules, "bounds on objectives by rules"),
    ):
        if setting:
            raise UserError(f"{feature} are not built for items that are used up")


def require_rules_of_plans(program: Program) -> None:
    """Raise :class:`UserError` if user rules read more of a plan than how often it executes each unit.

    Refused are rules over predicates about order, such as ``available``, and rules that are not local.
    """
    for name, arity in sorted(program.looked_at):
        if name.lstrip("_") in _NOT_READ:
            raise UserError(f"rules over {name}/{arity} are not built for items that are used up")
    rules = program.understood
    if rules is not None and not rules.local:
        rule = next(rule for rule in rules.rules if not rule.local)
        raise UserError(
            f"{rule.source}: this rule looks at more than the units of a plan ({rule.nonlocality}), which is "
            "not built for items that are used up"
        )
