"""Is a certificate right? Without any solver."""

from collections.abc import Mapping
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from foon_asp.document.json_document import document
from foon_asp.errors import UserError
from foon_asp.foon import Foon
from foon_asp.network import Network
from foon_asp.problem import Problem
from foon_asp.proof import verify as proof
from foon_asp.questions.contract import Kind, Option, question
from foon_asp.questions.posing import the_data
from foon_asp.questions.result import Ending, Result
from foon_asp.report.certified import verified_json, verified_text

if TYPE_CHECKING:  # the solver and the linear programs, which this has to do without
    from foon_asp.certificate import Certificate


@dataclass(frozen=True, repr=False)
class VerifiedCertificate(Result):
    """What a certificate proves: ``verified`` has its ``claim``, ``goals``, ``tree`` and ``costs``.

    ``network`` is the network that it is about, ``content`` the certificate as plain values.

    Example:
        >>> foon = foon_asp.load()
        >>> certificate = foon_asp.certify(foon.problem("ice")).certificate
        >>> foon_asp.verify(foon, certificate).verified.claim
        'optimal'
    """

    verified: proof.Verified
    network: Network
    content: Mapping[str, Any]

    def text(self) -> str:
        """Say what is proved, as ``foon-asp verify`` does."""
        return verified_text(self.verified, self.network, dict(self.content))

    def json_dict(self) -> object:
        """Say what is proved, as ``foon-asp verify --format json`` does."""
        return verified_json(self.verified, self.network)


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


def verify_or_refuse(data: Foon, certificate: Path) -> VerifiedCertificate | Refused:
    """Check a certificate as ``foon-asp verify`` does."""
    try:
        return verify(data, certificate)
    except proof.RefusedError as refused:
        return Refused(str(refused))


@question(
    Option(
        "certificate", "The file with the certificate.", Kind.FILE, metavar="CERTIFICATE", positional=True
    ),
    pose=the_data,
    command=verify_or_refuse,
    help_="""
    \b
    foon-asp solve --goal 'greek salad' --certificate proof.json
    foon-asp verify proof.json

    The data has to be the same: --data and the other options name it as they do for solve. Exits with 0 when
    the certificate is right and with 1 when it is refused.
    """,
)
def verify(data: Foon | Problem, certificate: "Certificate | str | PathLike[str]") -> VerifiedCertificate:
    """Check a certificate against the data it is about, without any solver.

    Parameters:
        data: The data, as loaded, or a problem made from them.
        certificate: The path of a certificate, or one that :func:`foon_asp.certify` found.

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
            raise UserError(f"{certificate}: cannot be read: {error}") from None
    else:
        content = proof.read_certificate(certificate.text())
    read = (data if isinstance(data, Foon) else Foon.of(data)).dataset.data
    verified = proof.verify(content, read.network, read.kitchen, read.rates, read.utensils, read.unit_prices)
    return VerifiedCertificate(verified, read.network, content)
