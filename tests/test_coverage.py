"""Which of a user's constraints a certificate speaks about, and which units these rule out."""

import hashlib
from pathlib import Path

import pytest

from foon_asp.asp import Settings
from foon_asp.certificate import Coverage, coverage
from foon_asp.network import NetworkBuilder, ObjectNode, Source
from foon_asp.resources import encodings_folder

REQUIRED = (encodings_folder() / "constraints" / "require_motion.lp").read_bytes()
REQUIRE_MOTION = f"require_motion.lp {hashlib.sha256(REQUIRED).hexdigest()}"


@pytest.mark.parametrize(
    ("constraints", "constants", "expected"),
    [
        ((), (), Coverage()),
        (("forbid_motion",), ("forbidden_motion=pour",), Coverage(("pour",))),
        (("forbid_motion",), ('forbidden_motion="pour off"',), Coverage(("pour off",))),
        (("forbid_object",), ("forbidden_object=salt",), Coverage((), ("salt",))),
        (
            ("forbid_object", "forbid_motion"),
            ("forbidden_motion=pour", "forbidden_object=salt"),
            Coverage(("pour",), ("salt",)),
        ),
        (("forbid_motion", "forbid_motion"), ("forbidden_motion=pour",), Coverage(("pour",))),
        # what nothing is set for forbids nothing
        (("forbid_motion",), (), Coverage()),
        (("forbid_motion",), ("forbidden_motion=",), Coverage()),
        (("forbid_motion",), ('forbidden_motion=""',), Coverage()),
        # a constant that none of these constraints takes may mean anything
        (
            ("forbid_object",),
            ("forbidden_motion=pour", "forbidden_object=a=b"),
            Coverage((), ("a=b",), ("forbidden_motion=pour",)),
        ),
        ((), ("b=1", "a=2", "a=3"), Coverage((), (), ("a=3", "b=1"))),
        (
            ("require_motion", "forbid_motion", "require_motion"),
            ("required_motion=mix", "forbidden_motion=pour"),
            Coverage(("pour",), (), (REQUIRE_MOTION, "required_motion=mix")),
        ),
    ],
)
def test_what_is_covered(
    constraints: tuple[str, ...], constants: tuple[str, ...], expected: Coverage
) -> None:
    assert coverage(Settings(tuple(map(Path, constraints)), constants=constants)) == expected


def test_a_copy_of_ours_is_a_rule_like_any_other(tmp_path: Path) -> None:
    copy = tmp_path / "forbid_motion.lp"
    copy.write_bytes((encodings_folder() / "constraints" / "forbid_motion.lp").read_bytes())
    digest = hashlib.sha256(copy.read_bytes()).hexdigest()
    found = coverage(Settings((copy,), constants=("forbidden_motion=pour",)))
    assert found == Coverage((), (), (f"forbid_motion.lp {digest}", "forbidden_motion=pour"))


def test_replaced_encodings_may_say_anything() -> None:
    assert coverage(Settings(encodings=Path("some") / "where")) == Coverage((), (), ("encodings where",))


def test_what_cannot_be_printed_is_escaped() -> None:
    found = coverage(Settings(constants=("a=\u00e9\n\u2028\x1b b",)))
    assert found == Coverage((), (), ("a=\u00e9\\n\\u2028\\x1b b",))


def test_which_units_are_ruled_out() -> None:
    builder = NetworkBuilder()
    salt = [ObjectNode.of("salt", ["dry"]), ObjectNode.of("salt", [], [("in", "cup")])]
    cup, end = ObjectNode.of("cup"), ObjectNode.of("end")
    builder.add("pour", [salt[0]], [cup], Source("small", 1))
    builder.add("pour", [cup], [salt[1]], Source("small", 2))
    builder.add("mix", [cup], [end], Source("small", 3))
    network = builder.build()
    assert Coverage().forbids(network) == frozenset()
    assert Coverage(("pour", "dig")).forbids(network) == {0, 1}
    assert Coverage(("mix",)).forbids(network) == {2}
    assert Coverage((), ("salt",)).forbids(network) == {0, 1}
    assert Coverage((), ("cup",)).forbids(network) == {0, 1, 2}
    assert Coverage(("pour",), ("end", "pepper")).forbids(network) == {0, 1, 2}
