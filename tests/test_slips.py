"""What linting sees of planted slips, and what it says nothing of: rules that look at more than a line."""

import random
from pathlib import Path

import pytest
import slips

from foon_asp.lint.linter import lint
from foon_asp.lint.vocabulary import read_vocabulary
from foon_asp.resources import bundled_kitchen, bundled_vocabulary
from foon_asp.text.diagnostics import InputError
from tests.conftest import Cli

CHOP = "O\tonion\nS\twhole\nM\tchop\nO\tonion\nS\tchopped\n//\n"


def codes(folder: Path, text: str, vocabulary: Path | None = None) -> list[str]:
    """Lint a recipe and give the codes of what is found."""
    file = folder / "recipe.txt"
    file.write_text(text, encoding="utf-8")
    return [finding.code for finding in lint([file], vocabulary=vocabulary)]


def unit(inputs: str, motion: str, outputs: str) -> str:
    """Write a unit: nodes with commas between, their parts with semicolons, as ``bowl;in [pan]``."""

    def side(nodes: str) -> str:
        lines = []
        for node in nodes.split(", "):
            label, *parts = node.split(";")
            lines.append(f"O\t{label}")
            lines += ["S\t" + part.replace(" [", "\t[").replace(" {", "\t{") for part in parts]
        return "\n".join(lines)

    return f"{side(inputs)}\nM\t{motion}\n{side(outputs)}\n//\n"


@pytest.mark.parametrize(
    "text",
    [
        unit("bun;on [tray];covered [foil], tray, foil", "bake", "bun;baked;on [tray], tray"),
        unit("tray;covered {foil};contains {bun}, bun", "bake", "tray;contains {bun}, bun;baked"),
        unit("can;sealed;contains {tuna}", "open", "can;opened;contains {oil,tuna}"),  # shows what is inside
        unit("pot;contains {pasta,water}", "drain", "pot;contains {pasta}"),
        unit("bowl;contains {egg white,egg yolk,salt}", "whisk", "bowl;contains {egg,salt}"),
        unit("tap;on, water;from [tap], leek;dirty", "wash", "leek;clean, tap;on"),
        unit("butter;wrapped", "remove", "butter, wrapping paper"),
        unit("tap;on, cup;empty", "fill", "tap;on, water;from [tap]"),
        unit("bread;on [board];contains {ham}", "cover", "sandwich;on [board];contains {ham}"),  # a product
        unit("cheese;grated;in [bowl]", "add", "tortilla;contains {cheese}, cheese;grated;on [tortilla]")
        + unit("jar;contains {cheese}, cheese;grated;in [jar]", "add", "pan;contains {cheese}, jar"),
        "O\tpan\t0\nM\theat\t0:00:10\t0:01:20\nO\tpan\t0\nS\thot\n//\n",  # h:mm:ss all over
        "O\tкартофель\nM\tchop\nO\tкартофель\nS\tchopped\n//\n",  # one script
        "O\tpurée\nM\theat\nO\tpurée\nS\thot\n//\n",  # one form
    ],
)
def test_what_is_meant_is_left_alone(tmp_path: Path, text: str) -> None:
    assert codes(tmp_path, text) == []


ANOTHER = unit(
    "plate;contains {bread}, bread;sliced", "add", "plate;contains {bread}, bread;sliced;on [plate]"
)
ANOTHER += unit("plate;contains {bread}, bread;sliced;on [plate]", "eat", "plate;dirty")
IN_BOWL = "bowl;contains {leek,salt}, leek;chopped;in [bowl], salt;in [bowl]"


@pytest.mark.parametrize(
    ("text", "found"),
    [
        (
            unit("leek;chopped;on [board], pan;empty", "scrape", "pan;contains {leek}, board;dirty"),
            "left-out",
        ),
        (unit(f"{IN_BOWL}, spoon", "mix", IN_BOWL.replace("chopped", "chopped;mixed")), ""),
        (unit(f"{IN_BOWL}, spoon", "mix", IN_BOWL).replace("S\tin\t[bowl]\n", "", 1), "other-place"),
        (unit(f"{IN_BOWL}, spoon", "mix", IN_BOWL).replace("S\tin\t[bowl]\n", ""), ""),  # never said
        (unit(IN_BOWL, "mix", IN_BOWL) + ANOTHER, ""),
        (
            unit(IN_BOWL, "mix", IN_BOWL) + ANOTHER.replace("S\ton\t[plate]\n", "", 1),
            "other-place other-place",
        ),
    ],
)
def test_what_is_in_something_that_is_not_there(tmp_path: Path, text: str, found: str) -> None:
    assert [code for code in codes(tmp_path, text) if code in {"left-out", "other-place"}] == found.split()


