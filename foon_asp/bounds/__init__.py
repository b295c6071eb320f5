"""Landmarks and lower bounds for min-cost derivations, on plain arrays.

Everything here speaks of actions and objects by number: an action needs objects and gives objects, some
objects are there from the start, some are targets. What the numbers stand for is the caller's.
"""

from foon_asp.bounds.cut import Cut as Cut
from foon_asp.bounds.cut import Cutter as Cutter
from foon_asp.bounds.hypergraph import Hypergraph as Hypergraph
from foon_asp.bounds.landmark_cuts import Cuts as Cuts
from foon_asp.bounds.landmark_cuts import WeightedCut as WeightedCut
from foon_asp.bounds.landmark_cuts import landmark_cuts as landmark_cuts
from foon_asp.bounds.lexicographic import Lexicographic as Lexicographic
from foon_asp.bounds.lexicographic import Vector as Vector
from foon_asp.bounds.lower_bound import Branch as Branch
from foon_asp.bounds.lower_bound import CheaperError as CheaperError
from foon_asp.bounds.lower_bound import Hopeless as Hopeless
from foon_asp.bounds.lower_bound import Packing as Packing
from foon_asp.bounds.lower_bound import Proof as Proof
from foon_asp.bounds.lower_bound import Prover as Prover
