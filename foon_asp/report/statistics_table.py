"""What is in a network, for people and for programs."""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict

from foon_asp.document.json_document import document, nodes_json
from foon_asp.escapes import escaped
from foon_asp.network import Network, counted, starting_kitchen
from foon_asp.network.statistics import MANY, Statistics, most_connected_labels, most_connected_objects
from foon_asp.results.table import Part, Table
from foon_asp.text.json_value import Json

_SHOWN = 10

# Heading, row name, and the figure of one level.
_ROWS: tuple[tuple[str, str, Callable[[Statistics], object]], ...] = (
    ("", "functional units", lambda s: s.units),
    ("", "object nodes", lambda s: s.objects),
    ("", "labels", lambda s: s.labels),
    ("", "motions", lambda s: s.motions),
    ("", "states", lambda s: s.states),
    ("", "relations, as in [bowl]", lambda s: s.relations),
    ("", "contents, as contains {salt}", lambda s: s.contents),
    ("units", "inputs, mean", lambda s: f"{s.mean_inputs:.2f}"),
    ("units", "inputs, most", lambda s: s.most_inputs),
    ("units", "outputs, mean", lambda s: f"{s.mean_outputs:.2f}"),
    ("units", "outputs, most", lambda s: s.most_outputs),
    ("units", "whose outputs are their inputs", lambda s: s.unchanged),
    ("object nodes", "that no unit makes", lambda s: s.producers[0]),
    *(
        ("object nodes", f"made by {n} unit{'s' * (n > 1)}", lambda s, n=n: s.producers[n])
        for n in range(1, MANY)
    ),
    ("object nodes", f"made by {MANY} or more", lambda s: s.producers[MANY]),
    ("object nodes", "most producers of one", lambda s: s.most_producers),
    ("object nodes", "that no unit needs", lambda s: s.unused),
    ("graph", "cycles (sets of nodes that need each other)", lambda s: s.cycles),
    ("graph", "nodes in cycles", lambda s: s.in_cycles),
    ("graph", "nodes in the largest", lambda s: s.largest_cycle),
    ("graph", "parts that share no node", lambda s: s.parts),
    ("graph", "units in the largest", lambda s: s.largest_part),
    ("reach", "nodes at hand", lambda s: s.at_hand),
    ("reach", "depth, most", lambda s: s.depth),
    ("reach", "depth, median over units", lambda s: f"{s.median_depth:g}"),
    ("reach", "nodes out of reach", lambda s: s.unreached_objects),
    ("reach", "units out of reach", lambda s: s.unreached_units),
)


def statistics_parts(network: Network, levels: Sequence[Statistics], from_kitchen: bool) -> Iterator[Part]:
    """Return a table with a column for each level, and what is most connected at level 3."""
    files, videos = _origins(network)
    copies = sum(files.values())
    places = f"{counted(len(files), 'file', ',')}, {counted(len(videos), 'source video', ',')}"
    yield f"{counted(copies, 'unit', ',')} read from {places}"
    again = copies - len(network)
    yield f"{again:,} of them {'is a copy of another' if again == 1 else 'are copies of others'}"
    yield ""
    yield _table(levels, "reach from the kitchen" if from_kitchen else "reach from the starting kitchen")
    if not from_kitchen:
        yield from _starting_lines(network)
    yield from ("", "most connected labels: units with the label among their inputs or outputs")
    labels = most_connected_labels(network, _SHOWN)
    yield from (f"  {number:>7,}  {label}" for label, number in labels)
    yield from ("", "most connected object nodes: units that need it, units that make it")
    for node, users, makers in most_connected_objects(network, _SHOWN):
        yield f"  {users:>7,} {makers:>7,}  {network.objects[node]}"
    if len(files) > 1:
        yield from ("", "most units: files")
        yield from (f"  {number:>7,}  {escaped(file)}" for file, number in files.most_common(_SHOWN))
    if len(files) > _SHOWN:
        yield f"  ... and {counted(len(files) - _SHOWN, 'file', ',')} more; --format json lists all"


def _table(levels: Sequence[Statistics], reach: str) -> Table:
    rows: list[Sequence[str] | str] = []
    heading = ""
    for group, name, figure in _ROWS:
        if group != heading:
            rows.append(reach if group == "reach" else group)
            heading = group
        figures = [figure(statistics) for statistics in levels]
        shown = [f"{value:,}" if isinstance(value, int) else str(value) for value in figures]
        rows.append([f"  {name}" if group else name, *shown])
    return Table(["at level", *(str(each.level) for each in levels)], rows, frozenset({0}))


def statistics_json(network: Network, levels: Sequence[Statistics], from_kitchen: bool) -> Json:
    """Give the same as a document."""
    files, videos = _origins(network)
    copies = sum(files.values())
    return document(
        "stats",
        units_read=copies,
        copies=copies - len(network),
        files=[{"file": file, "units": number} for file, number in files.items()],
        videos=list(videos),
        reached_from="kitchen" if from_kitchen else "starting kitchen",
        starting_kitchen=None if from_kitchen else _starting_json(network),
        levels=[asdict(statistics) for statistics in levels],
        most_connected_labels=[
            {"label": label, "units": number} for label, number in most_connected_labels(network, _SHOWN)
        ],
        most_connected_objects=[
            {"object": nodes_json(network, [node])[0], "needed_by": users, "made_by": makers}
            for node, users, makers in most_connected_objects(network, _SHOWN)
        ],
    )


def _starting_lines(network: Network) -> Iterator[str]:
    """Return lines that say which rule gave what to the starting kitchen, at level 3."""
    kitchen = starting_kitchen(network)
    not_made = len(kitchen.nodes) - len(kitchen.made_too)
    files = counted(kitchen.file_count, "file", ",")
    yield "the starting kitchen, as no kitchen is given:"
    yield f"  what no unit makes: {counted(not_made, 'node', ',')}"
    yield f"  what units of the {files} also need: {counted(len(kitchen.made_too), 'node', ',')}"


def _starting_json(network: Network) -> Json:
    kitchen = starting_kitchen(network)
    return {
        "files": kitchen.file_count,
        "not_made": nodes_json(network, sorted(kitchen.nodes - kitchen.made_too)),
        "made_too": nodes_json(network, sorted(kitchen.made_too)),
    }


def _origins(network: Network) -> tuple[Counter[str], tuple[str, ...]]:
    """Count the units of each file, copies included, and list the videos they come from."""
    sources = [source for copies in network.sources for source in copies]
    videos = dict.fromkeys(video for source in sources for video in source.videos)
    return Counter(source.file for source in sources), tuple(videos)
