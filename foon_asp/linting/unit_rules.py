"""What there is to say of units: copies, nodes listed twice, units that change nothing."""

from collections.abc import Iterator

from foon_asp.linting.linted_files import Copy, LintedFiles
from foon_asp.text.diagnostics import Diagnostic


def unit_findings(files: LintedFiles) -> Iterator[Diagnostic]:
    """Give the findings about each unit by itself and about its copies, in linear time."""
    network = files.network
    for unit, copies in enumerate(files.copies):
        inputs, outputs = network.inputs[unit], network.outputs[unit]
        if outputs and len(inputs) == len(outputs) and set(inputs) == set(outputs):
            yield from _no_effect(files, unit, copies)
        if len(copies) > 1:
            yield from _copies(files, unit, copies)
        for copy in copies:
            if copy.inputs > len(inputs) or copy.outputs > len(outputs):
                yield from _repeated_objects(files, copy)


def _no_effect(files: LintedFiles, unit: int, copies: list[Copy]) -> Iterator[Diagnostic]:
    motion = files.network.motions[unit]
    message = (
        f"the outputs of the unit {motion!r} are its inputs; say what {motion!r} changes, or leave it out"
    )
    for copy in copies:
        yield files.sheets[copy.sheet].finding("no-effect", message, copy.at)


def _copies(files: LintedFiles, unit: int, copies: list[Copy]) -> Iterator[Diagnostic]:
    """Name the first copy in the file; that recipes have units in common is as it should be."""
    motion = files.network.motions[unit]
    firsts: dict[int, Copy] = {}
    for copy in copies:
        sheet = files.sheets[copy.sheet]
        first = firsts.setdefault(copy.sheet, copy)
        if first is not copy:
            message = (
                f"the unit {motion!r} is already on {sheet.where(first.at, sheet)}, with the "
                "same inputs and outputs; one is enough"
            )
            yield sheet.finding("duplicate-unit", message, copy.at)


def _repeated_objects(files: LintedFiles, copy: Copy) -> Iterator[Diagnostic]:
    sheet = files.sheets[copy.sheet]
    blocks = list(sheet.blocks(copy.at))
    for side, part in (("inputs", blocks[: copy.inputs]), ("outputs", blocks[copy.inputs :])):
        seen: dict[object, int] = {}
        for index, node in part:
            first = seen.setdefault(node, index)
            if first != index:
                message = (
                    f"{str(node)!r} is among the {side} of the unit already, on "
                    f"{sheet.where(first, sheet)}; it counts once"
                )
                yield sheet.finding("repeated-object", message, index, node.label)
