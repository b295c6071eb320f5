"""Metabolic models in SBML as networks in neutral lines: a metabolite is an object node, a reaction a unit.

A reaction is split into the directions that its flux bounds allow. What can be taken up from outside is the
kitchen, with ``COFACTORS``, which no cell can make from scratch; what only leaves the cell is left out. The
goals are what the objective reaction (biomass) needs.
"""

import gzip
import json
import zipfile
from pathlib import Path
from xml.etree import ElementTree

from foon_asp.text.neutral_writer import write_neutral_unit

COFACTORS = tuple(
    f"M_{name}_c"
    for name in [
        "atp",
        "adp",
        "amp",
        "nad",
        "nadh",
        "nadp",
        "nadph",
        "coa",
        "accoa",
        "ACP",
        "q8",
        "q8h2",
        "mqn8",
        "mql8",
        "trdrd",
        "grxrd",
        "iscu",
        "iscs",
        "moadcoo",
        "trnaglu",
        "udcpdp",
        "octdp",
    ]
)
_SBML = "{http://www.sbml.org/sbml/level3/version1/core}"
_FLUX = "{http://www.sbml.org/sbml/level3/version1/fbc/version2}"


def sides(reaction: ElementTree.Element) -> list[list[str]]:
    """Return the reactants and the products of a reaction."""
    lists = [reaction.find(f"{_SBML}{name}") for name in ("listOfReactants", "listOfProducts")]
    return [[str(each.get("species")) for each in found] if found is not None else [] for found in lists]


def text_of(wheel: Path, name: str) -> bytes:
    """Return the SBML of a model in the wheel of ``cobra``."""
    with zipfile.ZipFile(wheel) as files:
        return gzip.decompress(files.read(f"cobra/data/{name}.xml.gz"))


def read_model(wheel: Path, name: str) -> ElementTree.Element:
    """Return a model in the wheel of ``cobra``; raises ``ValueError`` for SBML without one."""
    model = ElementTree.fromstring(text_of(wheel, name)).find(f"{_SBML}model")
    if model is None:
        raise ValueError(f"{wheel}: {name} has no model")
    return model


def write_network(model: ElementTree.Element, folder: Path, kitchen: tuple[str, ...] = COFACTORS) -> None:
    """Write a model as a folder of data."""
    bounds = {each.get("id"): float(each.get("value", 0)) for each in model.iter(f"{_SBML}parameter")}
    objective = {each.get(f"{_FLUX}reaction") for each in model.iter(f"{_FLUX}fluxObjective")}
    imported: dict[str, None] = {}
    goals: list[str] = []
    lines = []
    for reaction in model.iter(f"{_SBML}reaction"):
        reactants, products = sides(reaction)
        lower, upper = (bounds[reaction.get(f"{_FLUX}{side}FluxBound")] for side in ("lower", "upper"))
        name = str(reaction.get("id"))
        goals += reactants if name in objective else []
        for direction, needs, gives, flux in (
            ("", reactants, products, upper),
            (" back", products, reactants, -lower),
        ):
            if flux > 0 and needs and gives:
                lines.append(write_neutral_unit(name + direction, needs, gives, ""))
            elif flux > 0 and gives:
                imported.update(dict.fromkeys(gives))
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "network.jsonl").write_text("".join(lines), encoding="utf-8")
    for file, nodes in (("kitchen.json", (*imported, *kitchen)), ("goal_nodes.json", goals)):
        (folder / file).write_text(json.dumps([{"label": node} for node in nodes]), encoding="utf-8")
