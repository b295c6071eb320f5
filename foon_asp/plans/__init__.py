"""Items that are used up: the best plan by counts of executions, its order, lower bounds and proofs.

A plan is a sequence of executions of units. A unit may come several times. Each copy of an object node is
used up at most once.
"""
