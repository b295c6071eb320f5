"""Faults of JSON have one place and one wording, whichever Python finds them."""

import json

import pytest

from foon_asp.text.json_fault import json_fault


@pytest.mark.parametrize(
    ("text", "place", "found"),
    [
        ("[1, ]", (1, 3), "found a comma before ], expected none"),
        ('[1,\n{"a": [2],\n\n}]', (2, 10), "found a comma before }, expected none"),
        ('{"a": "[,]",}', (1, 12), "found a comma before }, expected none"),
        ("[,]", (1, 2), "found a comma before ], expected none"),
        ("[1,,2]", (1, 4), "Expecting value"),
        ('{"a": 1,\n\n"b"}', (3, 4), "Expecting ':' delimiter"),
        ('{"a": 1,', (1, 9), "Expecting property name enclosed in double quotes"),
        ('["a\n', (1, 4), "Invalid control character at"),
        ("]", (1, 1), "Expecting value"),
        (" }", (1, 2), "Expecting value"),
        ("", (1, 1), "Expecting value"),
    ],
)
def test_faults_of_json_are_the_same_under_every_python(
    text: str, place: tuple[int, int], found: str
) -> None:
    with pytest.raises(json.JSONDecodeError) as raised:
        json.loads(text)
    fault = json_fault(raised.value)
    assert ((fault.line, fault.column), fault.message) == (place, f"not JSON: {found}")
    assert text.count("\n", 0, fault.offset) == fault.line - 1
