"""Stand-ins on the command line: solve, its certificate, the next best, and align."""

import json
from fractions import Fraction
from pathlib import Path

import foon_asp
from foon_asp.problem import Objective
from tests.conftest import Cli

RECIPE = """O\tegg\nS\twhole\nO\tpan\nS\thot\nM\tfry\nO\tegg\t!\nS\tfried\nS\ton\t[plate]\n//\n"""
NETWORK = """O\tpan\nM\theat\nO\tpan\nS\thot\nS\ton\t[stove]\n//\n"""
KITCHEN = """[{"label": "egg", "states": ["whole"], "container": "bowl"}, {"label": "pan"},
{"label": "egg", "states": ["whole", "white"]}]"""
NODES = "O\tegg\nS\twhole\nS\tin\t[bowl]\nM\tlook\nO\tegg\nS\twhole\nS\twhite\n//\n"


def data(folder: Path) -> tuple[str, ...]:
    (folder / "recipe.txt").write_text(RECIPE)
    (folder / "FOON.txt").write_text(NETWORK + NODES)
    (folder / "kitchen.json").write_text(KITCHEN)
    return str(folder / "recipe.txt"), str(folder / "FOON.txt"), "--kitchen", str(folder / "kitchen.json")


def test_the_nearest_stand_ins_and_their_proof(tmp_path: Path, cli: Cli) -> None:
    proof = str(tmp_path / "proof.json")
    named = data(tmp_path)
    assert cli("solve", *named).code == 1
    ran = cli("solve", *named, "--stand-ins", "--certificate", proof)
    assert ran.code == 0
    assert ran.out.splitlines()[1:10] == [
        "optimal by dissimilarity, then units (strict containers): 4 units, 5 inputs, dissimilarity 4",
        "stand-ins, with a dissimilarity of 4 in all:",
        "  egg; whole; in [bowl]",
        "    for egg; whole",
        "    costs 2: also in [bowl] (2)",
        "    next best: egg; white; whole (3)",
        "  pan; hot; on [stove]",
        "    for pan; hot",
        "    costs 2: also on [stove] (2)",
    ]
    verified = cli("verify", proof, *named, "--stand-ins")
    assert verified.code == 0
    assert "by dissimilarity, then units (strict containers): 4 dissimilarity, 4 units" in verified.out
    other = cli("verify", proof, *named)
    assert other.code == 2
    assert "add --stand-ins" in other.err


def test_another_table_is_another_question(tmp_path: Path, cli: Cli) -> None:
    named, table, proof = data(tmp_path), tmp_path / "mine.txt", str(tmp_path / "proof.json")
    table.write_text("container\tnever\nmore state: white\t0.5\n")
    ran = cli("solve", *named, "--stand-in-table", str(table), "--format", "json")
    assert ran.code == 1  # a pan on a stove is none
    table.write_text("container\t9\nmore state: white\t0.5\n")
    ran = cli("solve", *named, "--stand-in-table", str(table), "--format", "json", "--certificate", proof)
    answer = json.loads(ran.out)
    assert [(row["used"]["node"], row["dissimilarity"]["exact"]) for row in answer["stand_ins"]] == [
        ("egg; white; whole", "1/2"),
        ("pan; hot; on [stove]", "9"),
    ]
    assert cli("verify", proof, *named, "--stand-in-table", str(table)).code == 0
    assert cli("verify", proof, *named, "--stand-ins").code == 2


