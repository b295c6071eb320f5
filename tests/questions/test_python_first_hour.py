"""What somebody in a notebook tries first."""

import gc
import importlib.util
import sys
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import foon_asp
from foon_asp import Cancel, Foon, StoppedError, UserError
from foon_asp.errors import FoonWarning

ENDLESS = "p(0). p(f(X)) :- p(X). :- use(U), p(f(U))."
LATE = 2.5  # seconds, on a busy machine; alone it is less than one
UNITS: list[Any] = [
    ("boil", "water; cold", ["water; hot"]),
    {"motion": "pour", "inputs": ["water; hot", "tea bag"], "outputs": ["tea; hot", "tea bag; wet"]},
]


def installed(package: str) -> pytest.MarkDecorator:
    missing = importlib.util.find_spec(package) is None
    return pytest.mark.skipif(missing, reason=f"{package} is not installed")


@pytest.fixture(scope="module")
def foon() -> Foon:
    return foon_asp.load()


def test_a_network_of_plain_values() -> None:
    tea = foon_asp.build(UNITS, kitchen=["water; cold", "tea bag;"], goals="tea", rates={"boil": 0.9})
    answer = foon_asp.solve(tea.problem())
    assert answer.costs is not None
    assert (answer.costs.units, answer.costs.success) == (2, None)
    with pytest.raises(UserError, match="the motion 'pour' has no success rate"):
        foon_asp.solve(tea.problem(), "success")
    assert foon_asp.solve(tea.vary(rates={"pour": "0.5", "boil": 1}).problem(), "success")
    with pytest.warns(FoonWarning, match="No kitchen given"):
        alone = foon_asp.build(UNITS)
    assert [str(node) for node in alone.kitchen] == ["water; cold", "tea bag"]
    assert [str(node) for node in alone.goals] == ["tea; hot", "tea bag; wet"]
    assert not foon_asp.solve(foon_asp.build(UNITS, kitchen=(), goals="tea").problem())
    assert [unit.motion for unit in tea.network] == ["boil", "pour"]
    assert list(tea.network) == list(foon_asp.build(tea.network, kitchen="@starting").network)


def test_other_rates_and_prices_do_not_hide_that_the_kitchen_is_assumed() -> None:
    with pytest.warns(FoonWarning, match="No kitchen given"):
        foon = foon_asp.build([("boil", "water; cold", "water; hot")], rates={"boil": 0.5})
    varied = foon.vary(rates={"boil": 0.9}, unit_prices={"boil": 2})
    assert any("No kitchen given" in warning for warning in varied.warnings)
    assert not foon.vary(kitchen=["water; cold"]).warnings


@pytest.mark.parametrize(
    ("units", "message"),
    [
        (["pour"], "found the unit 'pour'; a unit is its motion, its inputs and its outputs"),
        ("pour", "found units='pour', expected several units"),
        ([(3, "water", "tea")], "found the motion 3 of unit 1, expected a name; a unit is"),
        ([("pour", 3, "tea")], "found 3 in unit 1, expected object nodes"),
        ([("pour", [3], "tea")], "found 3 in unit 1, expected an object node"),
        ([("pour", "water; in [", "tea")], "of unit 1 cannot be read: at column"),
    ],
)
def test_what_is_no_unit_is_refused(units: Any, message: str) -> None:
    with pytest.raises(UserError, match=message):
        foon_asp.build(units)


face: Any = foon_asp  # for what type checkers refuse


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (
            lambda f, p: face.solve("macaroni"),
            r"no such file or folder: macaroni \(a goal of",
        ),
        (lambda f, p: face.alternatives(p, best=2.5), r"found best=2.5, expected a whole number"),
        (lambda f, p: face.alternatives(p, best=True), r"found best=True, expected a whole number"),
        (lambda f, p: face.stats(f, unit=["pour"]), r"found unit=\['pour'\], expected several such as"),
        (lambda f, p: face.solve(p, cancel=3), r"expected a token: foon_asp.Cancel\(\)"),
        (lambda f, p: face.diff(p, p), "expected Answer or a tree"),
    ],
)
def test_a_value_of_the_wrong_type_is_refused_in_words(
    foon: Foon, ask: Callable[[Any, Any], object], message: str
) -> None:
    with pytest.raises(UserError, match=message):
        ask(foon, foon.problem("ice"))


def test_equal_questions_are_equal(foon: Foon) -> None:
    problem = foon.problem("ice")
    others = [
        foon.problem("tea"),
        foon.problem("ice", containers="implied"),
        problem.vary(without="knife"),
        problem.vary(rates={"crush": "0.5"}),
        problem.vary(unit_prices={"crush": 1}),
        problem.vary(measures="cost(effort,U,5) :- unit(U)."),
        replace(problem, own_rates={0: problem.rate(0)}),
        replace(problem, network=problem.network.without([0])),
        foon.problem("ice", items="used-up"),
    ]
    assert len({problem, foon_asp.load().problem("ice"), *others}) == 1 + len(others)
    assert problem != "ice"
    assert problem.vary(without="knife") == foon.vary(without="knife").problem("ice")


