"""Findings of linting, and files compared line by line."""