@pytest.mark.parametrize(
    ("text", "fixed"),
    [
        ("S\tin\t{bowl]", None),  # a place, which the reader takes for a list
        ("S\tin\t{bowl] ", None),  # nor by way of another slip on the line
        ("S\tin\t[bowl}", "S\tin\t[bowl]"),
        ("S\tcontains\t{leek]", "S\tcontains\t{leek}"),
        ("S\tin\t{leek,bowl]", "S\tin\t{leek,bowl}"),
    ],
)
def test_brackets_of_two_kinds_are_mended_where_it_is_sure(
    tmp_path: Path, cli: Cli, text: str, fixed: str | None
) -> None:
    whole = f"O\tleek\n{text}\nO\tbowl\nM\tchop\nO\tleek\nS\tchopped\n//\n"
    file = tmp_path / "a.txt"
    file.write_text(whole)
    assert "[bracket]" in cli("lint", file).out
    cli("lint", file, "--fix")
    assert file.read_text() == (whole if fixed is None else whole.replace(text, fixed))


def test_a_vocabulary_is_learned_and_used(tmp_path: Path, cli: Cli) -> None:
    (tmp_path / "FOON.txt").write_text(
        unit("qorn;whole;in [vat], vat", "zwirble", "qorn;zwirbled;in [vat], vat;contains {qorn}")
    )
    (tmp_path / "utensils.txt").write_text("# ours\nvat\nprong\n")
    names = tmp_path / "names.txt"
    assert cli("vocabulary", tmp_path, "-o", names).code == 0
    assert names.read_bytes() == cli("vocabulary", tmp_path).out.encode()
    learned = read_vocabulary(names)
    assert learned.text() == names.read_text()
    assert learned.utensils == {"vat", "prong"}
    slip = unit("qorn;whole", "zwirbel", "qorn;zwirbled")
    assert codes(tmp_path, slip) == []
    assert codes(tmp_path, slip, names) == ["misspelt"]
    for wrong in ("objects\tbowl\n", "relation [ ]\tin\n", "habit\tpour\t1\n", "bowl\n"):
        names.write_text(wrong)
        with pytest.raises(InputError):
            read_vocabulary(names)
        ran = cli("lint", "--vocabulary", names, tmp_path / "FOON.txt")
        assert (ran.code, "names.txt:1:" in ran.err) == (2, True)


def test_our_vocabulary_has_all_of_the_bundled_kitchen(cli: Cli) -> None:
    ours, kitchen = read_vocabulary(bundled_vocabulary()), cli("vocabulary", bundled_kitchen()).out
    names = [row for row in kitchen.splitlines() if not row.startswith(("habit", "relation"))]
    assert names
    assert set(names) <= set(ours.text().splitlines())
    assert ours.text() == bundled_vocabulary().read_text(encoding="utf-8")


def test_tables_are_linted_with_their_folder(tmp_path: Path, cli: Cli) -> None:
    (tmp_path / "FOON.txt").write_text(CHOP)
    (tmp_path / "motion.txt").write_text("chop 0.9\nchopp\t0.8\n")
    (tmp_path / "utensils.txt").write_text("knife\ntongs\nonoin\n")
    (tmp_path / "durations.txt").write_text("chop\tlong\n")
    (tmp_path / "unit_prices.txt").write_text("chop\t1.5\n")
    found = cli("lint", tmp_path, "--format", "json").json["findings"]
    assert [(Path(f["file"]).name, f["line"], f["code"]) for f in found] == [
        ("durations.txt", 1, "table"),
        ("motion.txt", 1, "table"),
        ("motion.txt", 2, "missing-rate"),
        ("motion.txt", 2, "unknown-row"),
        ("utensils.txt", 3, "unknown-row"),
    ]
    assert cli("lint", tmp_path / "FOON.txt").out == "1 file: nothing found\n"


def test_a_planted_slip_is_found_where_it_is(tmp_path: Path) -> None:
    """The bench counts what is new in the units that were touched, and nothing else."""
    lines = (CHOP + CHOP.replace("onion", "leek")).splitlines()
    bench = slips.Bench(tmp_path)
    file = tmp_path / "recipe.txt"
    assert bench.seen(file, lines, [slips.Edit(8, 9, ["M\tchopp"])], [file]) == ["near-name"]
    assert bench.seen(file, lines, [slips.Edit(0, 1, ["O\tonion"])], [file]) == []
    assert slips.planted(lines, [slips.Edit(2, 3, []), slips.Edit(4, 4, ["x"])])[0] == [
        *lines[:2],
        *lines[3:4],
        "x",
        *lines[4:],
    ]


def test_most_kinds_of_slips_are_seen_in_our_kitchen(tmp_path: Path) -> None:
    texts = [
        (name, lines) for name, lines in slips.recipes([bundled_kitchen() / "FOON.txt"]) if len(lines) < 120
    ]
    kinds = dict(random.Random(3).sample(sorted(slips.KINDS.items()), 25))
    cases = list(slips.measure(texts, kinds, 1, tmp_path))
    assert len(cases) > 15
    assert sum(case.seen for case in cases) >= 0.8 * len(cases)


@pytest.mark.slow
def test_slips_of_all_kinds_are_seen_in_our_kitchen(tmp_path: Path) -> None:
    texts = list(slips.recipes([bundled_kitchen() / "FOON.txt"]))
    cases = list(slips.measure(texts, slips.KINDS, 8, tmp_path))
    assert sum(case.seen for case in cases) >= 0.8 * len(cases)
    tables = list(slips.measure_tables(bundled_kitchen(), 4, tmp_path))
    assert sum(case.seen for case in tables) >= 0.9 * len(tables)
