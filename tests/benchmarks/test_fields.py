"""Data of other fields: what the converters make of small files in their forms."""

import gzip
import io
import json
import pickle
import tarfile
import zipfile
from collections import OrderedDict
from pathlib import Path

import pytest
from fields import factorio, minecraft, sbml

import foon_asp

_MODEL = """<sbml xmlns="http://www.sbml.org/sbml/level3/version1/core"
 xmlns:f="http://www.sbml.org/sbml/level3/version1/fbc/version2"><model>
<listOfParameters><parameter id="no" value="0"/><parameter id="low" value="-9"/>
<parameter id="up" value="9"/></listOfParameters>
<f:listOfObjectives><f:objective><f:listOfFluxObjectives><f:fluxObjective f:reaction="growth"/>
</f:listOfFluxObjectives></f:objective></f:listOfObjectives><listOfReactions>%s</listOfReactions></model></sbml>"""


def reaction(name: str, needs: str, gives: str, low: str, up: str) -> str:
    species = '<speciesReference species="{}"/>'.format
    lists = "".join(
        f"<{tag}>{''.join(map(species, nodes.split()))}</{tag}>"
        for tag, nodes in (("listOfReactants", needs), ("listOfProducts", gives))
    )
    return f'<reaction id="{name}" f:lowerFluxBound="{low}" f:upperFluxBound="{up}">{lists}</reaction>'


def test_a_metabolic_model(tmp_path: Path) -> None:
    """Sugar is taken up, one reaction runs backwards, one is closed, and what leaves the cell is no unit."""
    reactions = [
        reaction("EX_sugar", "sugar", "", "low", "up"),
        reaction("split", "half", "sugar", "low", "no"),
        reaction("closed", "sugar", "wall", "no", "no"),
        reaction("grow", "half M_atp_c", "wall", "no", "up"),
        reaction("EX_wall", "wall", "", "no", "up"),
        reaction("growth", "wall", "cell", "no", "up"),
    ]
    wheel = tmp_path / "cobra.whl"
    with zipfile.ZipFile(wheel, "w") as files:
        files.writestr("cobra/data/tiny.xml.gz", gzip.compress((_MODEL % "".join(reactions)).encode()))
    sbml.write_network(sbml.read_model(wheel, "tiny"), tmp_path / "net", ("M_atp_c",))
    foon = foon_asp.load(tmp_path / "net")
    assert [unit.motion for unit in foon.network] == ["split back", "grow", "growth"]
    assert list(map(str, foon.goals)) == ["wall"]
    answer = foon_asp.solve(foon.problem("wall"))
    assert [step.motion for step in answer.units or ()] == ["split back", "grow"]


def test_minecraft_recipes(tmp_path: Path) -> None:
    recipes = {
        "2": [{"inShape": [[1], [1]], "result": {"id": 2, "count": 4}}],
        "3": [{"ingredients": [2, 1], "result": {"id": 3, "count": 1}}],
    }
    items = [{"id": n, "name": name} for n, name in ((1, "plank"), (2, "stick"), (3, "shovel"))]
    package = tmp_path / "package.tgz"
    with tarfile.open(package, "w:gz") as files:
        for name, value in (("items", items), ("recipes", recipes)):
            text = json.dumps(value).encode()
            entry = tarfile.TarInfo(f"package/minecraft-data/data/pc/1/{name}.json")
            entry.size = len(text)
            files.addfile(entry, io.BytesIO(text))
    assert minecraft.write_network(package, "1", tmp_path / "net") == ["stick", "shovel"]
    foon = foon_asp.load(tmp_path / "net", kitchen="@starting")
    costs = foon_asp.solve(foon.problem("shovel")).costs
    assert costs is not None
    assert (costs.units, costs.inputs) == (2, 3)


def test_factorio_recipes_and_nothing_else_of_a_pickle(tmp_path: Path) -> None:
    gear = {"ingredients": [{"name": "iron"}], "results": [{"name": "gear"}], "energy_required": 0.5}
    wheel = tmp_path / "draftsman.whl"
    for content, fits in (([OrderedDict(gear=gear)], True), ([Path("harm")], False)):
        with zipfile.ZipFile(wheel, "w") as files:
            files.writestr("draftsman/data/recipes.pkl", pickle.dumps(content))
        if not fits:
            with pytest.raises(pickle.UnpicklingError, match="expected plain values"):
                factorio.write_network(wheel, tmp_path / "net")
            continue
        assert factorio.write_network(wheel, tmp_path / "net") == ["gear"]
        foon = foon_asp.load(tmp_path / "net", kitchen="@starting")
        assert "price 0.5" in foon_asp.solve(foon.problem("gear"), "price").text()
