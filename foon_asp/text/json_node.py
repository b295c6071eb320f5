"""Object nodes and places as our own JSON has them, written and read."""

from foon_asp.network import ObjectNode, Source
from foon_asp.text.json_value import Json


def node_json(node: ObjectNode, number: int | None = None) -> Json:
    """Return a node in its parts and in one-line notation; ``number`` is its id in the whole network."""
    return {
        "id": number,
        "node": str(node),
        "label": node.label,
        "states": sorted(node.states),
        "relations": [relation._asdict() for relation in sorted(node.relations)],
        "contents": [contents._asdict() for contents in node.contents],
    }


def read_node_json(value: Json) -> ObjectNode:
    """Return the node of :func:`node_json`.

    Raises :class:`KeyError` or :class:`TypeError` for what has another form, and :class:`ValueError` where
    the notation and the parts are not the same node.
    """
    node = ObjectNode.of(
        value["label"],
        value["states"],
        ((relation["word"], relation["object"]) for relation in value["relations"]),
        ((contents["word"], contents["ingredients"]) for contents in value["contents"]),
    )
    if str(node) != value["node"]:
        raise ValueError(f"the parts of {str(value['node'])[:80]!r} are those of {str(node)[:80]!r}")
    return node


def place_json(place: Source) -> Json:
    """Return where something was read."""
    return {"file": place.file, "line": place.line, "videos": list(place.videos)}
