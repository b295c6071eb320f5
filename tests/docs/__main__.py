"""What type checkers read of public names: ``python -m tests.docs`` writes it into the package."""

from pathlib import Path

import foon_asp

FILE = Path(foon_asp.__file__).with_name("__init__.pyi")


def stub() -> str:
    """Return what a type checker reads of the package, which imports a name only when it is asked for."""
    modules = foon_asp.modules_of_names()
    lines = sorted(f"from foon_asp.{module} import {name} as {name}" for name, module in modules.items())
    return "\n".join(
        [
            '"""Public names; `python -m tests.docs` writes this file."""\n',
            *lines,
            "\n__all__: list[str]",
            "__version__: str",
            "",
            "def modules_of_names() -> dict[str, str]: ...\n",
        ]
    )


if __name__ == "__main__":
    FILE.write_text(stub(), encoding="utf-8")
    print(f"written: {FILE.name}")
