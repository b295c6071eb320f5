"""Is a certificate right? Without any solver."""

from codecs import BOM_UTF8
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from foon_asp.deadline import Cancel, Deadline, LimitError
from foon_asp.document.json_document import document
from foon_asp.errors import UserError
from foon_asp.foon import Foon
from foon_asp.network import Network
from foon_asp.problem import Problem, kitchen_needed
from foon_asp.problem.progress import OnProgress
from foon_asp.proof import verify as proof
from foon_asp.proof.verify_plan import is_of_plan, verify_any
from foon_asp.questions.arguments import begin
from foon_asp.questions.contract import Kind, Option, Part, question
from foon_asp.questions.posing import DATA, Command, the_data
from foon_asp.questions.result import Ending, Result
from foon_asp.report.certified import stated_text, verified_json, verified_text
from foon_asp.text.plain_file import read_beginning

if TYPE_CHECKING:  # the solver and the linear programs, which this has to do without
    from foon_asp.certificate import Certificate

_SECONDS = 60.0  # for what clingo checks


@dataclass(frozen=True, repr=False)
class VerifiedCertificate(Result):
    """What a certificate proves: ``verified`` has its ``claim``, ``goals``, ``tree`` and ``costs``.

    ``network`` is the network that it is about, ``content`` the certificate as plain values. ``with_clingo``
    says that clingo checked what is otherwise taken on trust, as ``verified.trusted`` lists it.
    ``starting_kitchen`` are the ids of the object nodes that can be needed, where no kitchen was given.
    ``stated`` names the digests that were not computed, because a store states them: they are trusted.

    Example:
        >>> foon = foon_asp.load()
        >>> certificate = foon_asp.certify(foon.problem("ice")).certificate
        >>> foon_asp.verify(foon, certificate).verified.claim
        'optimal'
    """

    verified: proof.Verified
    network: Network = field(compare=False)  # the content has its digest
    content: Mapping[str, Any]
    with_clingo: bool = False
    starting_kitchen: tuple[int, ...] | None = None
    stated: tuple[str, ...] = ()

    def text(self) -> str:
        """Say what is proved, as ``foon-asp verify`` does."""
        starting, content = self.starting_kitchen is not None, dict(self.content)
        said = verified_text(self.verified, self.network, content, self.with_clingo, starting)
        return said + stated_text(self.stated)

    def json_dict(self) -> object:
        """Say what is proved, as ``foon-asp verify --format json`` does."""
        found = verified_json(self.verified, self.network, self.with_clingo, self.starting_kitchen)
        return {**found, "stated_digests": list(self.stated)}


@dataclass(frozen=True, repr=False)
class Refused(Result):
    """What ``foon-asp verify`` gives for a certificate that is wrong: the first fault that is found."""

    reason: str

    @property
    def ending(self) -> Ending:
        """The check failed."""
        return Ending.NEGATIVE

    def text(self) -> str:
        """Say why."""
        return f"refused: {self.reason}\n"

    def json_dict(self) -> object:
        """Say why."""
        return document("verify", verified=False, reason=self.reason)


def _posed(command: Command, more: Sequence[Path]) -> tuple[Foon | Problem]:
    """Pose the data that are named, or the relaxation of a planning task."""
    if not any(map(_is_task, more)):
        command.add_sources(more)
        return the_data(command)
    if any(map(command.given, DATA)):
        raise UserError("found options for data beside a planning task: a certificate is about one of them")
    from foon_asp.planning.task_files import read_task  # noqa: PLC0415 (it loads clingo)

    with command.reading():
        return (read_task(more, begin(None, None)).problem(),)


def _is_task(file: Path) -> bool:
    """Whether a file is of a planning task; FOON and JSON begin otherwise."""
    from foon_asp.planning.sas_reader import BEGINNING  # noqa: PLC0415 (for few certificates)

    begins = read_beginning(file, 100).removeprefix(BOM_UTF8).lstrip()
    return begins.startswith((b"(", b";", BEGINNING.encode()))


def verify_or_refuse(
    data: Foon | Problem, certificate: Path, *, with_clingo: bool = False, full: bool = False
) -> VerifiedCertificate | Refused:
    """Check a certificate as ``foon-asp verify`` does."""
    try:
        return verify(data, certificate, with_clingo=with_clingo, full=full)
    except proof.RefusedError as refused:
        return Refused(str(refused))


