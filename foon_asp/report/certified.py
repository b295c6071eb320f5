"""Certificates as text: what a new one proves, and what a verified one proves."""

from collections.abc import Iterable, Mapping, Sequence
from decimal import Context, Decimal
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from foon_asp.document.json_document import document, figures_json, goals_json, head_json, nodes_json
from foon_asp.escapes import escaped
from foon_asp.network import Network, counted
from foon_asp.problem import ContainerRule, conditions, parse_objectives
from foon_asp.proof.constraint import OWN, Rule
from foon_asp.proof.verify import UsedUp, Verified, trusted
from foon_asp.text.json_value import Json

if TYPE_CHECKING:  # the rest of these rooms takes clingo along, which `verify` has to do without
    from foon_asp.asp import Outcome
    from foon_asp.certificate import Certificate

_NAMED = 20  # units of a limit that are listed in text; JSON has all


def certificate_lines(outcome: "Outcome", certificate: "Certificate | None", file: str) -> list[str]:
    """Say what proves an answer after the search for a certificate; ``file`` is where that was written."""
    if certificate is None and outcome.proof is None:
        return ["proof: none, so there is nothing to certify"]
    by = outcome.proof or "none"
    if certificate is None:
        return [f"proof: {by} (no certificate was found, and nothing is written)"]
    own = trusted(certificate.content)
    if own is not None and certificate.claim != "bound":
        proved = "that there is no tree" if certificate.claim == "infeasible" else "the tree best"
        given = f"the certificate {file} proves {proved}, but takes on trust what rules say,"
        return [f"proof: {by}; {given}", *(f"  {line}" for line in _on_trust(own, None))]
    if certificate.claim == "bound":
        return [
            f"proof: {by}; the certificate {file} proves a bound on {_all(outcome)}"
            + bound_text(certificate.content)
        ]
    if certificate.claim == "optimal" and by != "certificate":
        sure = ", ".join(certificate.certified)
        what = "tree" if outcome.problem.items is None else "plan"
        return [f"proof: {by}; the certificate {file} proves the {what} best by {sure} alone"]
    lines = [f"proof: certificate ({file}, {_looked_at(certificate.content)})"]
    if certificate.content["not_covered"] and certificate.claim == "optimal":
        every = "trees" if outcome.problem.items is None else "plans"
        lines.append(f"  it is best among all {every}; only the solver says that it obeys the constraints")
    return lines


def _looked_at(content: dict[str, Any]) -> str:
    """Say how many cuts a proof has, and of plans the balance of how many nodes it looks at."""
    cuts = counted(len(content["cuts"]), "cut")
    if "items" not in content:
        return cuts
    nodes: set[int] = set()
    waiting = list(content["proof"])
    for part in waiting:  # grows while it is walked through
        nodes.update(o for o, _ in part.get("balance", ()))
        waiting += (part[side] for side in ("up_to", "above") if side in part)
    return f"{cuts}, the balance of {counted(len(nodes), 'node')}"


def _all(outcome: "Outcome") -> str:
    """Say what a bound is about that is less than the answer costs."""
    if outcome.problem.items is None:
        return "all trees, without the constraints that it does not cover: "
    return "all plans: "


def bound_text(content: dict[str, Any]) -> str:
    """Say what the bound of a certificate is by its first objective, and how far the tree is from it."""
    objective, bound = content["objective"][0], content["bound"][0]
    text = f"success at most {_success(bound)}" if objective == "success" else f"{objective} at least {bound}"
    if content["costs"] is not None:
        cost = content["costs"][0]
        text += f"; the {'plan' if 'items' in content else 'tree'} has {cost}"
        if objective != "success":
            text += f" (gap {Fraction(cost) - Fraction(bound)})"
    return text


def _success(exponents: Mapping[str, str]) -> str:
    """Give a product of powers of rates in a few digits; a bound above 1 says no more than 1."""
    precise = Context(prec=50, traps=[])
    logarithm = Decimal(0)
    for name, e in exponents.items():
        rate, exponent = Fraction(name), Fraction(e)
        log = precise.ln(Decimal(rate.numerator)) - precise.ln(Decimal(rate.denominator))
        power = precise.divide(Decimal(exponent.numerator), Decimal(exponent.denominator))
        logarithm = precise.add(logarithm, precise.multiply(power, log))
    return f"{float(precise.exp(min(logarithm, Decimal(0)))):.4g}"


