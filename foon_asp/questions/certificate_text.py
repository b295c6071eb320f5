"""Certificates in words: the claim, its bound, the size of the proof, and what is assumed of user rules."""

from collections.abc import Mapping, Sequence
from decimal import Context, Decimal
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from foon_asp.escapes import escaped
from foon_asp.network import counted
from foon_asp.proof.certificate_rules import trusted_claims
from foon_asp.proof.rule_meaning import Rule

if TYPE_CHECKING:  # takes clingo along, which `verify` must not load
    from foon_asp.asp import Outcome
    from foon_asp.certificate import Certificate


def trusted_text(user_rules: Rule, of_tree: bool) -> str:
    """Return in words what a certificate assumes of user rules without proof.

    The text names the files with their digests, the ready-made constraints and the constants. Then it says
    which units or sets the rules exclude, require or limit, or that no tree keeps to them. ``of_tree`` adds
    that the tree of the certificate keeps to the rules. Control characters in names are escaped.
    """
    names = [f"{file['name']} (SHA-256 {file['sha256']})" for file in user_rules["files"]]
    names += [*user_rules["library"], *user_rules["constants"]]
    has_empty_claim = [[], []] in user_rules["claims"]
    excluded_units = [used[0] for used, without in user_rules["claims"] if len(used) == 1 and not without]
    required_count = sum(not used for used, _ in user_rules["claims"]) - has_empty_claim
    breaking_count = len(user_rules["claims"]) - len(excluded_units) - required_count - has_empty_claim
    limits = []
    for amounts, bound in user_rules["limits"]:
        units = [unit for ids in amounts.values() for unit in ids]
        if bound == 0:
            excluded_units += units
        elif bound > 0:
            limits.append(_limit_text(sorted(units), bound, [*amounts] == ["1"]))
    is_unsatisfiable = has_empty_claim or any(bound < 0 for _, bound in user_rules["limits"])
    claims = ["no tree keeps to them"] if is_unsatisfiable else []
    if excluded_units:
        claims.append(f"no tree has one of the units {', '.join(map(str, excluded_units))}")
    if required_count:
        claims.append(f"every tree has a unit of {counted(required_count, 'set')}")
    if breaking_count:
        claims.append(f"{breaking_count} {'set breaks' if breaking_count == 1 else 'sets break'} a rule")
    claims += limits
    claims += ["the tree keeps to them"] if of_tree or not claims else []
    return escaped(f"among the trees that keep to {', '.join(names)}: {'; '.join(claims)}")


def _limit_text(units: list[int], bound: int, alike: bool) -> str:
    """Return in words a limit on trees: their units in ``units`` have a total weight of at most ``bound``.

    ``alike`` says that all weights are 1. More than 20 units are only counted.
    """
    units_text = f"the units {', '.join(map(str, units))}" if len(units) <= 20 else f"{len(units)} units"
    if not alike:
        return f"what {units_text} count comes to {bound} at most"
    return f"no tree has {'all' if bound == len(units) - 1 else f'more than {bound}'} of {units_text}"


def certificate_lines(outcome: "Outcome", certificate: "Certificate | None", file: str) -> Sequence[str]:
    """Return lines on the proof of an answer, and on what a certificate in ``file`` proves.

    ``certificate``: ``None`` if none was found; the lines then say so.
    """
    by = outcome.proof or "none"
    if certificate is None and outcome.proof is None:
        return ["proof: none, so there is nothing to certify"]
    if certificate is None:
        return [f"proof: {by} (no certificate was found, and nothing is written)"]
    content, claim = certificate.content, certificate.claim
    tree = "tree" if outcome.problem.items is None else "plan"
    user_rules = trusted_claims(content)
    if claim == "bound":
        trees = "all trees, without the constraints that it does not cover" if tree == "tree" else "all plans"
        return [f"proof: {by}; the certificate {file} proves a bound on {trees}: {bound_text(content)}"]
    if user_rules is not None:
        proved = "that there is no tree" if claim == "infeasible" else "the tree best"
        claim_text = f"the certificate {file} proves {proved}, but takes on trust what rules say,"
        return [f"proof: {by}; {claim_text}", f"  {trusted_text(user_rules, of_tree=False)}"]
    if claim == "optimal" and by != "certificate":
        proved = ", ".join(certificate.certified)
        return [f"proof: {by}; the certificate {file} proves the {tree} best by {proved} alone"]
    lines = [f"proof: certificate ({file}, {proof_size(content)})"]
    if content["not_covered"] and claim == "optimal":
        lines.append(f"  it is best among all {tree}s; only the solver says that it obeys the constraints")
    return lines


def proof_size(content: Mapping[str, Any]) -> str:
    """Return the size of a proof in words: ``7 cuts``, or for a plan ``7 cuts, the balance of 2 nodes``.

    ``content`` is the JSON object of a certificate.
    """
    cuts = counted(len(content["cuts"]), "cut")
    if "items" not in content:
        return cuts
    nodes: set[int] = set()
    cases = list(content["proof"])
    for case in cases:  # grows during the loop
        nodes.update(o for o, _ in case.get("balance", ()))
        cases += (case[branch] for branch in ("up_to", "above") if branch in case)
    return f"{cuts}, the balance of {counted(len(nodes), 'node')}"


def bound_text(content: Mapping[str, Any]) -> str:
    """Return in words the bound of a certificate on its first objective, and the cost of its tree, if any.

    ``content`` is the JSON object of the certificate. The gap between bound and cost follows, except for
    success.
    """
    objective, bound = content["objective"][0], content["bound"][0]
    text = (
        f"success at most {_success_text(bound)}"
        if objective == "success"
        else f"{objective} at least {bound}"
    )
    if content["costs"] is not None:
        cost = content["costs"][0]
        text += f"; the {'plan' if 'items' in content else 'tree'} has {cost}"
        if objective != "success":
            text += f" (gap {Fraction(cost) - Fraction(bound)})"
    return text


def _success_text(exponents: Mapping[str, str]) -> str:
    """Return a product of powers of rates in four digits; a product above 1 is shown as 1.

    ``exponents`` maps rates to exponents, such as ``{"9/10": "2"}``.
    """
    context = Context(prec=50, traps=[])
    product_log = Decimal(0)
    for rate_text, exponent_text in exponents.items():
        rate, exponent = Fraction(rate_text), Fraction(exponent_text)
        rate_log = context.ln(Decimal(rate.numerator)) - context.ln(Decimal(rate.denominator))
        decimal_exponent = context.divide(Decimal(exponent.numerator), Decimal(exponent.denominator))
        product_log = context.add(product_log, context.multiply(decimal_exponent, rate_log))
    return f"{float(context.exp(min(product_log, Decimal(0)))):.4g}"
