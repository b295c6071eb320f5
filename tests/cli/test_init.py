"""Data folders to start from."""

from pathlib import Path

import pytest

from tests.cli.test_one_file import RECIPE
from tests.conftest import Cli

FILES = ["goal_nodes.txt", "kitchen.txt", "motion.txt", "recipe.txt", "utensils.txt"]
JSON = """[{"input_nodes": [{"label": "egg", "states": ["raw"]}], "motion_node": "fry",
  "output_nodes": [{"label": "egg", "states": ["fried"]}]}]"""


@pytest.mark.parametrize("recipe", ["", RECIPE, JSON])
def test_a_new_folder_is_clean_and_answers(cli: Cli, tmp_path: Path, recipe: str) -> None:
    folder, file = tmp_path / "new", tmp_path / "egg.json"
    file.write_text(recipe, encoding="utf-8")
    assert cli("init", folder, *(["--from", file] if recipe else [])).code == 0
    assert sorted(path.name for path in folder.iterdir()) == FILES
    assert all(
        path.read_text()[0] == "#" for path in folder.iterdir() if path.name != "recipe.txt" or not recipe
    )
    assert cli("lint", folder).code == 0
    ran = cli("solve", "--all-goals", "--data", folder)
    assert (ran.code, ran.err) == (0, "")
    assert "optimal" in ran.out
    assert "infeasible " not in ran.out
    ran = cli("init", folder)
    assert ran.code == 2
    assert "already exists" in ran.err


def test_what_is_no_recipe_is_refused(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "list.txt").write_text("O\tegg\n", encoding="utf-8")
    ran = cli("init", tmp_path / "new", "--from", tmp_path / "list.txt")
    assert ran.code == 2
    assert "there is no functional unit in it" in ran.err
    (tmp_path / "egg.txt").write_text(RECIPE, encoding="utf-8")
    assert cli("merge", tmp_path / "egg.txt", "--store", tmp_path / "egg.foon").code == 0
    ran = cli("init", tmp_path / "new", "--from", tmp_path / "egg.foon")
    assert (ran.code, "found a store" in ran.err) == (2, True)
    assert not (tmp_path / "new").exists()
