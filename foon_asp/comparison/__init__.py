"""Comparison of searches with the optimum, for one goal or thousands."""
