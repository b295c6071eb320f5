"""What is wrong with FOON files, or worth a look: everything an annotator may have slipped on."""

from foon_asp.lint.catalog import CATALOG as CATALOG
from foon_asp.lint.catalog import Rule as Rule
from foon_asp.lint.linter import lint as lint
from foon_asp.lint.mending import mended as mended
