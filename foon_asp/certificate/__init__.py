"""Writing certificates: proofs about trees that ``foon_asp.proof.verifier`` checks without a solver."""

from foon_asp.certificate.certificate import Certificate as Certificate
from foon_asp.certificate.certificate import NotBestError as NotBestError
from foon_asp.certificate.certificate import certify as certify
from foon_asp.certificate.certificate import certify_infeasible as certify_infeasible
from foon_asp.certificate.certified_outcome import certify_outcome as certify_outcome
from foon_asp.certificate.coverage import Coverage as Coverage
from foon_asp.certificate.coverage import coverage as coverage
from foon_asp.certificate.plan import certify_no_plan as certify_no_plan
from foon_asp.certificate.plan import certify_plan as certify_plan
from foon_asp.certificate.plan import covered_for_plans as covered_for_plans