def verified_text(
    verified: Verified,
    network: Network,
    content: dict[str, Any],
    with_clingo: bool = False,
    starting: bool = False,
) -> str:
    """Say what a verified certificate proves; ``with_clingo`` says that clingo checked what is on trust.

    ``starting`` says that no kitchen was given, so that it holds for the starting one.
    """
    lines = [f"goal: {network.objects[goal]}" for goal in verified.goals]
    rule = conditions(ContainerRule(verified.containers), verified.level, starting)
    tree, trees = "task tree", "trees"
    if verified.used_up is not None:
        tree, trees, rule = "plan", "plans", f"{rule}, items used up"
        lines += _items(verified.used_up, network)
    if verified.claim == "infeasible":
        lines.append(f"verified: there is no {tree} ({rule})")
    elif verified.claim == "bound":
        lines.append(f"verified: a bound on all {tree}s ({rule}): {bound_text(content)}")
    else:
        costs = zip(verified.costs or (), verified.objectives, strict=True)
        figures = ", ".join(_figure(objective, cost) for cost, objective in costs)
        lines.append(
            f"verified: no {tree} is better by {', then '.join(verified.objectives)} ({rule}): {figures}"
        )
    lines += [
        f"among the {trees} that keep to {_rule(rule)}" for rule in verified.rules if rule["rule"] != OWN
    ]
    own = trusted(content)
    if own is not None:
        how = "checked with clingo" if with_clingo else "taken on trust (--with-clingo checks it)"
        lines += _on_trust(own, verified.tree, how)
    lines += [f"not covered, so among all {trees}: {name}" for name in verified.not_covered]
    for measure in verified.trusted:
        what = (
            f"the costs of {counted(len(measure.costs), 'unit')} by {measure.name}, and that none is below 0"
        )
        how = "checked with clingo" if with_clingo else "taken on trust (--with-clingo checks them)"
        lines.append(f"{how}: {what}; rules with SHA-256 {measure.sha256}")
    lines.append(f"proof: {_looked_at(content)}, checked without a solver")
    return "\n".join(lines) + "\n"


def _items(used_up: UsedUp, network: Network) -> list[str]:
    """Say what a claim about plans says of items, where that is not the rule alone."""
    objects = network.objects
    stock = [f"{count} x {objects[o]}" for o, count in used_up.stock.items()]
    told: dict[bool, list[str]] = {True: [], False: []}
    for name, stays in used_up.stays.items():
        told[stays].append(name if isinstance(name, str) else str(objects[name]))
    said = [f"in stock: {', '.join(stock)}"] if stock else []
    said += [f"said to stay: {', '.join(told[True])}"] if told[True] else []
    return said + ([f"said to be used up: {', '.join(told[False])}"] if told[False] else [])


def _items_json(used_up: UsedUp | None, network: Network) -> Json | None:
    """Give the same for programs."""
    if used_up is None:
        return None
    stays = [
        {"label": name, "node": None, "stays": stays}
        if isinstance(name, str)
        else {"label": None, "node": str(network.objects[name]), "stays": stays}
        for name, stays in used_up.stays.items()
    ]
    stock = [{"node": str(network.objects[o]), "copies": count} for o, count in used_up.stock.items()]
    return {"stock": stock, "stays": stays}


def stated_text(stated: Sequence[str]) -> str:
    """Say which digests were not computed, because a store states them; empty where all were."""
    if not stated:
        return ""
    names = f"{', '.join(stated[:-1])} and {stated[-1]}" if len(stated) > 1 else stated[0]
    return f"taken on trust: the digests of {names} that the store states (--full computes them)\n"


