"""Checks of every answer: whether a tree executes, and whether a certificate is right."""
