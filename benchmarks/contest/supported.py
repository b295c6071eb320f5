"""The question for clingo as supported models, without its own test of what founds what.

After Rankooh and Janhunen: Capturing (optimal) relaxed plans with stable and supported models of logic
programs, TPLP 2023. What is made is derived by what makes it, round in circles if need be, since supported
models allow that; circles are excluded by vertex elimination instead. Core-guided, ``--opt-strategy=usc``.
"""

import time
from collections.abc import Callable

from contest.elimination import ordered
from contest.instance import Instance, cuts

_GREATEST = 2**31 - 1


def solve_supported(instance: Instance, seconds: float) -> list[int] | None:
    """Give the actions of a best tree, or ``None`` where there is none.

    Raises :class:`MemoryError` for costs beyond clingo's numbers.
    """
    from clingo import Control, SolveResult  # noqa: PLC0415

    began = time.monotonic()
    if sum(instance.costs) > _GREATEST:
        raise MemoryError("costs beyond 32 bits")
    control = Control(["--supp-models", "--opt-strategy=usc", "--opt-mode=opt", "-n0"], message_limit=0)
    control.add("base", [], "\n".join(_program(instance)))
    control.ground()
    while True:
        best: list[int] | None = None
        with control.solve(yield_=True, async_=True) as handle:
            while True:
                handle.resume()
                if not handle.wait(max(0.0, began + seconds - time.monotonic())):
                    handle.cancel()
                    raise TimeoutError
                model = handle.model()
                if model is None:
                    break
                best = [s.arguments[0].number for s in model.symbols(atoms=True) if s.name == "use"]
            result: SolveResult = handle.get()
        if not result.exhausted:
            raise TimeoutError
        if best is None:
            return None
        found = cuts(instance, best)
        if not found:
            return best
        # only where elimination took too many clauses
        control.add("cuts", [], "\n".join(_constraint(*cut) for cut in found))
        control.ground([("cuts", [])])


def _program(instance: Instance) -> list[str]:
    lines = []
    for action, (needs, gives) in enumerate(zip(instance.needs, instance.gives, strict=True)):
        body = ",".join(f"made({node})" for node in needs)
        lines.append(f"{{use({action})}}" + f":-{body}." * bool(body) + "." * (not body))
        lines += [f"made({node}):-use({action})." for node in gives]
        if instance.costs[action]:
            lines.append(f":~use({action}).[{instance.costs[action]},{action}]")
    lines += [f":-not made({goal})." for goal in instance.goals]
    actions = len(instance.units)
    clauses = ordered(instance) or []
    others = {abs(literal) for clause in clauses for literal in clause if abs(literal) > actions}
    lines += [f"{{other({literal})}}." for literal in others]
    return lines + [":-" + ",".join(map(_false(actions), clause)) + "." for clause in clauses]


def _false(actions: int) -> Callable[[int], str]:
    def written(literal: int) -> str:
        number = abs(literal)
        atom = f"use({number - 1})" if number <= actions else f"other({number})"
        return f"not {atom}" if literal > 0 else atom

    return written


def _constraint(supports: list[int], user: int | None) -> str:
    wanted = [f"not use({support})" for support in supports]
    return ":-" + ",".join([*wanted, *([] if user is None else [f"use({user})"])]) + "."
