"""``foon-asp rename``: renaming of an object, a state or a motion in several files together."""

import difflib
from codecs import BOM_UTF8
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path

import click

from foon_asp.cli import shared_options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.shown_diff import show_diff
from foon_asp.errors import UserError
from foon_asp.network import counted
from foon_asp.text.diagnostics import InputError, Rename
from foon_asp.text.folder_files import foon_files
from foon_asp.text.formats import format_of
from foon_asp.text.line import NameKind
from foon_asp.text.plain_file import read_content, read_plain_text
from foon_asp.text.renaming import Renaming, is_name
from foon_asp.text.side_table import TABLES
from foon_asp.whole_file import utf_8, write_all_whole

_WITH_ARTICLE = {NameKind.OBJECT: "an object", NameKind.WORD: "a word of relations"}


@click.command("rename")
@click.argument("old")
@click.argument("new")
@shared_options.files_argument
@click.option(
    "--kind",
    type=click.Choice([str(kind) for kind in NameKind]),
    help="What is renamed, if the name is that of several things.",
)
@click.option("-y", "--write", is_flag=True, help="Write the change; without it, it is only shown.")
@shared_options.debug_option
def command(old: str, new: str, paths: tuple[Path, ...], kind: str | None, write: bool) -> ExitCode:
    """Rename an object, a state or a motion everywhere, and show the change first.

    \b
    foon-asp rename cinammon cinnamon recipes/          show what would change
    foon-asp rename cinammon cinnamon recipes/ -y       change it
    foon-asp rename cut chopped a.txt --kind state      where cut is a motion, too

    An object is renamed on object lines, in relations ([bowl]) and in contents ({salt}); a state, a motion
    and the word of a relation where they stand. Where NEW has an id already, the lines of OLD get it. Of a
    folder, networks, kitchens, goals and the tables (motion.txt, utensils.txt, unit_prices.txt,
    unit_amounts.txt, tools.txt, durations.txt) are changed together. Everything else in the files stays as it
    is, comments included.

    Where one file cannot be written, all stay as they were, as after ctrl-C. If the process is killed while
    it writes, each file is the old one or the new one, and the same command again writes the others. Exits
    with 0, or with 2, and nothing written, if there is no such name, if it is that of several kinds of
    things, or if a line with it is not understood.
    """
    texts = {file: read_plain_text(file) for file in _files_to_rename_in(paths)}
    renaming = Renaming(Rename(_kind_of_name(old, kind, texts), old, new))
    if old == new:
        raise UserError("the new name is the old one")
    if not is_name(renaming.rename.kind, new):
        raise UserError(f"{new!r} cannot be the name of {_with_article(renaming.rename.kind)} in FOON text")
    errors = []
    for file, text in texts.items():
        format_ = format_of(text, str(file))
        renaming.learn(format_.mentions(text, str(file)))
        try:
            format_.canonical_text(text, str(file))
        except InputError as error:
            errors += [diagnostic for diagnostic in error.diagnostics if old in diagnostic.excerpt]
    if errors:
        raise InputError(errors)
    changed = {}
    for file, text in texts.items():
        new_text = format_of(text, str(file)).renamed_text(text, str(file), renaming)
        if new_text != text:
            changed[file] = text, new_text
    for file, (old_text, new_text) in changed.items():
        show_diff(str(file), old_text, new_text)
    if write:
        write_all_whole(
            {file: _byte_order_mark(file) + utf_8(new_text) for file, (_, new_text) in changed.items()}
        )
    click.echo(_summary(renaming, len(changed), write), err=True)
    return ExitCode.DONE


def _files_to_rename_in(paths: Sequence[Path]) -> list[Path]:
    """Return the FOON files in ``paths`` and in their folders, and the tables in the folders."""
    files = [file for file, _ in foon_files(paths)]
    for folder in (path for path in paths if path.is_dir()):
        files += sorted(file for name in TABLES for file in folder.rglob(name) if file.is_file())
    return list(dict.fromkeys(files))


def _byte_order_mark(file: Path) -> bytes:
    """Return the byte order mark of UTF-8 if a file begins with it, else no bytes."""
    return BOM_UTF8 if read_content(file).startswith(BOM_UTF8) else b""


def _kind_of_name(old: str, kind: str | None, texts: Mapping[Path, str]) -> str:
    """Return the kind of an old name in the texts, such as ``object``.

    ``kind`` is the kind that the user chose; ``None`` if none was chosen. Raises :class:`UserError` if the
    name is nowhere, or is not of the chosen kind. Without a chosen kind, it is also raised for a name of
    several kinds.
    """
    counts: Counter[tuple[str, str]] = Counter()
    for file, text in texts.items():
        counts.update(
            (str(name_kind), name)
            for name_kind, name, _ in format_of(text, str(file)).mentions(text, str(file))
        )
    kinds = [possible for possible in NameKind if counts[possible, old]]
    if kind is not None and kind in kinds:
        return kind
    if kinds and kind is not None:
        raise UserError(f"{old!r} is no {kind}; it is {_with_article(kinds[0])}")
    if len(kinds) > 1:
        kinds_text = " and ".join(f"{_with_article(each)} ({counts[each, old]} times)" for each in kinds)
        raise UserError(f"{old!r} is {kinds_text}: choose one with --kind")
    if not kinds:
        similar = difflib.get_close_matches(old, sorted({name for _, name in counts}), n=3, cutoff=0.7)
        hint = f"; there is {', '.join(map(repr, similar))}" if similar else ""
        raise UserError(
            f"no object, state, relation or motion is called {old!r} in {counted(len(texts), 'file')}{hint}"
        )
    return kinds[0]


def _with_article(kind: str) -> str:
    """Return the word of a kind with its article: ``an object``."""
    return _WITH_ARTICLE.get(NameKind(kind), f"a {kind}")


def _summary(renaming: Renaming, file_count: int, written: bool) -> str:
    """Return a summary of a renaming in words: the mentions, the files, and whether they are written."""
    kind, old, new = renaming.rename
    mentions = f"{counted(renaming.mentions, 'mention')} in {counted(file_count, 'file')}"
    text = f"the {kind} {old!r} becomes {new!r}: {mentions}"
    if renaming.new_mentions:
        times = counted(renaming.new_mentions, "time")
        text += f"; {new!r} stood there {times} already, and both are one name now"
    return f"{text}; written" if written else f"{text}; -y writes it"
