"""Verification of certificates without any solver."""

from codecs import BOM_UTF8
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from fractions import Fraction
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Self, Unpack

from foon_asp.dataset import Dataset
from foon_asp.deadline import Deadline, LimitError
from foon_asp.errors import UserError
from foon_asp.escapes import escaped
from foon_asp.foon import Foon
from foon_asp.json_layout import schema_name
from foon_asp.network import Network, StandInTable, counted
from foon_asp.problem import DEFAULT_RULE, ContainerRule, Problem, kitchen_needed, parse_objectives
from foon_asp.proof import proved_checker, refusal
from foon_asp.proof.certificate_header import seal
from foon_asp.proof.certificate_json import load_certificate, read_certificate
from foon_asp.proof.certificate_rules import trusted_claims
from foon_asp.proof.certificate_subject import Subject
from foon_asp.proof.refusal import RefusedError
from foon_asp.proof.rule_meaning import ALL_STEPS, OWN, Rule
from foon_asp.proof.verified_claim import ItemClaims, Verified
from foon_asp.proof.verify_plan import is_of_plan, verify_any
from foon_asp.questions.certificate_text import bound_text, proof_size, trusted_text
from foon_asp.questions.ending import Ending
from foon_asp.questions.posing import DATA, Command, pose_data
from foon_asp.questions.python_options import Limits, start_deadline
from foon_asp.questions.question import Kind, Option, Role, question
from foon_asp.questions.result import Result
from foon_asp.results.document import AboutGoals
from foon_asp.results.table import Block
from foon_asp.results.values import Measures
from foon_asp.results.values_of import goals_of, nodes_of
from foon_asp.text.plain_file import read_beginning

if TYPE_CHECKING:  # takes the solver and linear programs along, which `verify` must not load
    from foon_asp.certificate import Certificate

CLINGO_SECONDS = 60.0
"""Time limit of each check of user rules by clingo: they are untrusted input."""
_NAMED_BY = {
    "stand-ins": "--stand-ins, and the files of stand-ins",
    "network": "--network FILE",
    "kitchen": "--kitchen FILE",
    "rates": "--rates FILE",
    "utensils": "--utensils FILE",
    "prices": "--unit-prices FILE",
    "level": "--level N",
    "task": "DOMAIN.pddl PROBLEM.pddl",
}


class OtherDataError(RefusedError):
    """The certificate is about other data than those named.

    ``differing`` is the name of the part that differs, for example ``kitchen``.
    """

    def __init__(self, differing: str, message: str) -> None:
        super().__init__(message)
        self.differing = differing


