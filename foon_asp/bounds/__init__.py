"""Landmarks and lower bounds for min-cost derivations, on plain arrays.

Everything here speaks of actions and objects by number: an action needs objects and gives objects, some
objects are there from the start, some are targets. What the numbers stand for is the caller's.
"""

from foon_asp.bounds.cut import Cut, Cutter
from foon_asp.bounds.hypergraph import Hypergraph
from foon_asp.bounds.landmark_cuts import Cuts, WeightedCut, landmark_cuts
from foon_asp.bounds.lexicographic import Lexicographic, Vector
from foon_asp.bounds.lower_bound import Branch, CheaperError, Hopeless, Packing, Proof, Prover

__all__ = [
    "Branch",
    "CheaperError",
    "Cut",
    "Cuts",
    "Cutter",
    "Hopeless",
    "Hypergraph",
    "Lexicographic",
    "Packing",
    "Proof",
    "Prover",
    "Vector",
    "WeightedCut",
    "landmark_cuts",
]
