"""What is wrong with FOON files, or worth a look: everything an annotator may have slipped on."""

from foon_asp.lint.catalog import CATALOG, Rule
from foon_asp.lint.linter import lint
from foon_asp.lint.mending import mended

__all__ = ["CATALOG", "Rule", "lint", "mended"]
