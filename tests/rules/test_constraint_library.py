"""``foon-asp constraints``: what it lists is what the files say."""

from pathlib import Path

from foon_asp.encoding.encoding import read_encoding
from foon_asp.rules.constraint_library import library_constraints
from tests.conftest import ROOT, Cli

FOLDER = ROOT / "encodings" / "constraints"


def test_every_file_is_listed_with_its_parameters_and_an_example_of_each() -> None:
    listed = library_constraints()
    assert [constraint.name for constraint in listed] == sorted(file.stem for file in FOLDER.glob("*.lp"))
    for constraint in listed:
        constants = read_encoding(FOLDER / f"{constraint.name}.lp").constants
        assert {p.name: p.own_value for p in constraint.parameters} == constants
        assert all(p.example for p in constraint.parameters)
        assert all(p.name in constraint.purpose for p in constraint.parameters)
        assert "-c " not in constraint.purpose


def test_the_list_can_be_pasted(cli: Cli, tmp_path: Path) -> None:
    prices = tmp_path / "prices.txt"
    prices.write_text("crush\t1.25\n")
    text = cli("constraints")
    assert text.code == 0
    assert "  --constraint at_most_motion -c limited_motion=wash -c max_uses=2\n" in text.out
    listed = cli("constraints", "--format", "json").json["constraints"]
    assert len(listed) == len(list(FOLDER.glob("*.lp"))) >= 19
    for entry in listed:
        words = [w for p in entry["parameters"] for w in ("-c", f"{p['name']}={p['example']}")]
        ran = cli("solve", "--goal", "ice", "--unit-prices", prices, "--constraint", entry["name"], *words)
        assert ran.code in {0, 1}
        assert ran.err == ""
