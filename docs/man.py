"""Write the manual pages of ``foon-asp`` and of every verb, from the catalog and their own help.

make man
man -M build/man foon-asp-solve
"""

import inspect
import re
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

import click

import foon_asp
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.main import cli
from foon_asp.cli.verbs import GROUPS, VERBS, verb_command

TARGET = Path(__file__).resolve().parents[1] / "build" / "man" / "man1"
SPECIAL = {"\\": r"\e", "-": r"\-", "'": r"\(aq", "`": r"\(ga", "^": r"\(ha", "~": r"\(ti"}


def roff(text: str) -> str:
    """Give a text that means itself, in one line."""
    return _line(" ".join(text.split()))


def _line(text: str) -> str:
    """Give a line that means itself, with all its blanks; it does not begin like a request."""
    written = "".join(SPECIAL.get(c, c if c.isascii() else f"\\[u{ord(c):04X}]") for c in text)
    return rf"\&{written}" if written[:1] == "." else written


def page(name: str, line: str, usage: str) -> Iterator[str]:
    """Give the head of a page."""
    yield f'.TH "{roff(name.upper())}" 1 "" "foon\\-asp {foon_asp.__version__}" "foon\\-asp"'
    yield from (".SH NAME", rf"{roff(name)} \- {roff(line)}", ".SH SYNOPSIS", rf"\fB{roff(usage)}\fR")


def paragraphs(help_: str) -> Iterator[str]:
    """Give the paragraphs of a help text; what follows a mark of click keeps its lines and blanks."""
    for part in re.split(r"\n\s*\n", inspect.cleandoc(help_)):
        yield ".PP"
        if part.startswith("\b\n"):
            lines = map(_line, part.split("\n")[1:])
            yield from (
                ".nf",
                *(re.sub("  +| $", lambda found: r"\ " * len(found[0]), each) for each in lines),
                ".fi",
            )
        else:
            yield roff(part)


def options(command: click.Command, context: click.Context) -> Iterator[str]:
    """Give each option with its help."""
    yield ".SH OPTIONS"
    for each in command.get_params(context):
        record = each.get_help_record(context)
        if record and record[1]:
            yield from (".TP", rf"\fB{roff(record[0])}\fR", roff(record[1]))


def main_page() -> Iterator[str]:
    """Give the page of the command: its verbs by group, and the exit codes."""
    context = click.Context(cli, info_name="foon-asp")
    first, *others = inspect.cleandoc(cli.help or "").split("\n\n")
    yield from page("foon-asp", first.rstrip("."), "foon-asp VERB [OPTIONS] [ARGUMENTS]")
    yield ".SH DESCRIPTION"
    yield from paragraphs("\n\n".join(others))
    for group in GROUPS:
        yield f'.SS "{group}"'
        for verb, entry in VERBS.items():
            if entry.group == group:
                yield from (".TP", rf"\fBfoon\-asp\-{roff(verb)}\fR(1)", roff(entry.line))
    yield from options(cli, context)
    yield ".SH EXIT STATUS"
    said = re.findall(r"(\w+) = \d+\n    \"\"\"(.*?)\"\"\"", inspect.getsource(ExitCode), re.DOTALL)
    for name, text in said:
        yield from (".TP", rf"\fB{int(ExitCode[name])}\fR", roff(text))


def verb_page(verb: str) -> Iterator[str]:
    """Give the page of a verb."""
    command, line = verb_command(verb), VERBS[verb].line
    context = click.Context(command, info_name=f"foon-asp {verb}")
    usage = " ".join([f"foon-asp {verb}", *command.collect_usage_pieces(context)])
    yield from page(f"foon-asp-{verb}", line.rstrip("."), usage)
    yield ".SH DESCRIPTION"
    yield from paragraphs(command.help or line)
    yield from options(command, context)
    yield from (".SH SEE ALSO", r"\fBfoon\-asp\fR(1)")


def pages() -> Iterator[tuple[str, str]]:
    """Give the name of each page and its text."""
    yield "foon-asp.1", "\n".join(main_page()) + "\n"
    for verb in VERBS:
        yield f"foon-asp-{verb}.1", "\n".join(verb_page(verb)) + "\n"


def main(arguments: Sequence[str]) -> None:
    """Write all pages into a folder, by default ``build/man/man1``."""
    target = Path(arguments[0]) if arguments else TARGET
    target.mkdir(parents=True, exist_ok=True)
    for name, text in pages():
        (target / name).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
