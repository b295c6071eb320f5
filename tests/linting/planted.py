"""Small recipes with slips in them, and what linting finds there."""

from pathlib import Path

from foon_asp.linting.linter import lint

CHOP = "O\tonion\nS\twhole\nM\tchop\nO\tonion\nS\tchopped\n//\n"


def unit(inputs: str, motion: str, outputs: str) -> str:
    """Write a unit: nodes with commas between, their parts with semicolons, as ``bowl;in [pan]``."""

    def side(nodes: str) -> str:
        lines = []
        for node in nodes.split(", "):
            label, *parts = node.split(";")
            lines.append(f"O\t{label}")
            lines += ["S\t" + part.replace(" [", "\t[").replace(" {", "\t{") for part in parts]
        return "\n".join(lines)

    return f"{side(inputs)}\nM\t{motion}\n{side(outputs)}\n//\n"


def written(folder: Path, *texts: str, names: tuple[str, ...] = ()) -> list[Path]:
    """Write texts into files: ``0.txt``, ``1.txt``, ... or with names."""
    files = []
    for number, text in enumerate(texts):
        file = folder / (names[number] if names else f"{number}.txt")
        file.write_bytes(text.encode())
        files.append(file)
    return files


def findings(folder: Path, *texts: str, vocabulary: Path | None = None) -> str:
    """Lint texts together; return ``line:column code`` of each finding, in order."""
    found = lint(written(folder, *texts), vocabulary=vocabulary)
    return ", ".join(f"{f.source.line}:{f.source.column} {f.code}" for f in found)
