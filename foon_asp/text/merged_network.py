"""A merged network as FOON text: every unit once, under the places of all its copies."""

from collections.abc import Iterator
from types import MappingProxyType

from foon_asp.errors import UserError
from foon_asp.escapes import encodable
from foon_asp.network import ALL_ONE, Amounts, Network, Source
from foon_asp.text.amount_mark import write_amount
from foon_asp.text.provenance import read_copy, write_copy
from foon_asp.text.writer import write_motion, write_node


def merged_text(network: Network, comment: str, amounts: Amounts = MappingProxyType({})) -> Iterator[str]:
    """Yield a network as plain FOON text in pieces: a comment, then the units in order of first reading.

    Above each unit stands a line ``# From:`` for every copy of the unit, with file, line and videos. A copy
    that was read twice, from a file and from a merge of that file, is listed once. The text is read back as
    the same network with the same ``amounts``. Its sources are the same except for their columns.

    Raises :class:`UserError` for a name of the network or of a file that a line of text cannot hold. It is
    also raised for a unit without inputs.
    """
    blocks = list(map(write_node, network.objects))
    motions = {motion: write_motion(motion) for motion in dict.fromkeys(network.motions)}
    comments: dict[Source, str] = {}
    yield f"# {comment}\n//\n"
    motions_with_amounts = {unit.motion for unit in amounts}
    for unit_id, (motion, inputs, outputs, sources) in enumerate(
        zip(network.motions, network.inputs, network.outputs, network.sources, strict=True)
    ):
        if not inputs:
            raise UserError(f"the unit {motion!r} has no inputs, which FOON text cannot hold; a store can")
        for source in dict.fromkeys(source._replace(column=1) for source in sources):
            yield comments.get(source) or comments.setdefault(source, _checked_copy_comment(source))
        has_amounts = motion in motions_with_amounts
        amounts_of_unit = amounts.get(network.unit(unit_id), ALL_ONE) if has_amounts else None
        for side, nodes in enumerate((inputs, outputs)):
            yield motions[motion] if side else ""
            for node in nodes:
                yield blocks[node]
                if amounts_of_unit and (amount := amounts_of_unit[side].get(network.objects[node])):
                    yield write_amount(amount)
        yield "//\n"


def _checked_copy_comment(source: Source) -> str:
    """Return the line ``# From:`` of a source.

    Raises :class:`UserError` if the line would not be read back as the same source.
    """
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
