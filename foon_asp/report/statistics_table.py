"""What is in a network, for people and for programs."""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import asdict

from foon_asp.document.json_document import document, nodes_json
from foon_asp.escapes import escaped
from foon_asp.network import Network, counted
from foon_asp.network.statistics import MANY, Statistics, most_connected_labels, most_connected_objects
from foon_asp.report.stacked import is_narrow
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


def statistics_text(network: Network, levels: Sequence[Statistics], from_kitchen: bool) -> str:
    """Give a table with a column for each level, and what is most connected at level 3."""
    hand = "from the kitchen" if from_kitchen else "from the nodes that no unit makes; no kitchen is given"
    headings = {"reach": f"reach {hand}"}
    files, videos = _origins(network)
    copies = sum(files.values())
    places = f"{counted(len(files), 'file', ',')}, {counted(len(videos), 'source video', ',')}"
    lines = [f"{counted(copies, 'unit', ',')} read from {places}"]
    again = copies - len(network)
    lines.append(f"{again:,} of them {'is a copy of another' if again == 1 else 'are copies of others'}")
    lines += ["", _row("at level", [str(s.level) for s in levels])]
    heading = ""
    for group, name, figure in _ROWS:
        if group != heading:
            lines.append(headings.get(group, group))
            heading = group
        figures = [figure(statistics) for statistics in levels]
        shown = [f"{value:,}" if isinstance(value, int) else str(value) for value in figures]
        lines.append(_row(f"  {name}" if group else name, shown))
    lines += ["", "most connected labels: units with the label among their inputs or outputs"]
    lines += [f"  {number:>7,}  {label}" for label, number in most_connected_labels(network, _SHOWN)]
    lines += ["", "most connected object nodes: units that need it, units that make it"]
    lines += [
        f"  {users:>7,} {makers:>7,}  {network.objects[node]}"
        for node, users, makers in most_connected_objects(network, _SHOWN)
    ]
    if len(files) > 1:
        lines += ["", "most units: files"]
        lines += [f"  {number:>7,}  {escaped(file)}" for file, number in files.most_common(_SHOWN)]
        if len(files) > _SHOWN:
            lines.append(
                f"  ... and {counted(len(files) - _SHOWN, 'file', ',')} more; --format json lists all"
            )
    return "\n".join(lines) + "\n"


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
        reached_from="kitchen" if from_kitchen else "not made",
        levels=[asdict(statistics) for statistics in levels],
        most_connected_labels=[
            {"label": label, "units": number} for label, number in most_connected_labels(network, _SHOWN)
        ],
        most_connected_objects=[
            {"object": nodes_json(network, [node])[0], "needed_by": users, "made_by": makers}
            for node, users, makers in most_connected_objects(network, _SHOWN)
        ],
    )


def _origins(network: Network) -> tuple[Counter[str], tuple[str, ...]]:
    """Count the units of each file, copies included, and list the videos they come from."""
    sources = [source for copies in network.sources for source in copies]
    videos = dict.fromkeys(video for source in sources for video in source.videos)
    return Counter(source.file for source in sources), tuple(videos)


def _row(name: str, figures: Sequence[str]) -> str:
    if is_narrow():
        return f"{name}: {', '.join(figures)}"
    return f"{name:<46}" + "".join(f"{figure:>10}" for figure in figures)