class VerifiedCertificate(Result, AboutGoals, frozen=True, kw_only=True, tag=schema_name("verify")):
    """What a certificate proves about the data that it was checked with.

    Attributes:
        verified: True; a certificate that is refused has no claim.
        claim: optimal: no tree is better than this one; bound: no tree costs less than the bound;
            infeasible: there is no tree.
        bound: The bound in words; null for another claim.
        costs: What the tree costs by the objectives of the claim; null without a tree.
        rules: The ready-made constraints that the claim is about, with their values.
        trusted: In words, what is assumed of user-defined measures and rules, and of digests that a store
            states.
        checked: In words, what clingo checked of user-defined measures and rules.
        not_covered: The constraints that the claim is not about.
        tree: The units of the tree, by id; null without a tree.
        proved_by: In words, how many cuts the proof has; for plans, also how many nodes it has a balance of.
        used_up: In words, the stock, the copies wanted, and the items that stay, as the claim states them;
            null where items last.
        proved_checker: The answer of the checker proved in Coq: accepted, or why it did not check the
            certificate; null where it was not asked.

    Example:
        >>> import pathlib, tempfile
        >>> foon = foon_asp.load()
        >>> file = pathlib.Path(tempfile.mkdtemp()) / "proof.json"
        >>> _ = foon_asp.solve(foon.problem("ice"), certificate=file)
        >>> found = foon_asp.verify(foon, file)
        >>> found.claim, found.tree, found.proved_by
        ('optimal', (26, 27), '2 cuts')
    """

    verified: bool
    claim: str
    bound: str | None
    costs: Measures | None
    rules: tuple[str, ...]
    trusted: tuple[str, ...]
    checked: tuple[str, ...]
    not_covered: tuple[str, ...]
    tree: tuple[int, ...] | None
    proved_by: str
    used_up: tuple[str, ...] | None
    proved_checker: str | None

    @classmethod
    def of(
        cls,
        verified: Verified,
        network: Network,
        content: Mapping[str, Any],
        with_clingo: bool = False,
        starting: Sequence[int] | None = None,
        stated: Sequence[str] = (),
        by_proved_checker: str | None = None,
    ) -> Self:
        """Return the verified claim of a certificate about a network.

        Parameters:
            verified: The verified claim.
            network: The network of the claim.
            content: The certificate as plain values.
            with_clingo: Whether clingo checked the costs by measures and the user rules.
            starting: The object nodes that can be needed, by id, where no kitchen was given.
            stated: The digests that were not computed, because a store states them.
            by_proved_checker: The answer of the proved checker, if it was asked.
        """
        user_rules, items = trusted_claims(content), verified.used_up
        claims = [] if user_rules is None else [trusted_text(user_rules, verified.tree is not None)]
        for measure in verified.trusted:
            units = counted(len(measure.costs), "unit")
            costs = f"the costs of {units} by {measure.name}, and that none is below 0"
            claims.append(f"{costs}; rules with SHA-256 {measure.sha256}")
        trusted = () if with_clingo else [f"{claim} (--with-clingo checks it)" for claim in claims]
        names = f"{', '.join(stated[:-1])} and {stated[-1]}" if len(stated) > 1 else "".join(stated)
        digests = [f"the digests of {names} that the store states (--full computes them)"] if stated else []
        objectives = parse_objectives(verified.objectives, [measure.name for measure in verified.trusted])
        return cls(
            goals=goals_of(network, verified.goals),
            containers=ContainerRule(verified.containers),
            items="lasting" if items is None else "used-up",
            level=verified.level,
            objectives=objectives,
            starting_kitchen=None if starting is None else nodes_of(network, starting),
            verified=True,
            claim=verified.claim,
            bound=bound_text(content) if verified.claim == "bound" else None,
            costs=None if verified.costs is None else dict(zip(objectives, verified.costs, strict=True)),
            rules=tuple(_rule_text(rule) for rule in verified.rules if rule["rule"] != OWN),
            trusted=(*trusted, *digests),
            checked=tuple(claims) if with_clingo else (),
            not_covered=verified.not_covered,
            tree=verified.tree,
            proved_by=proof_size(content),
            used_up=None if items is None else tuple(_items_lines(items, network)),
            proved_checker=by_proved_checker,
        )

    @property
    def ending(self) -> Ending:
        """``DONE``; ``LIMIT`` if the proved checker was asked and does not accept the certificate."""
        return Ending.DONE if self.proved_checker in (None, proved_checker.ACCEPTED) else Ending.LIMIT

    def show(self) -> Iterator[Block]:
        """Return the goals, the claim, its assumptions, and the size of the proof."""
        yield from (f"goal: {goal}" for goal in self.goals)
        tree, trees = ("task tree", "trees") if self.items == "lasting" else ("plan", "plans")
        under = self.conditions
        if _are_facts(map(str, self.goals)):
            tree, under = "plan", "nothing is deleted"
        yield from self.used_up or ()
        if self.claim == "infeasible":
            yield f"verified: there is no {tree} ({under})"
        elif self.bound is not None:
            yield f"verified: a bound on all {tree}s ({under}): {self.bound}"
        else:
            figures = ", ".join(_cost_text(objective, cost) for objective, cost in (self.costs or {}).items())
            yield f"verified: no {tree} is better by {', then '.join(self.objectives)} ({under}): {figures}"
        yield from (f"among the {trees} that keep to {rule}" for rule in self.rules)
        yield from (f"not covered, so among all {trees}: {name}" for name in self.not_covered)
        yield from (f"taken on trust: {claim}" for claim in self.trusted)
        yield from (f"checked with clingo: {claim}" for claim in self.checked)
        yield f"proof: {self.proved_by}, checked without a solver"
        if self.proved_checker is not None:
            yield f"proved checker: {self.proved_checker}"


class Refused(Result, frozen=True, kw_only=True, tag=schema_name("refused")):
    """A certificate that is wrong, with the first fault found, as ``foon-asp verify`` shows it.

    Attributes:
        verified: False.
        reason: The fault.
    """

    verified: bool
    reason: str

    @property
    def ending(self) -> Ending:
        """``NEGATIVE``: the check failed."""
        return Ending.NEGATIVE

    def show(self) -> Iterator[Block]:
        """Return one line with the reason."""
        yield f"refused: {self.reason}"