def test_an_answer_is_true_where_there_is_a_tree(foon: Foon) -> None:
    assert foon_asp.solve(foon.problem("ice"))
    assert not foon_asp.solve(foon.problem("apple pie"))


def test_progress_is_told(foon: Foon) -> None:
    heard: list[foon_asp.Progress] = []
    foon_asp.solve(foon.problem("macaroni"), "success", on_progress=heard.append)
    assert heard[-1].costs == foon_asp.solve(foon.problem("macaroni"), "success").costs
    heard.clear()
    foon_asp.compare(foon.problem("ice", "tea"), ["bfs"], on_progress=heard.append)
    assert (heard[0].done, heard[-1].done, heard[-1].total) == (0, 2, 2)


def test_reading_and_building_tell_how_far_they_are(tmp_path: Path) -> None:
    file = tmp_path / "many.txt"
    file.write_text("".join(f"O\twater {n}\r\nM\tpour\r\nO\tcup {n}\r\n//\r\n" for n in range(5_000)))
    heard: list[foon_asp.Progress] = []
    foon_asp.load(file, kitchen="@starting", on_progress=heard.append)
    done = [each.done for each in heard]
    assert len(done) > 2
    assert done == sorted(set(done))
    assert {each.total for each in heard} == {done[-1]} == {file.stat().st_size}
    heard.clear()
    foon_asp.build((("pour", "water", f"cup {n}") for n in range(250)), kitchen=(), on_progress=heard.append)
    assert [(each.done, each.total) for each in heard] == [(100, 0), (200, 0), (250, 0)]


def ended_by(token: Cancel, ask: Callable[[], object], after: float = 0.7) -> tuple[object, float]:
    """Ask in another thread, cancel, and give what came of it and how many seconds that took."""
    found: list[object] = []

    def run() -> None:
        try:
            found.append(ask())
        except StoppedError as error:
            found.append(error)

    thread = threading.Thread(target=run)
    thread.start()
    time.sleep(after)
    assert thread.is_alive()
    began = time.monotonic()
    token.cancel()
    thread.join(10)
    assert not thread.is_alive()
    return found[0], time.monotonic() - began


def test_a_token_ends_grounding_that_has_no_end(foon: Foon) -> None:
    token, problem = Cancel(), foon.problem("ice")
    answer, seconds = ended_by(token, lambda: foon_asp.solve(problem, constraints=ENDLESS, cancel=token))
    assert seconds < LATE
    assert isinstance(answer, foon_asp.Answer)
    assert str(answer.stopped) == "a cancel while grounding"
    with pytest.raises(StoppedError, match="cancelled"):
        foon_asp.why_not(problem, cancel=token)
    assert foon_asp.solve(problem)  # others go on


@pytest.mark.slow
def test_a_token_ends_reading(foon: Foon) -> None:
    done = Cancel()
    done.cancel()
    with pytest.raises(StoppedError, match="cancelled"):
        foon_asp.to_unified_planning(foon.problem("ice"), cancel=done)

    def endless() -> Iterator[tuple[str, str, str]]:
        while True:  # makes no garbage, and so nothing that would be interrupted while it is collected
            time.sleep(0.001)
            yield "boil", "water; cold", "water; hot"

    gc.collect()
    token = Cancel()
    stopped, seconds = ended_by(token, lambda: foon_asp.build(endless(), cancel=token))
    assert (type(stopped), seconds < LATE) == (StoppedError, True)
    with pytest.raises(StoppedError, match=r"the time limit of 0\.1 s"):
        foon_asp.build(endless(), time_limit=0.1)


@installed("pandas")
def test_results_as_data_frames(foon: Foon) -> None:
    problem = foon.problem("macaroni")
    units = foon_asp.solve(problem).to_frame()
    assert units["motion"][0] == "open"
    assert units["inputs"][0] == ["macaroni box; sealed"]
    assert list(foon_asp.pareto(problem).to_frame()["costs.units"]) == [9, 10, 11]
    assert list(foon_asp.compare(problem, ["bfs", "ids"]).to_frame()["search"]) == ["bfs", "ids"]
    assert len(foon_asp.check(problem, ()).to_frame()) == 1


def test_without_pandas_or_networkx_that_is_said(foon: Foon, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    monkeypatch.setitem(sys.modules, "networkx", None)
    with pytest.raises(UserError, match="a data frame needs pandas: pip install"):
        foon_asp.solve(foon.problem("ice")).to_frame()
    with pytest.raises(ImportError, match="a graph needs networkx: pip install"):
        foon.network.to_networkx()


@installed("networkx")
def test_a_network_as_a_graph(foon: Foon) -> None:
    network, unit = foon.network, foon.network.unit(3)
    graph = network.to_networkx()
    assert len(graph) == len(network) + len(network.objects)
    assert {*graph.predecessors(("unit", 3))} == {*unit.inputs}
    assert {*graph.successors(("unit", 3))} == {*unit.outputs}
    assert graph.nodes["unit", 3]["motion"] == unit.motion
    assert graph.nodes[unit.inputs[0]]["label"] == unit.inputs[0].label
