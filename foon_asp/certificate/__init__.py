"""Writing certificates: proofs about trees that ``foon_asp.proof.verify`` checks without a solver."""

from foon_asp.certificate.certificate import Certificate, NotBestError, certify, certify_infeasible
from foon_asp.certificate.coverage import Coverage, coverage
from foon_asp.certificate.outcome import certify_outcome

__all__ = [
    "Certificate",
    "Coverage",
    "NotBestError",
    "certify",
    "certify_infeasible",
    "certify_outcome",
    "coverage",
]
