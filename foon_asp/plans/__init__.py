"""Items that are used up: the best plan by counts of executions, an order of executions, bounds and proofs.

A plan is a sequence of executions, in which a unit may come several times, and in which each copy of an
object node is used up once.
"""
