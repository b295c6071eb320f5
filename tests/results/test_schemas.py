"""Schemas of documents are made of their fields."""

import pytest

from foon_asp.json_layout import json_text
from foon_asp.planning import translator
from foon_asp.results.schema_file import SCHEMAS
from tests.results.__main__ import schemas
from tests.results.json_page import PAGE, page

BY_HAND = {"lint-baseline"}


def test_schemas_are_what_the_fields_say() -> None:
    made = {kind: json_text(schema) for kind, schema in schemas().items()}
    found = {file.stem: file.read_text(encoding="utf-8") for file in SCHEMAS.glob("*.json")}
    assert {*found} == {*made, *BY_HAND}
    assert {kind for kind in made if found[kind] != made[kind]} == set(), "python -m tests.results"


@pytest.mark.skipif(not translator.is_installed(), reason="an example needs foon-asp[pddl]")
def test_the_page_is_what_schemas_and_examples_say() -> None:
    assert PAGE.read_text(encoding="utf-8") == page(), "python -m tests.results"
