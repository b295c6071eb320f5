"""The JSON Schemas of documents, written by ``python -m tests.results``."""

from pathlib import Path

from foon_asp.json_layout import Json, read_json

SCHEMAS = Path(__file__).resolve().parent / "schemas"


def schema_kinds() -> tuple[str, ...]:
    """Return the kinds of documents as in their schema names: ``answer`` for ``foon-asp/answer/1``."""
    return tuple(sorted(file.stem for file in SCHEMAS.glob("*.json")))


def schema(kind: str) -> Json:
    """Return the JSON Schema of a kind of documents, read from its file."""
    values: Json = read_json((SCHEMAS / f"{kind}.json").read_text(encoding="utf-8"))
    return values