def _items_lines(used_up: ItemClaims, network: Network) -> Iterator[str]:
    """Yield lines on the stock, the copies wanted, and the items that stay, as a certificate states them."""
    nodes = network.objects
    if used_up.stock:
        yield "in stock: " + ", ".join(f"{copies} x {nodes[o]}" for o, copies in used_up.stock.items())
    if used_up.wanted:
        yield "wanted: " + ", ".join(f"{copies} x {nodes[o]}" for o, copies in used_up.wanted.items())
    for stays, verb in ((True, "stay"), (False, "be used up")):
        named = [name for name, name_stays in used_up.stays.items() if name_stays is stays]
        if named:
            names = (name if isinstance(name, str) else str(nodes[name]) for name in named)
            yield f"said to {verb}: {', '.join(names)}"


def _rule_text(rule: Rule) -> str:
    """Return a rule with its values as one line; line ends are escaped, since they could forge a claim."""
    values = {name: value if isinstance(value, list) else [value] for name, value in rule.items()}
    parameters = (f"{name}: {', '.join(map(str, value))}" for name, value in values.items() if name != "rule")
    return escaped(f"{rule['rule']} ({'; '.join(parameters)})")


def _cost_text(objective: str, cost: int | Fraction | None) -> str:
    """Return a cost with its objective, as ``3 units``; success has its exact and its rounded value."""
    return f"success {cost} ≈ {float(cost or 0):.4g}" if objective == "success" else f"{cost} {objective}"


def _pose_data_or_task(command: Command, data_paths: Sequence[Path]) -> tuple[Foon | Problem]:
    """Return the data of the command with the files at the paths, or a planning task in these files.

    The result is a tuple of one. A planning task is returned as the problem of its delete relaxation. Raises
    :class:`UserError` for options for data beside a task.
    """
    if not any(map(_is_task, data_paths)):
        command.add_sources(data_paths)
        return pose_data(command)
    if any(map(command.given, DATA)):
        raise UserError("found options for data beside a planning task: a certificate is about one of them")
    from foon_asp.planning.task_files import read_task  # noqa: PLC0415 (it loads clingo)

    with command.reading():
        return (read_task(data_paths, start_deadline({})).problem(),)


def _is_task(file: Path) -> bool:
    """Return whether a file is of a planning task (PDDL or SAS), by its first bytes."""
    from foon_asp.planning.sas_reader import BEGINNING  # noqa: PLC0415 (for few certificates)

    begins = read_beginning(file, 100).removeprefix(BOM_UTF8).lstrip()
    return begins.startswith((b"(", b";", BEGINNING.encode()))


def _are_facts(names: Iterable[str]) -> bool:
    """Return whether all goals are facts of a planning task, whose names are in parentheses."""
    return all(name.startswith("(") and name.endswith(")") for name in names)


def verify_or_refuse(
    data: Foon | Problem,
    certificate: Path,
    *,
    with_clingo: bool = False,
    full: bool = False,
    proved: bool = False,
    **limits: Unpack[Limits],
) -> VerifiedCertificate | Refused:
    """Check a certificate, and return the claim or, for a wrong certificate, the fault.

    Raises:
        UserError: for a certificate about other data, with advice on which data to name.
    """
    try:
        return verify(data, certificate, with_clingo=with_clingo, full=full, proved=proved, **limits)
    except OtherDataError as other:
        raise UserError(
            f"{certificate} is about other data ({other}): add {_NAMED_BY[other.differing]}"
        ) from None
    except RefusedError as refused:
        return Refused(verified=False, reason=str(refused))


