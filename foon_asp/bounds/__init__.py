"""Landmarks and lower bounds for min-cost derivations, on plain arrays.

Everything here speaks of actions and objects by number: an action needs objects and gives objects, some
objects are there from the start, some are targets. What the numbers stand for is the caller's.
"""
