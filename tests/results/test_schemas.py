"""Schemas of results are made of their fields."""

import pytest

from foon_asp.document.schema import SCHEMAS
from tests.results.__main__ import made, results


@pytest.mark.parametrize("kind", sorted(results()))
def test_a_schema_is_what_the_fields_say(kind: str) -> None:
    text = (SCHEMAS / f"{kind}.json").read_text(encoding="utf-8")
    assert text == made(kind, results()[kind]), "python -m tests.results writes it anew"
