"""What linting sees of planted slips, and what it says nothing of: rules that look at more than a line."""

import random
from pathlib import Path

import pytest
import slips

from foon_asp.linting.linter import lint
from foon_asp.linting.near_names import deletion_index, near_word
from foon_asp.linting.vocabulary import read_vocabulary
from foon_asp.resources import bundled_kitchen, bundled_vocabulary
from foon_asp.text.diagnostics import InputError
from tests.conftest import Cli
from tests.linting.planted import CHOP, unit


def codes(folder: Path, text: str, vocabulary: Path | None = None) -> list[str]:
    """Lint a recipe and give the codes of what is found."""
    file = folder / "recipe.txt"
    file.write_text(text, encoding="utf-8")
    return [finding.code for finding in lint([file], vocabulary=vocabulary)]


def test_a_vocabulary_is_learned_and_used(tmp_path: Path, cli: Cli) -> None:
    (tmp_path / "FOON.txt").write_text(
        unit("qorn;whole;in [vat], vat", "zwirble", "qorn;zwirbled;in [vat], vat;contains {qorn}")
    )
    (tmp_path / "utensils.txt").write_text("# ours\nprong\n")
    names = tmp_path / "names.txt"
    assert cli("lint", "--learn", tmp_path, "-o", names).code == 0
    assert names.read_bytes() == cli("lint", "--learn", tmp_path).out.encode()
    learned = read_vocabulary(names)
    assert learned.text() == names.read_text()
    assert learned.utensils == {"vat", "prong"}
    slip = unit("qorn;whole", "zwirbel", "qorn;zwirbled")
    assert codes(tmp_path, slip) == []
    assert codes(tmp_path, slip, names) == ["misspelt"]
    wrong = {
        "objects\tbowl": 1,
        "relation [ ]\tin": 14,
        "habit\tpour\t1": 7,
        "relation [ ]\tin\tx": 14,
        "bowl": 5,
    }
    for line, column in wrong.items():
        names.write_text(f"{line}\n")
        with pytest.raises(InputError):
            read_vocabulary(names)
        ran = cli("lint", "--vocabulary", names, tmp_path / "FOON.txt")
        assert (ran.code, f"names.txt:1:{column}: error" in ran.err) == (2, True)


def test_only_known_words_are_meant() -> None:
    known_words = deletion_index(["chopped", "grated"])
    assert near_word("grat", known_words, verbs=True) == "grated"
    assert near_word("chop", known_words, verbs=True) is None  # not "choped", which is no word


def test_our_vocabulary_has_all_of_the_bundled_kitchen(cli: Cli) -> None:
    ours, kitchen = read_vocabulary(bundled_vocabulary()), cli("lint", "--learn", bundled_kitchen()).out
    names = [row for row in kitchen.splitlines() if not row.startswith(("habit", "relation"))]
    assert names
    assert set(names) <= set(ours.text().splitlines())
    assert ours.text() == bundled_vocabulary().read_text(encoding="utf-8")


def test_tables_are_linted_with_their_folder(tmp_path: Path, cli: Cli) -> None:
    (tmp_path / "FOON.txt").write_text(CHOP)
    (tmp_path / "motion.txt").write_text("chop 0.9\nchopp\t0.8\nfry\t0.8\n")
    (tmp_path / "utensils.txt").write_text("knife\ntongs\nonoin\n")
    (tmp_path / "durations.txt").write_text("chop\tlong\n")
    (tmp_path / "unit_prices.txt").write_text("chop\t1.5\n")
    found = cli("lint", tmp_path, "--format", "json").json["findings"]
    assert [(Path(f["file"]).name, f["line"], f["code"]) for f in found] == [
        ("durations.txt", 1, "table"),
        ("motion.txt", 1, "table"),
        ("motion.txt", 2, "unknown-row"),
        ("motion.txt", 3, "missing-rate"),
        ("motion.txt", 3, "unknown-row"),
        ("utensils.txt", 3, "unknown-row"),
    ]
    assert cli("lint", tmp_path / "FOON.txt").out == "1 file: nothing found\n"


def test_most_kinds_of_slips_are_seen_in_our_kitchen(tmp_path: Path) -> None:
    recipes = slips.recipes([bundled_kitchen() / "FOON.txt"])
    texts = [(name, lines) for name, lines in recipes if len(lines) < 120]
    kinds = dict(random.Random(3).sample(sorted(slips.KINDS.items()), 25))
    cases = list(slips.measure(texts, kinds, 1, tmp_path))
    assert len(cases) > 15
    assert sum(case.seen for case in cases) >= 0.8 * len(cases)


@pytest.mark.slow
def test_slips_of_all_kinds_are_seen_in_our_kitchen(tmp_path: Path) -> None:
    texts = list(slips.recipes([bundled_kitchen() / "FOON.txt"]))
    cases = list(slips.measure(texts, slips.KINDS, 4, tmp_path))
    assert sum(case.seen for case in cases) >= 0.8 * len(cases)
    tables = list(slips.measure_tables(bundled_kitchen(), 4, tmp_path))
    assert sum(case.seen for case in tables) >= 0.9 * len(tables)
