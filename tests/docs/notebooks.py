"""Executes the notebooks of the documentation, without Jupyter.

    python -m tests.docs.notebooks

writes their outputs anew, with pictures where the extra `pictures` is installed. A slow test executes them
and compares the texts.
"""

import ast
import contextlib
import io
import json
from pathlib import Path
from typing import Any

from tests.conftest import ROOT

FOLDER = ROOT / "docs" / "notebooks"


def executed(notebook: Any) -> Any:
    """Give a notebook with the outputs of its cells, executed in order in the current folder."""
    names: dict[str, object] = {}
    count = 0
    for cell in notebook["cells"]:
        if cell["cell_type"] == "code":
            count += 1
            cell["execution_count"] = count
            cell["outputs"] = _outputs("".join(cell["source"]), names, count)
    return notebook


def _outputs(source: str, names: dict[str, object], count: int) -> list[Any]:
    """Execute a cell: what it prints, and the value of its last line."""
    tree = ast.parse(source)
    last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        exec(compile(tree, "cell", "exec"), names)
        value = None
        if isinstance(last, ast.Expr):
            value = eval(compile(ast.Expression(last.value), "cell", "eval"), names)
    outputs: list[Any] = []
    if said.getvalue():
        outputs.append({"name": "stdout", "output_type": "stream", "text": said.getvalue()})
    if value is not None:
        shown = getattr(value, "_repr_mimebundle_", None)
        data = {"text/plain": repr(value)} if shown is None else shown()
        outputs.append(
            {"data": data, "execution_count": count, "metadata": {}, "output_type": "execute_result"}
        )
    return outputs


def texts(notebook: Any) -> list[list[str]]:
    """Give the texts that each code cell shows."""
    return [
        [each.get("text") or each["data"]["text/plain"] for each in cell["outputs"]]
        for cell in notebook["cells"]
        if cell["cell_type"] == "code"
    ]


def read(file: Path) -> Any:
    """Read a notebook."""
    return json.loads(file.read_text(encoding="utf-8"))


if __name__ == "__main__":
    for file in sorted(FOLDER.glob("*.ipynb")):
        text = json.dumps(executed(read(file)), indent=1, ensure_ascii=False)
        file.write_text(text + "\n", encoding="utf-8")
