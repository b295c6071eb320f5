"""Searches compared with the optimum, for one goal or thousands."""
