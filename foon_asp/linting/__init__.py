"""Linting of FOON files: rules that find errors and probable slips of annotators."""