@question(
    Option(
        "certificate", "The file with the certificate.", Kind.FILE, metavar="CERTIFICATE", positional=True
    ),
    Option(
        "data_paths",
        "The data: recipes, a folder or a store; or the planning task that `foon-asp relax` was asked about, "
        "DOMAIN.pddl PROBLEM.pddl or TASK.sas.",
        Kind.FILE,
        Role.PROBLEM,
        default=(),
        many=True,
        metavar="[RECIPE|DIR|STORE|TASK]...",
        positional=True,
    ),
    pose=_pose_data_or_task,
    command=verify_or_refuse,
    help_="""
    \b
    foon-asp solve --goal 'greek salad' --certificate proof.json
    foon-asp verify proof.json
    foon-asp verify proof.json recipe.txt
    foon-asp verify proof.json domain.pddl problem.pddl

    The data has to be the same: --data and the other options name it as they do for solve. What units cost by
    a measure of your own, and what rules of your own say, is taken on trust, unless --with-clingo checks it;
    with --measure, the rules have to be those of the certificate. Of a store, what the certificate speaks of
    is read, and the digests are those that the store states, unless --full computes them. With --proved, the
    checker that is proved in Coq has to accept the certificate as well. Exits with 0 when the certificate is
    right, with 1 when it is refused, with 2 when it is about other data, and with 3 when --proved cannot
    check it or is not built.
    """,
)
def verify(
    data: Foon | Problem,
    certificate: "Certificate | str | PathLike[str]",
    *,
    with_clingo: Annotated[bool, Option()] = False,
    full: Annotated[bool, Option()] = False,
    proved: Annotated[bool, Option()] = False,
    **limits: Unpack[Limits],
) -> VerifiedCertificate:
    """Check a certificate against the data it is about, without any solver.

    The costs of units by user-defined measures, and the meaning of user rules, are taken on trust:
    ``trusted`` names these assumptions.

    Parameters:
        data: The data, as loaded, or a problem made from them.
        certificate: The path of a certificate, or the ``certificate`` of an answer.
        with_clingo: Check with clingo what is otherwise taken on trust: costs by measures, and rules of your
            own.
        full: Read all of a store, and compute the digests that are otherwise taken as the store states them.
        proved: Also ask the checker that is proved in Coq, which `make verified` builds. All of a store is
            then read, and digests are computed, as with ``full``.

    Returns:
        What the certificate proves.

    Raises:
        RefusedError: for a certificate that is wrong, with the first fault found; for one that is about other
            data, it is an :class:`OtherDataError`.
        UserError: for a file that cannot be read.

    Example:
        >>> import pathlib, tempfile
        >>> foon = foon_asp.load()
        >>> file = pathlib.Path(tempfile.mkdtemp()) / "proof.json"
        >>> _ = foon_asp.solve(foon.problem("ice"), certificate=file)
        >>> foon_asp.verify(foon, file).proved_by
        '2 cuts'
    """
    if isinstance(certificate, str | PathLike):
        try:
            content = load_certificate(Path(certificate))
        except (OSError, UnicodeDecodeError) as error:
            reason = error.strerror if isinstance(error, OSError) else None
            raise UserError(f"{certificate}: cannot be read: {reason or error}") from None
    elif isinstance(getattr(certificate, "content", None), Mapping):
        content = read_certificate(certificate.text())
    else:
        raise UserError(
            f"found a certificate of type {type(certificate).__name__}, expected a path or that of an answer"
        )
    with start_deadline(limits).watched("checking the certificate"):
        foon = data if isinstance(data, Foon) else Foon.of(data)
        return _verify_content(foon, content, with_clingo, full or proved, proved)


def _verify_content(
    foon: Foon, content: Any, with_clingo: bool, full: bool, proved: bool
) -> VerifiedCertificate:
    """Return the claim that a certificate, as plain values, proves about data.

    ``full`` reads all of a store. ``with_clingo`` checks measures and rules with clingo, and ``proved`` also
    asks the checker proved in Coq. Raises :class:`OtherDataError` if the certificate is about other data.
    Raises :class:`RefusedError` if it is wrong, or states other rules for a measure than the data.
    """
    dataset = foon.dataset
    subject = _subject_of(dataset, content, full)
    try:
        verified = verify_any(content, subject)
    except RefusedError as refused:
        differing = _differing_part(content, subject)
        if differing is None:
            raise
        raise OtherDataError(differing, str(refused)) from None
    for measure in verified.trusted:
        known_measure = dataset.measures.get(measure.name)
        if known_measure is not None and known_measure.text != measure.rules:
            raise RefusedError(f"the rules of {measure.name} are not those that are given")
    user_rules = trusted_claims(content)
    if with_clingo and (verified.trusted or user_rules is not None):
        problem = dataset.problem(verified.goals, verified.containers, everything=True)
        _check_measures_with_clingo(problem, verified)
        if user_rules is not None:
            from foon_asp.certificate.own_rules import check_with_clingo  # noqa: PLC0415 (the solver)

            check_with_clingo(content, user_rules, problem, Deadline(CLINGO_SECONDS))
    by_proved_checker = proved_checker.check_certificate(content, subject) if proved else None
    starting = None
    if not subject.trusted and dataset.data.starting:
        starting = kitchen_needed(dataset.problem(verified.goals, verified.containers, everything=True))
    return VerifiedCertificate.of(
        verified, subject.network, content, with_clingo, starting, subject.trusted, by_proved_checker
    )