def verified_json(
    verified: Verified,
    network: Network,
    with_clingo: bool = False,
    starting_kitchen: Iterable[int] | None = None,
) -> Json:
    """Give what a verified certificate proves for programs."""
    goals = goals_json(network, verified.goals)
    objectives = parse_objectives(verified.objectives, [measure.name for measure in verified.trusted])
    costs = None if verified.costs is None else dict(zip(objectives, verified.costs, strict=True))
    own = [rule for rule in verified.rules if rule["rule"] == OWN]
    return document(
        "verify",
        **head_json(
            goals,
            verified.containers,
            verified.level,
            objectives,
            "lasting" if verified.used_up is None else "used-up",
            starting_kitchen=None if starting_kitchen is None else nodes_json(network, starting_kitchen),
        ),
        verified=True,
        claim=verified.claim,
        costs=None if costs is None else figures_json(costs),
        rules=[dict(rule) for rule in verified.rules if rule["rule"] != OWN],
        trusted=next((_trusted_json(rule, with_clingo) for rule in own), None),
        measures=[
            {
                "name": measure.name,
                "sha256": measure.sha256,
                "units": len(measure.costs),
                "checked": "clingo" if with_clingo else None,
            }
            for measure in verified.trusted
        ],
        not_covered=list(verified.not_covered),
        tree=None if verified.tree is None else list(verified.tree),
        cuts=verified.cuts,
        used_up=_items_json(verified.used_up, network),
    )


def _on_trust(own: Rule, tree: tuple[int, ...] | None, how: str = "taken on trust") -> list[str]:
    """Say what is taken on trust of rules of the user's own, by what they are called, or was checked."""
    names = [f"{file['name']} (SHA-256 {file['sha256']})" for file in own["files"]]
    names += [*own["library"], *own["constants"]]
    removed = [used[0] for used, without in own["claims"] if len(used) == 1 and not without]
    none = [[], []] in own["claims"]
    wanted = sum(not used for used, _ in own["claims"]) - none
    others = len(own["claims"]) - len(removed) - wanted - none
    limits = []
    for amounts, most in own["limits"]:
        units = [unit for each in amounts.values() for unit in each]
        if most == 0:
            removed += units
        else:
            limits.append(_limited(sorted(units), most, [*amounts] == ["1"]))
    said = ["no tree keeps to them"] if none else []
    said += [f"no tree has one of the units {', '.join(map(str, removed))}"] if removed else []
    said += [f"every tree has a unit of {wanted} {'set' if wanted == 1 else 'sets'}"] if wanted else []
    said += [f"{others} {'set breaks' if others == 1 else 'sets break'} a rule"] if others else []
    said += limits
    said += ["the tree keeps to them"] if tree is not None or not said else []
    return [escaped(f"among the trees that keep to {', '.join(names)}; {how}: {'; '.join(said)}")]


def _limited(units: list[int], most: int, each: bool) -> str:
    """Say what a tree has at most of some units; without ``each``, they count differently."""
    listed = ", ".join(map(str, units))
    named = f"the units {listed}" if len(units) <= _NAMED else f"{len(units)} units"
    if not each:
        return f"what {named} count comes to {most} at most"
    return f"no tree has {'all' if most == len(units) - 1 else f'more than {most}'} of {named}"


def _trusted_json(own: Rule, checked: bool) -> Json:
    claims = [{"used": used, "without": without} for used, without in own["claims"]]
    files = [{"name": file["name"], "sha256": file["sha256"]} for file in own["files"]]
    limits = [
        {
            "counted": [{"unit": u, "amount": int(n)} for n, units in amounts.items() for u in units],
            "at_most": most,
        }
        for amounts, most in own["limits"]
    ]
    given = {"files": files, "library": own["library"], "constants": own["constants"]}
    return {**given, "claims": claims, "limits": limits, "checked": checked}


def _rule(rule: Rule) -> str:
    """Name a rule with its values; a line end in one could say what was verified."""
    values = {name: value if isinstance(value, list) else [value] for name, value in rule.items()}
    given = (f"{name}: {', '.join(map(str, value))}" for name, value in values.items() if name != "rule")
    return escaped(f"{rule['rule']} ({'; '.join(given)})")


def _figure(objective: str, cost: int | Fraction) -> str:
    return f"success {cost} ≈ {float(cost):.4g}" if objective == "success" else f"{cost} {objective}"
