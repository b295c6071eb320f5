"""The data of a page: an answer and its further parts."""

from fractions import Fraction

from foon_asp.pictures.whole_network import WholeNetwork
from foon_asp.questions.alternatives import Alternatives
from foon_asp.questions.answer import Answer
from foon_asp.questions.pareto import Front
from foon_asp.questions.search import Retrieved
from foon_asp.questions.shopping_list import Shopping
from foon_asp.questions.why_not import Explanation
from foon_asp.results.document import Document
from foon_asp.results.proof_cases import ProofCases
from foon_asp.results.values import Value
from foon_asp.text.json_text import schema_name


class UnitRate(Value, frozen=True):
    """The success rate of a unit, by its id."""

    unit: int
    rate: Fraction


class PageData(Document, frozen=True, kw_only=True, tag=schema_name("view")):
    """The data that a page shows.

    Attributes:
        answer: The best tree; null for a page about a whole network.
        rates: The success rate of every unit in the trees, where rates are known.
        searches: The trees of the published searches.
        lasting: Where items are used up: the answer if they lasted; else null.
        without_rules: The answer without your rules, where there are some.
        proof: The cases and cuts of a certificate.
    """

    answer: Answer | None
    rates: tuple[UnitRate, ...] | None
    searches: tuple[Retrieved, ...]
    lasting: Answer | None
    without_rules: Answer | None
    alternatives: Alternatives | None
    front: Front | None
    proof: ProofCases | None
    why_not: Explanation | None
    shopping_list: Shopping | None
    network: WholeNetwork | None
