"""The data of a page: an answer and its further parts."""

from fractions import Fraction

from foon_asp.json_layout import schema_name
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


class UnitRate(Value, frozen=True):
    """The id of a unit in the whole network, and its success rate."""

    unit: int
    rate: Fraction


class PageData(Document, frozen=True, kw_only=True, tag=schema_name("view")):
    """The data that a page shows.

    Attributes:
        answer: The best tree; null for a page about a whole network.
        rates: The success rate of every unit in the trees; null where no rates are known.
        searches: The results of the searches; empty unless they were asked for.
        lasting: The best tree if items lasted; null unless items are used up.
        without_rules: The best tree without user rules; null where there are none.
        alternatives: The best trees; null unless they were asked for.
        front: The Pareto front; null unless it was asked for.
        proof: The cases and cuts of a certificate; null without a certificate.
        why_not: Why there is no tree; null if there is one.
        shopping_list: What to add to the kitchen so that there is a tree; null if there is one.
        network: The whole network; null unless it was asked for.
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
