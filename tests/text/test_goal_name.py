"""Naming a goal: the goals file, a label, the notation, and candidates that can be pasted."""

import shlex
from pathlib import Path

import pytest

from foon_asp.errors import UserError
from foon_asp.network import Network, NetworkBuilder, NodePattern, ObjectNode, Source
from foon_asp.text.node_lookup import entry_names, find_goal
from foon_asp.text.object_list import ListedObject
from foon_asp.text.reader import FoonReader


def network_of(*nodes: ObjectNode) -> Network:
    """Build a network of one unit with those nodes, which then are numbered from 0."""
    builder = NetworkBuilder()
    builder.add("mix", nodes, [], Source("f.txt", 1))
    return builder.build()


def entry(pattern: NodePattern, line: int = 1) -> ListedObject:
    return ListedObject(pattern, Source("goal_nodes.json", line, 2))


def pasted(message: str) -> list[str]:
    """Give the names behind ``--goal`` as a shell would hand them over."""
    lines = [line for line in message.split("\n") if line.startswith("  --goal ")]
    words = [shlex.split(line) for line in lines]
    assert all(len(found) == 2 for found in words)
    return [found[1] for found in words]


def refused(name: str, network: Network, listed: list[ListedObject] | None = None) -> str:
    with pytest.raises(UserError) as caught:
        find_goal(name, network, listed or [])
    return str(caught.value)


SALT = ObjectNode.of("salt")
MILK = ObjectNode.of("milk")
HOT_MILK = ObjectNode.of("milk", ["hot"])
MILK_IN_POT = ObjectNode.of("milk", [], [("in", "pot")])
MILK_ON_POT = ObjectNode.of("milk", [], [("on", "pot")])
POT = ObjectNode.of("pot", ["hot"], [("on", "stove")], [("contains", ["milk", "salt"])])
NETWORK = network_of(SALT, MILK, HOT_MILK, MILK_IN_POT, MILK_ON_POT, POT)
WITHOUT_BARE_MILK = network_of(SALT, HOT_MILK, MILK_IN_POT, MILK_ON_POT)


# --- found


@pytest.mark.parametrize(
    ("name", "node"),
    [
        ("salt;", 0),
        ("  pot ", 5),
        ("milk;", 1),
        ("milk; hot", 2),
        ("milk; in [pot]", 3),
        ("milk; on [pot]", 4),
        ("pot; hot; on [stove]; contains {milk,salt}", 5),
        ("pot;contains {salt, milk};on [stove];hot", 5),
    ],
)
def test_a_label_of_one_node_or_the_notation_names_a_node(name: str, node: int) -> None:
    assert find_goal(name, NETWORK) == node


def test_the_node_comes_first_then_the_goals_file_then_the_label() -> None:
    hot = NodePattern("milk", frozenset({"hot"}))
    listed = [entry(hot), entry(NodePattern("cake")), entry(hot, 2)]
    assert find_goal("milk", NETWORK, listed) == find_goal("milk;", NETWORK, listed) == 1
    assert find_goal("milk", WITHOUT_BARE_MILK, listed) == 1  # the hot one
    assert find_goal("salt", NETWORK, listed) == 0


def test_an_entry_is_offered_by_a_name_that_means_it() -> None:
    listed = [entry(NodePattern("milk", frozenset({"hot"}))), entry(NodePattern("pot", POT.states))]
    assert [*entry_names(listed, NETWORK)] == ["milk; hot", "pot"]
    assert [*entry_names(listed, WITHOUT_BARE_MILK)] == ["milk", "pot"]


# --- ambiguous


def test_a_label_of_several_nodes_lists_them_ready_to_paste() -> None:
    network = network_of(SALT, HOT_MILK, MILK_IN_POT, MILK_ON_POT)
    message = refused("milk", network)
    assert message.startswith("the goal 'milk' means 3 object nodes; paste the one you mean\n")
    assert [find_goal(name, network) for name in pasted(message)] == [1, 2, 3]


def test_a_node_that_is_only_a_label_comes_before_others_with_that_label() -> None:
    """The text of a node always finds that node again."""
    assert [find_goal(str(node), NETWORK) for node in NETWORK.objects] == [0, 1, 2, 3, 4, 5]


def test_an_entry_of_several_nodes_lists_them_ready_to_paste() -> None:
    listed = [entry(NodePattern("milk", container="pot"))]
    message = refused("milk", WITHOUT_BARE_MILK, listed)
    assert "means 2 object nodes" in message
    assert [find_goal(name, WITHOUT_BARE_MILK, listed) for name in pasted(message)] == [2, 3]


