"""Build the documentation as a site, in site/html: the pages of docs/, and a reference made from the program.

    make docs

Pages link to each other as they lie on disk, so Sphinx is given a mirror of the repository, with the
reference beside it. Nothing is served; open site/html/index.html.
"""

import contextlib
import io
import shutil
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

import foon_asp
from foon_asp.cli.main import main as foon_asp_command
from foon_asp.cli.verbs import GROUPS, VERBS
from foon_asp.json_layout import json_text
from foon_asp.results.schema_file import schema

ROOT = Path(__file__).resolve().parents[1]
MIRRORED = (
    "*.md",
    "docs/*.md",
    "docs/dev/*.md",
    "docs/pictures/*",
    "encodings/**/*",
    "data/**/*",
    ".ci/*",
    "benchmarks/*.py",
)
SITE = ROOT / "site"

PAGES = {
    "Start": ("README", "docs/guide"),
    "Tutorials": (
        "docs/tutorial-robot",
        "docs/tutorial-logic",
        "docs/tutorial-planning",
        "docs/tutorial-frame",
    ),
    "How to": (
        "docs/questions",
        "docs/stand-ins",
        "docs/writing-constraints",
        "docs/writing-objectives",
        "docs/plans",
        "docs/view",
        "docs/editor",
        "docs/batch",
        "docs/store",
        "docs/pddl",
        "docs/entry-points",
        "docs/api",
    ),
    "Reference": (
        "reference/verbs",
        "reference/python",
        "encodings/README",
        "docs/json",
        "reference/schemas",
        "docs/formats",
        "docs/lint",
    ),
    "Why it is right": ("docs/proofs", "SECURITY"),
    "Working on it": (
        "CONTRIBUTING",
        "docs/dev/architecture",
        "docs/dev/words",
        "docs/dev/reductions",
        "docs/dev/questions",
        "docs/dev/certificates",
        "docs/dev/exact-success",
        "docs/dev/store",
        "docs/dev/testing",
        "docs/dev/performance",
        "docs/dev/measured",
        "docs/dev/published-table",
        "docs/dev/lint-judged",
        "docs/dev/sources",
        "CHANGELOG",
        "data/kitchen/README",
    ),
}

SETTINGS = """
project = "foon-asp"
author = copyright = "The foon-asp developers"
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
myst_heading_anchors = 4
myst_enable_extensions = ["html_image"]
html_theme = "furo"
autodoc_member_order = "bysource"
autodoc_typehints = "description"
suppress_warnings = ["myst.xref_missing", "myst.header", "misc.highlighting_failure"]
"""


def mirror(source: Path) -> None:
    """Copy the pages, and what they link to, as they lie in the repository."""
    for pattern in MIRRORED:
        for file in ROOT.glob(pattern):
            if file.is_file():
                target = source / file.relative_to(ROOT)
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(file, target)


def index() -> Iterator[str]:
    """Give the front page: all pages, by heading."""
    yield "# foon-asp\n\nProvably optimal task trees for FOON, by answer set programming.\n"
    for heading, pages in PAGES.items():
        yield f"```{{toctree}}\n:caption: {heading}\n:maxdepth: 1\n"
        yield from pages
        yield "```\n"


def verbs() -> Iterator[str]:
    """Give the reference of verbs, from the catalog and their own help."""
    yield "# Verbs\n\nWhat `foon-asp VERB -h` prints.\n"
    for group in GROUPS:
        yield f"## {group}\n"
        for verb in (verb for verb, entry in VERBS.items() if entry.group == group):
            said = io.StringIO()
            with contextlib.redirect_stdout(said), contextlib.suppress(SystemExit):
                foon_asp_command([verb, "--help"])
            yield f"### {verb}\n\n{VERBS[verb].line}\n\n```text\n{said.getvalue().rstrip()}\n```\n"


def python() -> Iterator[str]:
    """Give the reference of Python, from the docstrings of all public names."""
    yield "# Python\n\nAll that `import foon_asp` offers, by name; [api](../docs/api.md) has the examples.\n"
    for name in sorted(foon_asp.__all__, key=str.lower):
        value = getattr(foon_asp, name)
        kind = "class" if isinstance(value, type) else "function" if callable(value) else "data"
        members = "\n   :members:" if kind == "class" else ""
        yield f"## {name}\n\n```{{eval-rst}}\n.. auto{kind}:: foon_asp.{name}{members}\n```\n"


def schemas() -> Iterator[str]:
    """Give the schemas of all JSON that is printed."""
    yield "# JSON Schemas\n\nWhat `foon-asp schema VERB` prints; [json](../docs/json.md) explains it.\n"
    for file in sorted((ROOT / "foon_asp" / "document" / "schemas").glob("*.json")):
        if file.stem != "defs":
            yield f"## {file.stem}\n\n```json\n{json_text(schema(file.stem)).rstrip()}\n```\n"


MADE = {"index": index, "reference/verbs": verbs, "reference/python": python, "reference/schemas": schemas}


def main(arguments: Sequence[str]) -> int:
    """Build the site, and give the exit code of Sphinx."""
    from sphinx.cmd.build import main as sphinx  # noqa: PLC0415 (the pages are made without it, too)

    source = SITE / "source"
    shutil.rmtree(SITE, ignore_errors=True)
    mirror(source)
    for page, lines in MADE.items():
        (source / page).parent.mkdir(parents=True, exist_ok=True)
        (source / f"{page}.md").write_text("\n".join(lines()), encoding="utf-8")
    (source / "conf.py").write_text(SETTINGS, encoding="utf-8")
    return sphinx([*arguments, "-q", "-b", "html", str(source), str(SITE / "html")])


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
