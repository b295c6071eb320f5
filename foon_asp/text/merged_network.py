"""A merged network as FOON text: every unit once, under the places of all its copies."""

from collections.abc import Iterator

from foon_asp.errors import UserError
from foon_asp.escapes import encodable
from foon_asp.network import Contents, Network, ObjectNode, Relation, Source
from foon_asp.text.line import MotionLine, ObjectLine, StateLine
from foon_asp.text.listed_unit import node_of
from foon_asp.text.provenance import read_copy, write_copy
from foon_asp.text.reader import FoonReader
from foon_asp.text.writer import write_node


def merged_text(network: Network, comment: str) -> Iterator[str]:
    """Give the text piece by piece: a comment, then the units in order of first reading, in plain form.

    Above each unit stands a line ``# From:`` for every copy of it, with file, line and videos; a copy that
    is known twice, from a file and from what that was merged into, stands there once. Reading the text gives
    the same network and the same sources, except that columns are not written. Raises :class:`UserError`
    for a name that a line of text cannot hold, and for a unit without inputs.
    """
    blocks = list(map(write_node, network.objects))
    motions = {motion: f"M\t{motion}\n" for motion in dict.fromkeys(network.motions)}
    _check_names(network.objects, blocks, motions)
    known: dict[Source, str] = {}
    yield f"# {comment}\n//\n"
    for motion, inputs, outputs, sources in zip(
        network.motions, network.inputs, network.outputs, network.sources, strict=True
    ):
        if not inputs:
            raise UserError(f"the unit {motion!r} has no inputs, which FOON text cannot hold; a store can")
        for source in dict.fromkeys(source._replace(column=1) for source in sources):
            yield known.get(source) or known.setdefault(source, _copy(source))
        yield from (blocks[node] for node in inputs)
        yield motions[motion]
        yield from (blocks[node] for node in outputs)
        yield "//\n"


def _check_names(nodes: tuple[ObjectNode, ...], blocks: list[str], motions: dict[str, str]) -> None:
    """Read back what is written: a name from JSON may hold what means something else in a line of text."""
    reader = FoonReader()
    reader.parse_new(line for block in (*blocks, *motions.values()) for line in block[:-1].split("\n"))
    for node, block in zip(nodes, blocks, strict=True):
        first, *rest = map(reader.parse, block[:-1].split("\n"))
        said: list[str | Relation | Contents] = [s.attribute for s in rest if isinstance(s, StateLine)]
        back = (
            node_of(first.label, said) if isinstance(first, ObjectLine) and len(said) == len(rest) else None
        )
        if back != node or encodable(block) != block:
            raise UserError(f"the object node {str(node)!r} has a name that FOON text cannot hold")
    for motion, line in motions.items():
        parsed = reader.parse(line[:-1])
        if not isinstance(parsed, MotionLine) or parsed.motion != motion or encodable(line) != line:
            raise UserError(f"the motion {motion!r} is a name that FOON text cannot hold")


def _copy(source: Source) -> str:
    """Write a place, and read it back: the name of a file may hold what ends it in a line of text."""
    written = write_copy(source)
    if (
        "\n" in written[:-1]
        or "\r" in written
        or read_copy(written[:-1]) != source
        or encodable(written) != written
    ):
        raise UserError(
            f"{source.file!r} cannot be named in a line of text: rename it, without tabs, line ends and"
            " blanks at the start"
        )
    return written
