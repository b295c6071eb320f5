"""Pages for a browser, without a browser: one file that is whole in itself, whatever names the data have."""

import base64
import hashlib
import html
import json
import re
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest

import foon_asp
from foon_asp import UserError
from foon_asp.json_layout import json_text
from foon_asp.network import ObjectNode
from foon_asp.pictures.page import WEB
from foon_asp.problem import reach
from foon_asp.results.plain_values import plain
from foon_asp.results.proof_cases import ProofCases
from foon_asp.searches import find_searches
from tests.conftest import Cli, valid
from tests.questions.recipes import posed

EVIL = "</script><img src=x onerror=alert(1)>\u202e"


class Parts(HTMLParser):
    """Collects the tags of a page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))


def strange(name: str) -> foon_asp.Problem:
    """Pose a problem whose motion and product have a strange name."""
    unit = foon_asp.FunctionalUnit.of(name, [ObjectNode.of("flour")], [ObjectNode.of(name)])
    return foon_asp.build([unit], kitchen="flour").problem(ObjectNode.of(name))


def in_page(page: str) -> Any:
    """Give the data of a page."""
    (found,) = re.findall(r'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)
    return valid(json.loads(found))


@pytest.fixture(scope="module")
def page() -> str:
    return foon_asp.view(foon_asp.load().problem("macaroni")).html()


def test_the_page_has_the_answer_as_it_is(page: str, tmp_path: Path) -> None:
    problem = foon_asp.load().problem("macaroni")
    shown, ours = in_page(page), foon_asp.solve(problem, certificate=tmp_path / "proof.json").json()
    assert {**shown["answer"], "seconds": 0} == {**ours, "seconds": 0}
    trees = [ours, *shown["searches"]]
    assert {rate["unit"] for rate in shown["rates"]} == {
        unit["id"] for tree in trees for unit in tree["units"]
    }


def test_the_policy_allows_what_is_in_the_page_and_nothing_else(page: str) -> None:
    (policy,) = [attrs["content"] for _, attrs in Parts(page).tags if "http-equiv" in attrs]
    rules = dict(rule.strip().split(" ", 1) for rule in (policy or "").split(";"))
    assert rules.keys() == {"default-src", "script-src", "style-src", "base-uri", "form-action"}
    assert {rules[name] for name in ("default-src", "base-uri", "form-action")} == {"'none'"}
    for name, tag in (("script-src", "script"), ("style-src", "style")):
        found = re.findall(rf"<{tag}(?: id=\"\w+\")?>(.*?)</{tag}>", page, re.DOTALL)
        digests = [base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() for text in found]
        assert rules[name] == " ".join(f"'sha256-{digest}'" for digest in digests)
        assert found


def test_nothing_is_asked_of_any_other_place(page: str) -> None:
    for tag, attributes in Parts(page).tags:
        assert tag not in {"link", "img", "iframe", "object", "embed", "base", "form"}
        assert not {"src", "href", "srcset", "action", "style"} & attributes.keys(), tag
        assert not [name for name in attributes if name.startswith("on")]
    for file in sorted(WEB.iterdir()):
        text = file.read_text(encoding="utf-8")
        assert not re.search(r"https?://(?!www\.w3\.org/2000/svg)", text), file.name
        calls = "innerHTML|outerHTML|insertAdjacentHTML|document\\.write|eval|Function|fetch|XMLHttpRequest"
        assert not re.search(rf"\b({calls})\b", text), file.name
        assert not re.search(r"url\(|@import|importScripts|setAttribute\(\"style", text), file.name


def test_names_of_strangers_are_text() -> None:
    page = foon_asp.view(foon_asp.solve(strange(EVIL))).html()
    assert "img" not in {tag for tag, _ in Parts(page).tags}
    assert page.count("</script>") == 2
    assert "\u202e" not in page.partition('id="data">')[0]
    assert in_page(page)["answer"]["units"][0]["motion"] == EVIL


def test_a_page_without_scripts_has_the_steps_in_words(page: str) -> None:
    (text,) = re.findall(r"<noscript><pre>(.*?)</pre></noscript>", page, re.DOTALL)
    said = html.unescape(text)
    assert "optimal by units" in said
    assert "  9  tilt" in said


def test_a_page_is_written_and_read(cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "ice.html"
    ran = cli("view", "--goal", "ice", "-o", file)
    assert (ran.code, ran.out, ran.err) == (0, "", f"wrote {file}\n")
    shown = cli("view", "--goal", "ice", "--format", "json").json
    written = in_page(file.read_text(encoding="utf-8"))
    assert {**written["answer"], "seconds": 0} == {**shown["answer"], "seconds": 0}
    assert "end it in .html" in cli("view", "--goal", "ice", "-o", tmp_path / "ice.gif").err
    with pytest.raises(UserError, match="expected one of html, json"):
        foon_asp.view(foon_asp.load().problem("ice")).write(file, "gif")


def test_what_stands_beside_the_tree_is_what_its_questions_answer(tmp_path: Path) -> None:
    problem = foon_asp.load().problem("ice")
    shown = in_page(foon_asp.view(problem, beside=["alternatives", "searches", "proof", "front"]).html())
    assert [each["search"] for each in shown["searches"]] == list(find_searches())
    assert shown["searches"][0] == foon_asp.search(problem, "bfs").json()
    assert shown["alternatives"] == foon_asp.alternatives(problem, best=5).json()
    assert shown["front"]["points"] == foon_asp.pareto(problem).json()["points"]
    certificate = foon_asp.solve(problem, certificate=tmp_path / "proof.json").certificate
    assert certificate is not None
    assert shown["proof"]["certificate"] == certificate.content
    assert shown["why_not"] is shown["shopping_list"] is shown["without_rules"] is None
    with pytest.raises(UserError, match="expected one of searches, proof, alternatives, front"):
        foon_asp.view(problem, beside=["everything"])


def test_without_a_tree_the_page_says_why() -> None:
    problem = foon_asp.load().problem("apple pie")
    shown = in_page(foon_asp.view(problem).html())
    assert shown["why_not"] == foon_asp.why_not(problem).json()
    assert shown["shopping_list"]["lists"] == foon_asp.shopping_list(problem).json()["lists"]
    (case,) = shown["proof"]["cases"]
    assert (case["ends"], case["cuts"][0]["weight"], case["cuts"][0]["members"]) == ("hopeless", None, [])


def test_what_is_too_dear_is_a_case_and_left_out_of_those_after_it(tmp_path: Path) -> None:
    """A certificate of three cases: with pouring; without it and the dear mixing; and without both."""
    units = [("pour", "start", "end"), ("mix", "start", "middle"), ("bake", "middle", "end")]
    problem = foon_asp.build(units, kitchen="start", goals="end").problem()
    end, middle = (problem.network.objects.index(ObjectNode.of(label)) for label in ("end", "middle"))
    certificate = foon_asp.solve(problem, certificate=tmp_path / "proof.json").certificate
    assert certificate is not None
    dear = {"dear": [{"unit": 1}], "weights": [[0, ["1"]]], "others": {"hopeless": 1}}
    proof = {"branch": {"unit": 0}, "without": dear, "using": {"weights": []}}
    content = {**certificate.content, "cuts": [[end], sorted([end, middle])], "proof": proof}
    cases = json.loads(json_text(plain(ProofCases.of(problem, content))))["cases"]
    taken, gone, mixed = (
        {"kind": "unit", "id": unit, "taken": taken} for unit, taken in ((0, True), (0, False), (1, False))
    )
    assert [case["given"] for case in cases] == [[taken], [gone], [gone, mixed]]
    assert [case["dear"] for case in cases] == [[], [{"kind": "unit", "id": 1}], []]
    assert [case["ends"] for case in cases] == ["weights", "weights", "hopeless"]
    assert cases[1]["cuts"] == [{"nodes": [end], "weight": 1.0, "members": [2]}]


def test_weights_of_the_proof_add_up_to_the_cost() -> None:
    problem = foon_asp.load().problem("tea")
    proof = in_page(foon_asp.view(problem, "success", beside=["proof"]).html())["proof"]
    for case in proof["cases"]:
        bound = case["paid"] + sum(cut["weight"] for cut in case["cuts"])
        assert bound >= proof["cost"] * (1 - 1e-12)
        for cut in case["cuts"]:
            assert set(cut["members"]) & set(proof["certificate"]["tree"])


def test_a_page_needs_no_rates() -> None:
    tea = foon_asp.build([("boil", "water; cold", "water; hot")], kitchen=["water; cold"], goals="water; hot")
    shown = in_page(foon_asp.view(tea.problem(), beside=["searches", "front"]).html())
    assert [each["search"] for each in shown["searches"]] == ["bfs", "dfs", "ids", "greedy-inputs"]
    assert shown["front"]["objectives"] == ["units", "inputs"]
    two = in_page(foon_asp.view(tea.problem(), ["inputs", "kitchen"], beside=["front"]).html())
    assert two["front"]["objectives"] == ["inputs", "kitchen"]


def one_egg(stock: int, cooks: bool = True) -> foon_asp.Problem:
    """Pose a plan that needs an egg twice, where a hen lays as many as are wanted, or none."""
    units = ["egg > omelet", "egg > egg; boiled", "omelet + egg; boiled > meal", "hen > egg"]
    copies = {foon_asp.parse_node("egg"): stock}
    kitchen = "egg + hen" if cooks else "egg"
    return posed(kitchen, "meal", *units[: 3 + cooks], items="used-up", stock=copies)


def test_beside_a_plan_stands_the_tree_where_nothing_is_used_up() -> None:
    problem = one_egg(1)
    shown = in_page(foon_asp.view(problem, beside=["searches", "proof"]).html())
    for name, items, units in (("answer", "used-up", 4), ("lasting", "lasting", 3)):
        assert (shown[name]["items"], shown[name]["costs"]["units"]) == (items, units)
    assert shown["proof"]["cost"] == 3  # what holds for trees holds for plans
    bfs = shown["searches"][0]
    assert (bfs["items"], bfs["verdict"]) == ("used-up", "does not execute")
    assert bfs["as_listed"]["missing"]["node"] == "egg"
    ruled = in_page(foon_asp.view(problem, constraints=":- times(U,2).").html())
    assert (ruled["lasting"], ruled["proof"], ruled["without_rules"]["items"]) == (None, None, "used-up")
    taking = in_page(foon_asp.view(problem, "kitchen", beside=["proof"]).html())
    assert (taking["lasting"]["status"], taking["proof"]) == ("optimal", None)


def test_where_there_is_no_plan_it_is_what_runs_out_or_what_is_missing() -> None:
    short = in_page(foon_asp.view(one_egg(1, cooks=False)).html())
    assert (short["answer"]["status"], short["lasting"]["costs"]["units"]) == ("infeasible", 3)
    assert short["why_not"] is short["proof"] is None
    nothing = foon_asp.build([("fry", "egg", "omelet")], kitchen=(), goals="omelet").problem(items="used-up")
    shown = in_page(foon_asp.view(nothing).html())
    assert shown["lasting"]["status"] == "infeasible"
    assert shown["why_not"]["roots"][0]["object"]["node"] == "egg"
    assert shown["proof"]["cases"][0]["ends"] == "hopeless"


@pytest.mark.parametrize("containers", ["strict", pytest.param("implied", marks=pytest.mark.slow)])
def test_a_page_of_a_network_has_all_of_it(containers: str) -> None:
    foon = foon_asp.load()
    problem = foon.problem("macaroni", containers=containers)
    network = in_page(foon_asp.view(foon, containers=containers).html())["network"]
    assert [unit["motion"] for unit in network["units"]] == list(problem.network.motions)
    assert [node["node"] for node in network["objects"]] == list(map(str, problem.network.objects))
    assert set(network["kitchen"]) == problem.kitchen
    available = reach(problem).available
    assert set(network["reachable"]) == {o for o, there in enumerate(available) if there}
    places = [*zip(network["places"][::2], network["places"][1::2], strict=True)]
    assert len(places) == len(network["units"]) + len(network["objects"])
    assert len(set(places)) > 0.99 * len(places)
    assert in_page(foon_asp.view(problem, beside=["network"]).html())["network"]["units"] == network["units"]


def test_a_network_has_no_tree_to_ask_for(cli: Cli, tmp_path: Path) -> None:
    for words in (("--objective", "success"), ("--beside", "front"), ("--rule", ":- use(1).")):
        ran = cli("view", *words, "-o", tmp_path / "whole.html")
        assert (ran.code, f"{words[0]} is for the best tree for a --goal" in ran.err) == (2, True)


def test_a_notebook_shows_the_page_in_a_frame() -> None:
    shown = foon_asp.view(foon_asp.solve(foon_asp.load().problem("ice")))
    (tag, frame), *_ = Parts(shown._repr_mimebundle_()["text/html"]).tags
    assert tag == "iframe"
    assert frame["sandbox"] == "allow-scripts allow-downloads allow-modals"
    assert frame["srcdoc"] == shown.html()
