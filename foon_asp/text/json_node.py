"""Reading object nodes from the JSON that foon-asp writes."""

from foon_asp.json_layout import Json
from foon_asp.network import ObjectNode


def read_node_json(value: Json) -> ObjectNode:
    """Return the node of a JSON object that was written from a :class:`foon_asp.results.values.Node`.

    Raises :class:`KeyError` or :class:`TypeError` for an object of another form. Raises :class:`ValueError`
    if its key ``node``, in one-line notation, means another node than its other keys state.
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
