"""A folder of data: which files are what, what is given on its own, and what reading them together gives."""

from fractions import Fraction
from pathlib import Path

import pytest

from foon_asp.errors import UserError
from foon_asp.network import Source, starting_nodes
from foon_asp.resources import bundled_kitchen
from foon_asp.text.data_folder import DataFiles, find_data, read_data
from foon_asp.text.diagnostics import InputError, Severity
from foon_asp.text.tables import read_utensils

MIX = "O\ta\nM\tmix\nO\tb\n//\n"
CUT = "O\ta\nM\tcut\nO\ta\nS\tcut\nS\tin\t[bowl]\n//\n"
KITCHEN = '[{"label": "a"}]'
GOALS = '[{"label": "b"},\n {"label": "nothing"}]'


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Give a folder with every piece in it."""
    folder = tmp_path / "data"
    folder.mkdir()
    (folder / "FOON.txt").write_text(MIX + CUT)
    (folder / "kitchen.json").write_text(KITCHEN)
    (folder / "motion.txt").write_text("mix\t0.9\ncut\t1\n")
    (folder / "utensils.txt").write_text("bowl\nknife\n")
    (folder / "goal_nodes.json").write_text(GOALS)
    return folder


# --- finding


def test_kitchen_and_goals_may_be_foon_text(folder: Path) -> None:
    as_json = read_data(find_data(folder))
    for name in ("kitchen", "goal_nodes"):
        (folder / f"{name}.txt").write_text("O\ta\n" if name == "kitchen" else "O\tb\nO\tnothing\n")
    assert find_data(folder).kitchen == folder / "kitchen.json"
    assert find_data(folder).goals == folder / "goal_nodes.json"
    (folder / "kitchen.json").unlink()
    (folder / "goal_nodes.json").unlink()
    files = find_data(folder)
    assert (files.kitchen, files.goals) == (folder / "kitchen.txt", folder / "goal_nodes.txt")
    data = read_data(files)
    assert data.kitchen == as_json.kitchen
    assert [goal.pattern for goal in data.goals] == [goal.pattern for goal in as_json.goals]
    assert [goal.source.line for goal in data.goals] == [1, 2]


def test_networks_may_be_json(folder: Path) -> None:
    (folder / "FOON.txt").unlink()
    unit = '{"input_nodes": [{"label": "a"}], "motion_node": "%s", "output_nodes": [{"label": "b"}]}'
    (folder / "1.json").write_text(f'{{"functional_units": [{unit % "mix"}]}}')
    (folder / "2.json").write_text(f"[{unit % 'cut'}, {unit % 'mix'}]")
    (folder / "3.txt").write_text(MIX)
    (folder / "settings.json").write_text('{"colour": "blue"}')
    files = find_data(folder)
    assert files.network == (folder / "1.json", folder / "2.json", folder / "3.txt")
    network = read_data(files).network
    assert network.motions == ("mix", "cut")
    assert [[Path(s.file).name for s in copies] for copies in network.sources] == [
        ["1.json", "2.json", "3.txt"],
        ["2.json"],
    ]


def test_foon_txt_is_the_network_or_else_all_texts_but_the_tables(folder: Path) -> None:
    (folder / "b.txt").write_text(CUT)
    (folder / "notes.md").write_text("not a network\n")
    (folder / "my rates.txt").write_text("mix\t0.9\n")
    assert find_data(folder).network == (folder / "FOON.txt",)
    (folder / "FOON.txt").rename(folder / "z.txt")
    given = find_data(folder, rates=folder / "my rates.txt")
    assert given.network == (folder / "b.txt", folder / "z.txt")


def test_pieces_given_on_their_own_replace_those_of_the_folder(folder: Path, tmp_path: Path) -> None:
    paths = [tmp_path / name for name in ("n.txt", "k.json", "r.txt", "u.txt", "g.json")]
    for path in paths:
        path.touch()
    network, kitchen, rates, utensils, goals = paths
    whole = find_data(folder)
    assert find_data(folder, [network]) == whole._replace(network=(network,))
    assert find_data(folder, kitchen=kitchen) == whole._replace(kitchen=kitchen)
    assert find_data(folder, rates=rates) == whole._replace(rates=rates)
    assert find_data(folder, utensils=utensils) == whole._replace(utensils=utensils)
    assert find_data(folder, goals=goals) == whole._replace(goals=goals)
    assert find_data(None, [network], goals=goals) == DataFiles((network,), goals=goals)


def test_networks_are_files_and_folders_in_the_order_given(folder: Path, tmp_path: Path) -> None:
    more = tmp_path / "more"
    more.mkdir()
    for name in ("2.txt", "1.txt", "motion.txt"):
        (more / name).write_text(MIX)
    alone = tmp_path / "alone.foon"
    alone.write_text(MIX)
    assert find_data(None, [alone, more, folder]).network == (
        alone,
        more / "1.txt",
        more / "2.txt",
        folder / "FOON.txt",
    )


@pytest.mark.parametrize("given", ["folder", "kitchen", "rates", "utensils", "goals", "network"])
def test_what_is_named_and_not_there_is_an_error(folder: Path, given: str) -> None:
    missing = folder / "nothing.txt"

    def named(piece: str) -> Path | None:
        return missing if piece == given else None

    with pytest.raises(UserError) as caught:
        find_data(
            named("folder") or folder,
            [missing] if given == "network" else [],
            named("kitchen"),
            named("rates"),
            named("utensils"),
            named("goals"),
        )
    assert str(caught.value) == f"{missing}: no such file or folder"


def test_a_folder_without_networks_is_an_error(folder: Path) -> None:
    (folder / "FOON.txt").unlink()
    with pytest.raises(UserError, match="found none") as caught:
        find_data(folder)
    assert str(folder) in str(caught.value)
    assert "FOON.txt" in str(caught.value)


def test_no_network_at_all_is_an_error(tmp_path: Path) -> None:
    kitchen = tmp_path / "mine.txt"
    kitchen.write_text("O\tice\n")
    with pytest.raises(UserError, match="no network: name a recipe"):
        find_data(tmp_path, kitchen=kitchen)


def test_without_a_network_it_is_the_bundled_kitchen(folder: Path) -> None:
    kitchen = folder / "kitchen.json"
    assert find_data(None, kitchen=kitchen) == find_data(bundled_kitchen())._replace(kitchen=kitchen)


# --- reading


def test_all_pieces_are_read(folder: Path) -> None:
    data = read_data(find_data(folder))
    assert data.network.motions == ("mix", "cut")
    assert [str(node) for node in data.network.objects] == ["a", "b", "a; cut; in [bowl]"]
    assert data.kitchen == {0}
    assert [entry.pattern.label for entry in data.goals] == [
        "b",
        "nothing",
    ]  # goals are matched when asked for
    assert data.goals[1].source == Source(str(folder / "goal_nodes.json"), 2, 2)
    assert data.rates == {"mix": Fraction(9, 10), "cut": Fraction(1)}
    assert data.utensils == {"bowl", "knife"}
    assert data.warnings == ()
    assert data.left_out == 0


def test_what_is_not_there_is_empty_and_rates_are_none(tmp_path: Path) -> None:
    (tmp_path / "n.txt").write_text(MIX)
    data = read_data(find_data(None, [tmp_path / "n.txt"]))
    assert (len(data.network), data.kitchen) == (1, starting_nodes(data.network))
    assert (data.rates, data.utensils, data.unit_prices, data.warnings) == (None, frozenset(), None, ())
    (tmp_path / "motion.txt").touch()
    assert read_data(find_data(tmp_path)).rates == {}


def test_a_kitchen_item_may_stand_for_several_nodes(folder: Path) -> None:
    (folder / "FOON.txt").write_text("O\ta\nS\tin\t[p]\nO\ta\nS\ton\t[p]\nO\ta\nM\tmix\nO\tb\n//\n")
    (folder / "kitchen.json").write_text(
        '[{"label": "a", "container": "p"}, {"label": "a", "container": "p"}]'
    )
    data = read_data(find_data(folder))
    assert data.kitchen == {0, 1}
    assert data.warnings == ()


def test_a_kitchen_item_that_matches_nothing_is_a_warning_and_nothing_else(folder: Path) -> None:
    (folder / "kitchen.json").write_text(
        '[{"label": "b"},\n {"label": "a", "container": "jar"}, {"label": "a"},\n'
        '  {"label": "b", "states": ["raw"], "ingredients": ["x"]}]'
    )
    data = read_data(find_data(folder))
    assert data.kitchen == {0, 1}
    assert data.left_out == 0
    file = str(folder / "kitchen.json")
    assert [(w.severity, w.code, w.source) for w in data.warnings] == [
        (Severity.WARNING, "kitchen-item", Source(file, 2, 2)),
        (Severity.WARNING, "kitchen-item", Source(file, 3, 3)),
    ]
    assert "'a; container [jar]' matches no object node" in data.warnings[0].message
    assert "'b; raw; contains {x}' matches no object node" in data.warnings[1].message


def test_warnings_of_the_network_come_first_and_are_counted(folder: Path) -> None:
    (folder / "FOON.txt").write_text("O\ta\t7\nM\tmix\nO\tb\nx\ny\n//\n")
    (folder / "kitchen.json").write_text('[{"label": "c"}]')
    data = read_data(find_data(folder), lenient=True)
    assert [(w.code, w.source.line) for w in data.warnings] == [
        ("motion-flag", 1),
        ("syntax", 4),
        ("syntax", 5),
        ("kitchen-item", 1),
    ]
    assert {w.severity for w in data.warnings} == {Severity.WARNING}
    assert data.left_out == 2
    assert len(data.network) == 1
    with pytest.raises(InputError) as caught:
        read_data(find_data(folder))
    assert [d.source.line for d in caught.value.diagnostics] == [4, 5]


@pytest.mark.parametrize(
    ("name", "text", "place"),
    [
        ("FOON.txt", MIX + "x\n", "5:1"),
        ("kitchen.json", '[{"label": "a"},\n7]', "2:1"),
        ("goal_nodes.json", "{}", "1:1"),
        ("motion.txt", "mix\t0.5\nmix 0.5\n", "2:8"),
    ],
)
def test_an_error_in_any_piece_is_located(folder: Path, name: str, text: str, place: str) -> None:
    (folder / name).write_text(text)
    with pytest.raises(InputError) as caught:
        read_data(find_data(folder))
    assert f"{folder / name}:{place}: error: " in str(caught.value)


# --- lists of labels


def test_labels_stand_one_on_each_line(tmp_path: Path) -> None:
    file = tmp_path / "utensils.txt"
    file.write_text(
        "\N{BYTE ORDER MARK}bowl\r\n# tools\n\n  cutting board \r\t\nbowl\rwok 中", "utf-8", newline=""
    )
    assert read_utensils(file) == {"bowl", "cutting board", "wok 中"}
    file.write_text("")
    assert read_utensils(file) == frozenset()
