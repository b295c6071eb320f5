"""The FOON files of folders and their sub-folders."""

import re
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

from foon_asp.errors import UserError
from foon_asp.text.formats import NEUTRAL
from foon_asp.text.plain_file import NEUTRAL_SUFFIXES, read_beginning_text, read_content

_FOON_LINE = re.compile(rb"^(?:\xef\xbb\xbf)?[OSM]\d*[\t ]", re.MULTILINE)
_UTF_16 = (b"\xff\xfe", b"\xfe\xff")
_JSON_KEY = re.compile(rb'"(?:input_nodes|object_label|label)"\s*:')


class FolderFile(NamedTuple):
    """A file, and its path relative to the named folder in which it was found.

    If the file itself was named, ``relative`` is its name.
    """

    file: Path
    relative: Path


def foon_files(paths: Iterable[Path]) -> list[FolderFile]:
    """Return the named files, and the FOON files of named folders and their sub-folders, each once.

    Files are in the order of ``paths``, and by name within a folder. A named file may have any content. From
    a folder come the ``*.txt``, ``*.json`` and ``*.jsonl`` files with FOON content: networks and lists of
    objects. Raises :class:`UserError` for a path that does not exist, and for a folder without such files.
    """
    files_by_path: dict[Path, FolderFile] = {}
    for path in paths:
        if not path.exists():
            raise UserError(f"{path}: no such file or folder")
        if not path.is_dir():
            files_by_path.setdefault(path, FolderFile(path, Path(path.name)))
            continue
        files = [FolderFile(file, file.relative_to(path)) for file in sorted(path.rglob("*"))]
        files = [file for file in files if _is_foon(*file)]
        if not files:
            raise UserError(f"{path}: expected a folder with FOON files (*.txt, *.json, *.jsonl), found none")
        for file in files:
            files_by_path.setdefault(file.file, file)
    return list(files_by_path.values())


def _is_foon(file: Path, relative: Path) -> bool:
    """Whether a file of a folder has a suffix and content of FOON.

    Hidden files, and files in hidden folders, are no FOON. Text in UTF-16 counts as FOON: reading it then
    reports the wrong encoding.
    """
    if any(name[:1] == "." for name in relative.parts) or not file.is_file():
        return False
    if file.name.endswith(NEUTRAL_SUFFIXES):
        return NEUTRAL.recognises(read_beginning_text(file), "")
    pattern = {".txt": _FOON_LINE, ".json": _JSON_KEY}.get(file.suffix)
    content = read_content(file) if pattern else b""
    # UTF-16 cannot be read, which has to be reported to the caller
    return pattern is not None and (pattern.search(content) is not None or content[:2] in _UTF_16)
