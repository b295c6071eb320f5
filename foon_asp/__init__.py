"""Provably optimal task trees for FOON, by answer set programming."""

__version__ = "0.1.0"
