"""A question as plain arrays, and what its goals can come from: small cases."""

from dataclasses import replace

import pytest

from foon_asp.network import NetworkBuilder, ObjectNode, Source
from foon_asp.problem import ContainerRule, Objective, Problem, levels
from foon_asp.reduce.graph import graph_of
from tests.plain_graphs import plain


def boiling() -> Problem:
    """Ask for tea and for the water at hand, which can be drawn as well, and for tea once more."""
    builder = NetworkBuilder()
    tap, water, leaves, tea = (ObjectNode.of(name) for name in ("tap", "water", "leaves", "tea"))
    builder.add("draw", [tap], [water, tap], Source("graph", 1))
    builder.add("boil", [water, leaves], [tea, water], Source("graph", 2))
    network = builder.build()
    # objects by number: tap, water, leaves, tea
    assert [node.label for node in network.objects] == ["tap", "water", "leaves", "tea"]
    return Problem(network, frozenset({1, 2}), (3, 1, 3), None, frozenset(), ContainerRule.STRICT)


def test_a_question_is_the_network_as_it_is() -> None:
    problem = boiling()
    graph = graph_of(problem, levels((Objective.INPUTS,)))
    assert (graph.units, graph.size, graph.goals, graph.start) == (2, 4, (3,), frozenset({1, 2}))
    assert [sorted(need) for need in graph.needs] == [[0], [1, 2]]
    assert [sorted(give) for give in graph.gives] == [[0, 1], [1, 3]]
    assert graph.needs is problem.needs
    assert graph.gives is problem.gives
    assert graph.makers is problem.makers


@pytest.mark.parametrize("objectives", [(Objective.KITCHEN,), (Objective.INPUTS, Objective.KITCHEN)])
def test_where_items_are_counted_to_take_one_is_an_action(objectives: tuple[Objective, ...]) -> None:
    graph = graph_of(boiling(), levels(objectives))
    assert (graph.units, graph.size, graph.goals, graph.start) == (2, 4, (3,), frozenset())
    assert [sorted(need) for need in graph.needs] == [[0], [1, 2], [], [], [], []]
    assert [sorted(give) for give in graph.gives] == [[0], [3], [0], [1], [2], [3]]
    assert [list(makers) for makers in graph.makers] == [[0], [3], [4], [1]]


def test_the_goals_can_come_from_what_leads_to_them() -> None:
    # 2 is there, and 5 leads nowhere; 1 comes of 2 and 3, which comes of 4 and of 1
    graph = plain([([2, 3], [1]), ([4], [3]), ([1], [3]), ([6], [2]), ([1], [5]), ([2], [1])], [1], [2])
    actions, wanted = graph.cone()
    assert (sorted(actions), wanted) == ([0, 1, 2, 5], {1, 3, 4})
    actions, wanted = graph.cone({0, 2, 3, 4})
    assert (sorted(actions), wanted) == ([0, 2], {1, 3})
    actions, wanted = graph.cone(())
    assert (actions, wanted) == (set(), {1})


def test_what_makes_things_that_are_there_is_not_looked_at() -> None:
    graph = plain([([2, 3], [1]), ([4], [2]), ([2], [3])], [1], [2])
    known = replace(graph, known_makers=[(), (0,), (1,), (2,), ()])
    actions, wanted = known.cone()
    assert (sorted(actions), wanted) == ([0, 2], {1, 3})


def test_each_object_is_looked_at_once() -> None:
    # 2 is needed by both makers of 1, and by what makes it
    asked: list[int] = []

    class Allowed(set[int]):
        def __contains__(self, action: object) -> bool:
            assert isinstance(action, int)
            asked.append(action)
            return action < 9

    graph = plain([([2], [1]), ([2], [1]), ([2], [2])], [1])
    assert sorted(graph.cone(Allowed())[0]) == [0, 1, 2]
    assert sorted(asked) == [0, 1, 2]
