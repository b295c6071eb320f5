"""Packages of others, made and installed by tests: a module, and what pip would write beside it."""

from collections.abc import Mapping
from pathlib import Path

import pytest


def install(
    folder: Path,
    package: str,
    code: str,
    searches: Mapping[str, str] | None = None,
    engines: Mapping[str, str] | None = None,
) -> Path:
    """Put a package into a folder, which is then to be on the path of Python.

    Entry points are functions of the module by name.
    """
    module = package.replace("-", "_")
    told = folder / f"{module}-1.0.dist-info"
    told.mkdir(parents=True)
    (folder / f"{module}.py").write_text(code)
    (told / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {package}\nVersion: 1.0\n")
    lines: list[str] = []
    for group, points in (("foon_asp.searches", searches), ("foon_asp.engines", engines)):
        lines += [
            f"[{group}]",
            *(f"{name} = {module}:{function}" for name, function in (points or {}).items()),
        ]
    (told / "entry_points.txt").write_text("\n".join(lines) + "\n")
    return folder


class Packages:
    """A folder on the path of this process and of those it starts, for packages of others."""

    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        self.folder = folder
        monkeypatch.syspath_prepend(folder)

    def install(
        self,
        package: str,
        code: str = "",
        searches: Mapping[str, str] | None = None,
        engines: Mapping[str, str] | None = None,
    ) -> None:
        """Install a package."""
        install(self.folder, package, code, searches, engines)
