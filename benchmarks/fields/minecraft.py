"""Crafting recipes of Minecraft (npm ``minecraft-data``): an item is an object node, a recipe a unit.

How many of an item a recipe takes is not looked at. No kitchen is written, so what no recipe makes is assumed
to be there, and what is first needed of items that can only be made from each other.
"""

import json
import tarfile
from pathlib import Path
from typing import Any

from foon_asp.text.neutral_writer import write_neutral_unit


def write_network(package: Path, version: str, folder: Path) -> list[str]:
    """Write the recipes of a version as a folder of data, and return the names of what they make."""
    with tarfile.open(package) as files:

        def read(name: str) -> Any:
            file = files.extractfile(f"package/minecraft-data/data/pc/{version}/{name}.json")
            return json.load(file) if file else None

        names = {item["id"]: item["name"] for item in read("items")}
        recipes = [recipe for made in read("recipes").values() for recipe in made]
    lines: dict[str, None] = {}
    made: dict[str, None] = {}
    for recipe in recipes:
        rows = recipe.get("inShape") or [recipe["ingredients"]]
        needs = dict.fromkeys(names[item] for row in rows for item in row if item is not None)
        result = names[recipe["result"]["id"]]
        if result not in needs:
            lines[write_neutral_unit("craft", needs, [result], "1")] = None
            made[result] = None
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "network.jsonl").write_text("".join(lines), encoding="utf-8")
    return list(made)
