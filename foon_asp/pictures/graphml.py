"""Drawings as GraphML, for Gephi, networkx and other programs that show or measure graphs."""

from xml.etree import ElementTree

from foon_asp.pictures.drawing import Box, Drawing, replace_unprintable


def graphml_text(drawing: Drawing) -> str:
    """Return a drawing of any size as GraphML; nodes have the attributes of :func:`_attributes`."""
    root = ElementTree.Element("graphml", xmlns="http://graphml.graphdrawing.org/xmlns")
    for name in ("label", "kind", "unit", "states", "node"):
        type_ = "int" if name == "unit" else "string"
        ElementTree.SubElement(
            root, "key", {"id": name, "for": "node", "attr.name": name, "attr.type": type_}
        )
    graph = ElementTree.SubElement(root, "graph", edgedefault="directed")
    for box in drawing.boxes:
        element = ElementTree.SubElement(graph, "node", id=box.name)
        for name, value in _attributes(box).items():
            ElementTree.SubElement(element, "data", key=name).text = replace_unprintable(str(value))
    for tail, head in drawing.arrows:
        ElementTree.SubElement(graph, "edge", source=tail, target=head)
    ElementTree.indent(root)
    return ElementTree.tostring(root, "unicode") + "\n"


def _attributes(box: Box) -> dict[str, object]:
    """Return the GraphML attributes of a box: its label, its role as ``kind``, and further ones.

    A motion has the id of its unit, if it has one. An object node has its states, and itself in one-line
    notation.
    """
    attributes: dict[str, object] = {"label": box.label, "kind": box.role}
    if box.unit is not None:
        attributes["unit"] = box.unit
    if box.node is not None:
        attributes |= {"states": ", ".join(sorted(box.node.states)), "node": box.node}
    return attributes
