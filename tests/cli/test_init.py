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


def test_templates_have_the_motions_of_the_recipe_and_its_times(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "egg.txt").write_text(
        "//\nO\tegg\nM\tcrack\t<0:10-0:14>\nO\tegg\nS\tcracked\n//\n"
        "O\tegg\nS\tcracked\nM\tfry\tAssumed\nO\tegg\nS\tfried\n//\n"
    )
    folder = tmp_path / "data"
    folder.mkdir()
    (folder / "utensils.txt").write_text("pan\n")  # what is there stays
    assert cli("init", folder, "--from", tmp_path / "egg.txt", "--rates", "--durations").code == 0
    assert sorted(path.name for path in folder.iterdir()) == ["durations.txt", "motion.txt", "utensils.txt"]
    assert (folder / "motion.txt").read_text().splitlines()[-2:] == ["crack\t1", "fry\t1"]
    durations = folder / "durations.txt"
    assert durations.read_text().splitlines()[1:] == ["crack\t4", "fry\tSECONDS"]
    question = ("solve", tmp_path / "egg.txt", "--durations", durations, "--format", "steps")
    assert "expected a number of seconds" in cli(*question).err
    durations.write_text(durations.read_text().replace("SECONDS", "2 min"))
    steps = cli(*question).json["steps"]
    assert [step["duration"]["exact"] for step in steps] == ["4", "120"]
    assert [step["clip"] for step in steps] == [{"begin": 10, "end": 14, "seconds": 4}, None]
    ran = cli("init", folder, "--from", tmp_path / "egg.txt", "--durations")
    assert (ran.code, "durations.txt already exists" in ran.err) == (2, True)
    assert cli("init", tmp_path / "rates", "--rates").code == 0
    assert [path.name for path in (tmp_path / "rates").iterdir()] == ["motion.txt"]