@question(
    Option(
        "certificate", "The file with the certificate.", Kind.FILE, metavar="CERTIFICATE", positional=True
    ),
    Option(
        "with_clingo",
        "Check with clingo what is otherwise taken on trust: costs by measures, and rules of your own.",
        Kind.FLAG,
    ),
    Option(
        "full",
        "Read all of a store, and compute the digests that are otherwise taken as the store states them.",
        Kind.FLAG,
    ),
    Option(
        "more",
        "The data: recipes, a folder or a store; or the planning task that `foon-asp relax` was asked about, "
        "DOMAIN.pddl PROBLEM.pddl or TASK.sas.",
        Kind.FILE,
        Part.PROBLEM,
        default=(),
        many=True,
        metavar="[RECIPE|DIR|STORE|TASK]...",
        positional=True,
    ),
    pose=_posed,
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
    is read, and the digests are those that the store states, unless --full computes them. Exits with 0 when
    the certificate is right and with 1 when it is refused.
    """,
)
def verify(
    data: Foon | Problem,
    certificate: "Certificate | str | PathLike[str]",
    *,
    with_clingo: bool = False,
    full: bool = False,
    time_limit: float | None = None,
    on_progress: OnProgress | None = None,
    cancel: Cancel | None = None,
) -> VerifiedCertificate:
    """Check a certificate against the data it is about, without any solver.

    What units cost by a measure of the user's own is taken on trust, and ``verified.trusted`` lists it. So is
    what rules of the user's own say.

    Parameters:
        data: The data, as loaded, or a problem made from them.
        certificate: The path of a certificate, or one that :func:`foon_asp.certify` found.
        with_clingo: Whether clingo checks what is otherwise taken on trust.
        full: Whether all of a store is read, and its digests computed, in place of trusting those it states.

    Returns:
        What the certificate proves, as ``verified``.

    Raises:
        RefusedError: for a certificate that is wrong or is about other data, with the first fault found.
        UserError: for a file that cannot be read.

    Example:
        >>> foon = foon_asp.load()
        >>> certificate = foon_asp.certify(foon.problem("ice")).certificate
        >>> foon_asp.verify(foon, certificate).verified.cuts
        2
    """
    if isinstance(certificate, str | PathLike):
        try:
            content = proof.load_certificate(Path(certificate))
        except (OSError, UnicodeDecodeError) as error:
            reason = error.strerror if isinstance(error, OSError) else None
            raise UserError(f"{certificate}: cannot be read: {reason or error}") from None
    elif isinstance(getattr(certificate, "content", None), Mapping):
        content = proof.read_certificate(certificate.text())
    else:
        raise UserError(f"found certificate={certificate!r}, expected a path or what certify found")
    dataset = (data if isinstance(data, Foon) else Foon.of(data)).dataset
    subject = dataset.subject(everything=full or _looks_at_all(content))
    verified = verify_any(content, subject)
    for measure in verified.trusted:
        ours = dataset.measures.get(measure.name)
        if ours is not None and ours.text != measure.rules:
            raise proof.RefusedError(f"the rules of {measure.name} are not those that are given")
    own = proof.trusted(content)
    if with_clingo and (verified.trusted or own is not None):
        problem = dataset.problem(verified.goals, verified.containers, everything=True)
        _check_with_clingo(problem, verified)
        if own is not None:
            from foon_asp.certificate.own_rules import check_with_clingo  # noqa: PLC0415 (the solver)

            check_with_clingo(content, own, problem, Deadline(_SECONDS))
    starting = None
    if not subject.trusted and dataset.data.starting:
        starting = tuple(
            kitchen_needed(dataset.problem(verified.goals, verified.containers, everything=True))
        )
    return VerifiedCertificate(verified, subject.network, content, with_clingo, starting, subject.trusted)


def _looks_at_all(content: Any) -> bool:
    """Whether a certificate speaks of a plan, of rules, or of prices, which are looked at unit by unit."""
    if not isinstance(content, dict) or is_of_plan(content):
        return True
    objectives = content.get("objective")
    priced = isinstance(objectives, list) and "price" in objectives
    return bool(content.get("rules") or content.get("forbidden")) or priced


def _check_with_clingo(problem: Problem, verified: proof.Verified) -> None:
    """Check what units are said to cost; raises :class:`RefusedError` where the rules say otherwise."""
    from foon_asp.rules.measure import Measure, wrong_cost  # noqa: PLC0415 (the solver)

    for measure in verified.trusted:
        rules = Measure(measure.name, measure.rules, f"the rules of {measure.name}")
        deadline = Deadline(_SECONDS)  # rules may come from a stranger
        try:
            wrong = wrong_cost(rules, problem, measure.costs, deadline)
        except UserError as error:
            raise proof.RefusedError(str(error)) from None
        except LimitError as limit:
            if deadline.interrupted:
                raise
            raise proof.LimitError(f"the rules of {measure.name}: {limit.stopped}") from None
        if wrong is not None:
            raise proof.RefusedError(wrong)
