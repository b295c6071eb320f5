"""Mutation testing: the code is changed on purpose, one place at a time, to see whether a test notices.

``make mutants`` runs it; ``docs/dev/testing.md`` says what it does and why it is our own.
"""