def test_a_table_in_the_data_folder_counts_with_stand_ins(tmp_path: Path, cli: Cli) -> None:
    data(tmp_path)
    (tmp_path / "FOON.txt").write_text(RECIPE + NETWORK + NODES)
    (tmp_path / "stand_ins.txt").write_text("container\t9\nmore state: white\t0.5\n")
    asked = ("solve", "--data", str(tmp_path), "--goal", "egg; fried; on [plate]")
    assert cli(*asked).code == 1
    ran = cli(*asked, "--stand-ins")
    assert "stand-ins, with a dissimilarity of 9.5 in all:" in ran.out
    (tmp_path / "mine.txt").write_text("container\t1\n")
    over = cli(*asked, "--stand-in-table", str(tmp_path / "mine.txt"))
    assert "stand-ins, with a dissimilarity of 1.5 in all:" in over.out
    goal = "egg; fried; on [plate]"
    answer = foon_asp.solve(foon_asp.load(tmp_path, stand_ins=True).problem(goal))
    assert answer.costs is not None
    assert answer.costs.measure(Objective.DISSIMILARITY) == Fraction(19, 2)
    (tmp_path / "stand_ins.txt").write_text("container\tcheap\n")
    assert cli(*asked).code == 1
    wrong = cli(*asked, "--stand-ins")
    assert (wrong.code, "stand_ins.txt:1:11" in wrong.err) == (2, True)


def test_why_not_ends_with_stand_ins(tmp_path: Path, cli: Cli) -> None:
    ran = cli("why-not", *data(tmp_path))
    assert ran.code == 1
    assert ran.out.splitlines()[-5:] == [
        "or let others stand in (foon-asp solve --stand-ins proves the least different ones):",
        "  egg; whole; in [bowl]",
        "    for egg; whole",
        "  pan; hot; on [stove]",
        "    for pan; hot",
    ]


def test_align(tmp_path: Path, cli: Cli) -> None:
    named = data(tmp_path)
    ran = cli("align", named[0], "--to", named[1])
    assert ran.code == 0
    assert ran.out.splitlines() == [
        "3 nodes: 0 known, 2 one edit away, 1 new",
        "labels known: 2 of 2; units: 0 of 1",
        "",
        "one edit away, and what the network has:",
        "  egg; whole",
        "    egg; whole; in [bowl]: also in [bowl] (2)",
        "  pan; hot",
        "    pan; hot; on [stove]: also on [stove] (2)",
        "",
        "new:",
        "  egg; fried; on [plate]",
    ]
    (tmp_path / "other.txt").write_text("O\tEggs\nS\twhole\nS\tin\t[pan]\nM\tfry\nO\tegg\nS\tfried\n//\n")
    (tmp_path / "to.txt").write_text("O\tegg\nS\twhole\nS\ton\t[pan]\nM\tfry\nO\tegg\nS\tfried\n//\n")
    words = cli("align", str(tmp_path / "other.txt"), "--to", str(tmp_path / "to.txt"), "--format", "csv")
    assert words.out.splitlines()[1].startswith("new,Eggs; whole; in [pan],")
    (tmp_path / "other.txt").write_text("O\tegg\nS\twhole\nS\tin\t[pan]\nM\tfry\nO\tegg\nS\tfried\n//\n")
    renamed = cli(
        "align",
        str(tmp_path / "other.txt"),
        "--to",
        str(tmp_path / "to.txt"),
        "-o",
        str(tmp_path / "new.txt"),
    )
    assert renamed.code == 0
    assert "S\ton\t[pan]" in (tmp_path / "new.txt").read_text()


def test_align_writes_another_word_and_keeps_another_place(tmp_path: Path, cli: Cli) -> None:
    recipe, network, written = (tmp_path / name for name in ("recipe.txt", "to.txt", "new.txt"))
    recipe.write_text("O\tmilk\nO\tcups\nS\tin\t[pan]\nM\tpour\nO\tcup\nS\tfull\nS\thot\n//\n")
    network.write_text("O\tmilk\nS\tin\t[carton]\nO\tcup\nS\tin\t[pan]\nM\tpour\nO\tcup\nS\tfull\n//\n")
    assert "2 one edit away" in cli("align", str(recipe), "--to", str(network)).out
    assert cli("align", str(recipe), "--to", str(network), "-o", str(written)).code == 0
    assert written.read_text().splitlines()[2:] == [
        *("O\tmilk", "O\tcup", "S\tin\t[pan]", "M\tpour"),
        *("O\tcup", "S\tfull", "S\thot", "//"),
    ]