def test_very_many_candidates_are_counted() -> None:
    network = network_of(*(ObjectNode.of("milk", [f"{n:02}"]) for n in range(15)))
    message = refused("milk", network)
    assert "means 15 object nodes" in message
    assert [find_goal(name, network) for name in pasted(message)] == list(range(12))
    assert message.split("\n")[-1].strip() == "... and 3 more"


@pytest.mark.parametrize("label", ["baker's yeast", 'so-called "milk"', "$HOME `x` !! \\", "-v", "#1"])
def test_a_candidate_survives_the_shell(label: str) -> None:
    network = network_of(
        ObjectNode.of(label, ["on"]), ObjectNode.of(label, ["off (ready)"], [("in", "a & b")])
    )
    assert [find_goal(name, network) for name in pasted(refused(label, network))] == [0, 1]


def test_a_node_with_a_semicolon_in_its_label_can_be_named(tmp_path: Path) -> None:
    file = tmp_path / "f.txt"
    file.write_text("O\tsalt;pepper\nO\tsalt\nM\tmix\nO\tsalt;pepper\nS\tmixed\n//\n")
    network = FoonReader().read_network([file])
    names = ["salt;pepper", '"salt;pepper"', '"salt;pepper"; mixed']
    assert [find_goal(name, network) for name in names] == [0, 0, 2]
    assert [str(network.node(o)) for o in (0, 2)] == names[1:]


# --- unknown


def test_an_unknown_label_lists_near_ones_ready_to_paste() -> None:
    message = refused("mlik", NETWORK)
    assert message.startswith("no object node has the label 'mlik'; similar are\n")
    assert [find_goal(name, NETWORK) for name in pasted(message)] == [1, 2, 3, 4]


def test_a_label_like_no_other_is_only_unknown() -> None:
    assert refused("xyzzy", NETWORK) == "no object node has the label 'xyzzy'"


def test_of_several_near_labels_each_has_some_of_its_nodes_shown() -> None:
    network = network_of(*(ObjectNode.of(label, [f"{n:02}"]) for label in ("milk", "Milk") for n in range(9)))
    message = refused("mlk", network)
    assert [find_goal(name, network) % 9 for name in pasted(message)] == [*range(6), *range(6)]
    assert message.endswith("... and 6 more")


@pytest.mark.parametrize("name", ["milk; cold", "milk; hot; in [pot]", "milk; contains {salt}"])
def test_the_notation_of_no_node_lists_those_with_its_label(name: str) -> None:
    message = refused(name, NETWORK)
    assert message.startswith(f"no object node is exactly {name!r}; with that label there are\n")
    assert sorted(find_goal(candidate, NETWORK) for candidate in pasted(message)) == [1, 2, 3, 4]


@pytest.mark.parametrize(
    ("slip", "wanted"),
    [
        ("milk; hit", "milk; hot"),
        ("milk; in [pots]", "milk; in [pot]"),
        ("milk; on [pots]", "milk; on [pot]"),
        ("mlik; hot", "milk; hot"),
        ("mlik; on [pot]", "milk; on [pot]"),
    ],
)
def test_the_nearest_of_a_misspelt_notation_comes_first(slip: str, wanted: str) -> None:
    assert pasted(refused(slip, NETWORK))[0] == wanted


# --- unreadable


@pytest.mark.parametrize(
    ("name", "column"),
    [("", 1), (" ", 1), (";", 1), ("milk;;", 6), ("milk; in [pot", 10), ("milk in [pot]", 9)],
)
def test_a_name_that_cannot_be_read_says_where(name: str, column: int) -> None:
    assert refused(name, NETWORK).startswith(f"the goal {name!r} cannot be read: at column {column}, found ")


# --- entries of a goals file


def test_an_entry_for_no_node_is_located_and_lists_those_with_its_label() -> None:
    listed = [entry(NodePattern("milk", container="jar"), 7)]
    message = refused("milk", WITHOUT_BARE_MILK, listed)
    assert message.startswith(
        "goal_nodes.json:7:2: error: the goal 'milk; container [jar]' matches no object node; "
        "with that label there are\n"
    )
    assert [find_goal(name, WITHOUT_BARE_MILK) for name in pasted(message)] == [1, 2, 3]


def test_an_entry_with_a_label_of_no_node_is_located() -> None:
    assert refused("cake", NETWORK, [entry(NodePattern("cake"), 7)]) == (
        "goal_nodes.json:7:2: error: the goal 'cake' matches no object node of the network"
    )