def _subject_of(dataset: Dataset, content: Any, full: bool) -> Subject:
    """Return the data that a certificate can be about; unless ``full``, only the part of a store it needs.

    If the data have stand-ins, or if the certificate is about a repair, stand-ins for the goals of the
    certificate are included. Raises :class:`RefusedError` if there are stand-ins and no goals.
    """
    goals, steps = _goal_ids(content), _step_ids(content)
    if steps and dataset.stand_ins is None:  # a repair has them without being asked for
        dataset = dataset.with_stand_in_table(StandInTable.usual())
    if dataset.stand_ins is None:
        return dataset.subject(full or _needs_whole_network(content), goals)
    goals = [goal for goal in goals if 0 <= goal < len(dataset.data.network.objects)]
    objectives, containers = content.get("objective"), content.get("containers")
    everything = bool(content.get("rules")) or (objectives or ["dissimilarity"])[:1] != ["dissimilarity"]
    rule = containers if containers in [*ContainerRule] else DEFAULT_RULE
    if not goals:
        raise RefusedError("expected goals of the network")
    steps = [unit for unit in steps if 0 <= unit < len(dataset.data.network)]
    return dataset.subject_with_stand_ins(goals, rule, everything, steps)


def _differing_part(content: Any, subject: Subject) -> str | None:
    """Return the name of the first part of the data whose digest differs from that in the certificate.

    The name is ``task`` for a certificate about a planning task. It is ``None`` if no part differs, or if the
    certificate itself is damaged. The places that units come from are not compared.
    """
    with suppress(RecursionError, KeyError, TypeError, AttributeError):  # the content is no certificate
        if content["seal"] == seal(content):
            actual = {"level": subject.network.level, **subject.digests()}
            stated = {**content["digests"], "level": content["level"]}
            if "stand-ins" in {*stated} ^ {*actual}:
                return "stand-ins"
            del actual["sources"]  # only some rules depend on them
            differing = next(
                (name for name, digest in actual.items() if stated.get(name, digest) != digest), None
            )
            return differing and (
                "task" if _are_facts(goal["node"] for goal in content["goals"]) else differing
            )
    return None


def _goal_ids(content: Any) -> list[int]:
    """Return the goal ids in a certificate that is not checked yet; values of other types are left out."""
    goals = content.get("goals") if isinstance(content, dict) else None
    ids = [goal.get("id") for goal in goals if isinstance(goal, dict)] if isinstance(goals, list) else []
    return [o for o in ids if type(o) is int]


def _step_ids(content: Any) -> list[int]:
    """Return the unit ids of the tree whose repair a certificate is about; empty for other certificates."""
    rules = content.get("rules") if isinstance(content, dict) else None
    if not isinstance(rules, list) or len(rules) != 1 or not isinstance(rules[0], dict):
        return []
    units = rules[0].get("units") if rules[0].get("rule") == ALL_STEPS else None
    return [unit for unit in units if type(unit) is int] if isinstance(units, list) else []


def _needs_whole_network(content: Any) -> bool:
    """Return whether the check of a certificate looks at every unit.

    It is true for a certificate that is about a plan, or that has rules or prices. It is also true for a
    value that is no certificate.
    """
    if not isinstance(content, dict) or is_of_plan(content):
        return True
    objectives = content.get("objective")
    priced = isinstance(objectives, list) and "price" in objectives
    return bool(content.get("rules") or content.get("forbidden")) or priced


def _check_measures_with_clingo(problem: Problem, verified: Verified) -> None:
    """Check the costs of units by measures that a certificate states.

    Raises :class:`RefusedError` for a wrong cost or wrong rules, and :class:`CheckLimitError` if clingo
    takes longer than a minute for a measure.
    """
    from foon_asp.rules.measure import Measure, wrong_cost  # noqa: PLC0415 (the solver)

    for measure in verified.trusted:
        rules = Measure(measure.name, measure.rules, f"the rules of {measure.name}")
        deadline = Deadline(CLINGO_SECONDS)
        try:
            wrong = wrong_cost(rules, problem, measure.costs, deadline)
        except UserError as error:
            raise RefusedError(str(error)) from None
        except LimitError as limit:
            if deadline.interrupted:
                raise
            raise refusal.CheckLimitError(f"the rules of {measure.name}: {limit.stopped}") from None
        if wrong is not None:
            raise RefusedError(wrong)
