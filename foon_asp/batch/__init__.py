"""Thousands of questions in one run: local processes or a cluster, results as they come."""
