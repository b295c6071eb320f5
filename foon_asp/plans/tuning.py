"""Numbers that steer the search for plans: they change its time, and never make it prove a wrong result.

Functions read :data:`PLANS` when they are called.
"""

from typing import NamedTuple


class PlanTuning(NamedTuple):
    """When the searches for counts, orders and proofs end, and where they begin.

    ``rounded_rows``: at most this many rounded rows are added for a solution of the state equation.
    ``stalled_rounds``: rounds of rounded rows in succession that may leave the bound as it is.
    ``role_depth``: rounds of refinement by which the roles of objects are told apart.
    ``rounding_denominator``: greatest denominator of the weights that rounded rows are made of.
    ``equation_nodes``: nodes of branch and bound over the state equation, before actions get indicators.
    ``probes``: actions for which it is tried, at the root, whether they can be executed twice.
    ``nodes``: nodes of branch and bound over counts, after which a proof is given up.
    ``uncapped_nodes``: nodes after which it is given up if nothing bounds the number of executions.
    ``landmark_orders``: orders in which landmarks are grown before a search for violated ones ends.
    ``first_executions``: cap on the count of an action, for each copy wanted, when counts are looked for.
    ``last_executions``: cap in the second attempt, if a count reaches the first cap.
    ``leaves``: leaves of a proof by branching, in a certificate.
    ``depth``: depth of a proof by branching; its check is a recursion of the same depth.
    ``order_steps``: runs that a search for an order tries; most orders need one run for each action.
    ``single_executions``: executions up to which every order is tried, one execution at a time.
    ``stocks``: choices of initial copies for which an order is looked for.
    ``unordered_counts``: counts without an order, after which clingo searches all counts at once.
    ``clingo_executions``: executions in one search of clingo.
    ``exact_cost``: largest cost that is counted unrounded.
    ``cost_steps``: if costs are rounded, the whole number that the greatest cost becomes.
    ``extra_executions``: executions of a unit beyond its count, in the search of clingo for a first plan.
    """

    rounded_rows: int = 20
    stalled_rounds: int = 10
    role_depth: int = 2
    rounding_denominator: int = 50_000
    equation_nodes: int = 200
    probes: int = 60
    nodes: int = 20_000
    uncapped_nodes: int = 1_000
    landmark_orders: int = 3
    first_executions: int = 8
    last_executions: int = 1_000
    leaves: int = 1_000
    depth: int = 150
    order_steps: int = 20_000
    single_executions: int = 300
    stocks: int = 200
    unordered_counts: int = 10
    clingo_executions: int = 500
    exact_cost: int = 10**12
    cost_steps: int = 10**6
    extra_executions: int = 4


PLANS = PlanTuning()
