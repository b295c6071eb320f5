"""Which of a user's constraints a certificate speaks about, and which units these rule out."""

import hashlib
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

from foon_asp.asp import Settings
from foon_asp.certificate import Coverage, coverage
from foon_asp.network import NetworkBuilder, ObjectNode, Source
from foon_asp.problem import Problem
from foon_asp.proof.rule_meaning import LIBRARY, Rule
from foon_asp.resources import encodings_folder
from foon_asp.rules.constraint_library import library_constraints
from foon_asp.rules.passed_constraint import given_constraint
from tests.oracle.constraints import HEATS
from tests.rules.test_constraint_meanings import small
from tests.support.handmade_certificate import forbid

POUR: Rule = {"rule": "forbid_motion", "forbidden_motion": "pour"}
SALT: Rule = {"rule": "forbid_object", "forbidden_object": "salt"}


def test_every_ready_made_constraint_is_covered() -> None:
    assert {constraint.name for constraint in library_constraints()} == LIBRARY.keys()


@pytest.mark.parametrize(
    ("constraints", "constants", "expected"),
    [
        ((), (), Coverage()),
        (("forbid_motion",), ("forbidden_motion=pour",), Coverage((POUR,))),
        (
            ("forbid_motion",),
            ('forbidden_motion="pour off"',),
            Coverage((*forbid(["pour off"]),)),
        ),
        (
            ("forbid_object", "forbid_motion"),
            ("forbidden_motion=pour", "forbidden_object=salt"),
            Coverage((POUR, SALT)),
        ),
        (("forbid_motion", "forbid_motion"), ("forbidden_motion=pour",), Coverage((POUR,))),
        # what nothing is set for forbids nothing
        (("forbid_motion",), (), Coverage()),
        (("forbid_ingredient", "only_sources", "least_rate", "at_most_units"), (), Coverage()),
        (("least_rate", "at_most_units"), ("least_rate=#inf", "max_units=#sup"), Coverage()),
        (("at_most_motion",), ("limited_motion=pour",), Coverage()),
        # a constant that none of these constraints takes may mean anything
        (
            ("forbid_object",),
            ("forbidden_motion=pour", "forbidden_object=a=b"),
            Coverage((*forbid([], ["a=b"]),), ("forbidden_motion=pour",)),
        ),
        ((), ("b=1", "a=2", "a=3"), Coverage((), ("a=3", "b=1"))),
        (
            ("require_motion", "forbid_motion", "require_motion"),
            ("required_motion=mix", "forbidden_motion=pour"),
            Coverage(({**POUR}, {"rule": "require_motion", "required_motion": "mix"})),
        ),
        (
            ("at_most_motion", "least_rate", "only_sources", "forbid_ingredient"),
            (
                *("limited_motion=pour", "max_uses=2", "least_rate=-5"),
                *("allowed_source=a.txt", "forbidden_ingredient=egg"),
            ),
            Coverage(
                (
                    {"rule": "at_most_motion", "limited_motion": "pour", "max_uses": 2},
                    {"rule": "forbid_ingredient", "allergen": ["egg"]},
                    {"rule": "least_rate", "least_rate": -5},
                    {"rule": "only_sources", "allowed": ["a.txt"]},
                )
            ),
        ),
    ],
)
def test_what_is_covered(
    constraints: tuple[str, ...], constants: tuple[str, ...], expected: Coverage
) -> None:
    found = coverage(Settings(tuple(map(Path, constraints)), constants=constants))
    assert sorted(map(str, found.rules)) == sorted(map(str, expected.rules))
    assert found.not_covered == expected.not_covered


def test_uses_with_constants_of_their_own_are_covered_each() -> None:
    texts = (
        *("at_most_motion:limited_motion=pour,max_uses=2", "at_most_motion:limited_motion=mix,max_uses=0"),
        *("forbid_ingredient:forbidden_ingredient=egg", "forbid_ingredient:forbidden_ingredient=milk"),
        *("forbid_motion", 'allergen("nut").'),
    )
    found = coverage(Settings((*map(given_constraint, texts),), constants=("forbidden_motion=pour",)))
    assert found.not_covered == ()
    assert list(found.rules) == [
        {"rule": "forbid_ingredient", "allergen": ["egg", "milk", "nut"]},  # they share what they read
        POUR,
        {"rule": "at_most_motion", "limited_motion": "mix", "max_uses": 0},
        {"rule": "at_most_motion", "limited_motion": "pour", "max_uses": 2},
    ]


def test_motions_that_heat_are_those_of_ours_and_those_that_are_listed() -> None:
    given = map(given_constraint, ("never_heated", 'heats("flambe").'))
    (rule,) = coverage(Settings((*given,), constants=("unheated_ingredient=egg",))).rules
    assert rule == {
        "rule": "never_heated",
        "unheated_ingredient": "egg",
        "heats": sorted([*HEATS, "flambe"]),
    }


def test_values_that_files_list_as_facts_are_covered(tmp_path: Path) -> None:
    mine, more = tmp_path / "mine.lp", tmp_path / "more.lp"
    mine.write_text('% mine\nallergen("milk"). allergen("eg\\"g";"nut").\n')
    more.write_text('allowed("a.txt"). allergen("fish").\n')
    both = tuple(map(Path, ("forbid_ingredient", "only_sources")))
    found = coverage(Settings((*both, mine, more), constants=("forbidden_ingredient=butter",)))
    assert found.not_covered == ()
    assert found.rules == (
        {"rule": "forbid_ingredient", "allergen": ["butter", 'eg"g', "fish", "milk", "nut"]},
        {"rule": "only_sources", "allowed": ["a.txt"]},
    )
    # facts that no constraint reads, and files that say more, are rules like any other
    assert [name.split()[0] for name in coverage(Settings((both[0], more))).not_covered] == ["more.lp"]
    for text in ('allergen("milk") :- unit(U).', 'allergen("a"). :- use(1).', "allergen(1)."):
        mine.write_text(text)
        alone = coverage(Settings((both[0], mine)))
        assert alone.rules == ()
        assert [name.split()[0] for name in alone.not_covered] == ["mine.lp"]


def test_a_copy_of_ours_is_a_rule_like_any_other(tmp_path: Path) -> None:
    copy = tmp_path / "forbid_motion.lp"
    copy.write_bytes((encodings_folder() / "constraints" / "forbid_motion.lp").read_bytes())
    digest = hashlib.sha256(copy.read_bytes()).hexdigest()
    found = coverage(Settings((copy,), constants=("forbidden_motion=pour",)))
    assert found == Coverage((), (f"forbid_motion.lp {digest}", "forbidden_motion=pour"))


def test_replaced_encodings_may_say_anything() -> None:
    """What rules units out is covered with them, and nothing else."""
    assert coverage(Settings(encodings=Path("some") / "where")) == Coverage((), ("encodings where",))
    constants = ("forbidden_motion=pour", "required_motion=mix")
    files = (Path("forbid_motion"), Path("require_motion"))
    found = coverage(Settings(files, Path("some") / "where", constants))
    assert found.rules == (POUR,)
    assert [name.split()[0] for name in found.not_covered] == [
        *("encodings", "require_motion.lp", "required_motion=mix")
    ]


def test_a_value_is_set_for_the_uses_that_read_it() -> None:
    """A constant that is set for all is not one of a use with values of its own."""
    egg = given_constraint("forbid_ingredient:forbidden_ingredient=egg")
    found = coverage(
        Settings(
            (egg, Path("forbid_motion")), constants=("forbidden_motion=pour", "forbidden_ingredient=milk")
        )
    )
    assert found == Coverage(
        ({"rule": "forbid_ingredient", "allergen": ["egg"]}, POUR), ("forbidden_ingredient=milk",)
    )


def test_a_use_that_is_not_covered_is_named_with_its_file() -> None:
    use = given_constraint("at_most_motion:limited_motion=pour,max_uses=1")
    digest = hashlib.sha256((encodings_folder() / "constraints/at_most_motion.lp").read_bytes()).hexdigest()
    found = coverage(Settings((use,), encodings=encodings_folder()))
    assert found.rules == ()
    assert found.not_covered == (f"{use.name} {digest}", "encodings encodings")


def test_what_cannot_be_printed_is_escaped() -> None:
    found = coverage(Settings(constants=("a=\u00e9\n\u2028\x1b b",)))
    assert found == Coverage((), ("a=\u00e9\\n\\u2028\\x1b b",))


def test_which_units_are_ruled_out() -> None:
    """Those that rules rule out by their words are told apart from others in test_constraint_meanings."""
    network = small("pour: salt > cup", "pour: cup > tea", "mix: cup > end", "mix: tea > end").network
    labels = [node.label for node in network.objects]
    rates = {"pour": Fraction(8, 10), "mix": Fraction(7999999, 10**7)}
    asked = Problem(network, frozenset({labels.index("salt")}), (labels.index("end"),), rates, frozenset())

    def gone(*rules: Rule) -> frozenset[int]:
        return Coverage(rules).forbidden_units(asked)

    assert gone() == frozenset()
    assert gone(*forbid(["pour"], ["end", "pepper"])) == {0, 1, 2, 3}
    assert gone({"rule": "least_rate", "least_rate": 799999}) == frozenset()
    assert gone({"rule": "least_rate", "least_rate": 800000}) == {2, 3}  # what clingo sees is rounded down
    assert gone({"rule": "only_sources", "allowed": ["mix.txt"]}) == {0, 1}
    assert gone({"rule": "require_motion", "required_motion": "mix"}) == frozenset()
    assert gone({"rule": "at_most_price", "max_price": 100}) == {0, 1, 2, 3}  # no price is known
    unknown = replace(asked, rates=None)
    assert Coverage(({"rule": "least_rate", "least_rate": -1},)).forbidden_units(unknown) == {0, 1, 2, 3}
    assert Coverage(
        (POUR, {"rule": "before", "earlier_motion": "a", "later_motion": "b"})
    ).rules_beyond_removal() == ["before"]


def test_a_place_is_named_by_its_file_or_its_video() -> None:
    builder = NetworkBuilder()
    builder.add("mix", [ObjectNode.of("a")], [ObjectNode.of("b")], Source("small", 1))
    builder.add(
        "mix", [ObjectNode.of("b")], [ObjectNode.of("c")], Source("far/small.txt", 3, 1, ("https://a.b",))
    )
    asked = Problem(builder.build(), frozenset({0}), (2,), None, frozenset())
    for names, gone in (
        (["small"], {1}),
        (["far/small.txt"], {0}),
        (["small.txt"], {0}),
        (["https://a.b"], {0}),
    ):
        assert Coverage(({"rule": "only_sources", "allowed": names},)).forbidden_units(asked) == gone
    for least, without in ((1, {0}), (2, {0, 1})):
        assert (
            Coverage(({"rule": "at_least_videos", "least_videos": least},)).forbidden_units(asked) == without
        )
