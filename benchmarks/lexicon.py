"""A lexicon for ``--similar`` from WordNet: which labels of networks may stand in for each other.

    apt-get install wordnet-base
    python benchmarks/lexicon.py FOON.txt recipe.txt > similar.txt

Labels are looked up as nouns, in the singular. Two labels of one synset cost 2, of a synset and one right
above it 4, of two right below one 8. A label that ends in another one is a kind of it and costs 4, as ground
pepper does for pepper. Of tools and vessels only those of one synset are listed: a pan is no kettle.
"""

import argparse
import sys
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

import foon_asp
from foon_asp.network import spelling_key

FOOD, PLANT, SUBSTANCE, ARTIFACT = "13", "20", "27", "06"  # files of lexicographers
SAME, ABOVE, BESIDE = 2, 4, 8  # prices


class WordNet:
    """The nouns of WordNet: the synsets of a word, and what is right above a synset."""

    def __init__(self, folder: Path) -> None:
        self._data = (folder / "data.noun").read_bytes()
        self._synsets: dict[str, list[str]] = defaultdict(list)
        for line in (folder / "index.noun").read_text(encoding="utf-8").splitlines():
            if not line.startswith(" "):
                word, _, count, *others = line.split()
                self._synsets[spelling_key(word)] += others[-int(count) :]

    def synsets(self, label: str) -> dict[str, tuple[str, list[str]]]:
        """Give the synsets of a label that are about food or tools: their kind, and what is right above."""
        found = {}
        for synset in self._synsets.get(spelling_key(label), ()):
            line = self._data[int(synset) :].split(b"\n", 1)[0].decode()
            fields = line.partition(" | ")[0].split()
            pointers = fields[4 + 2 * int(fields[3], 16) + 1 :]
            above = [pointers[at + 1] for at in range(0, len(pointers), 4) if pointers[at] == "@"]
            if fields[1] in {FOOD, PLANT, SUBSTANCE, ARTIFACT}:
                found[synset] = fields[1], above
        return found


def compounds(labels: set[str]) -> Iterator[tuple[str, str, int]]:
    """Give each label that ends in another one, with that: ground pepper and pepper."""
    keys = {label: spelling_key(label) for label in sorted(labels)}
    for label, key in keys.items():
        heads = [
            other for other, head in keys.items() if len(head) > 3 and key != head and key.endswith(head)
        ]
        longest = max((len(keys[head]) for head in heads), default=0)
        for head in heads:
            if len(keys[head]) == longest:
                yield head, label, ABOVE
                yield label, head, ABOVE


def pairs(labels: set[str], wordnet: WordNet) -> Iterator[tuple[str, str, int]]:
    """Give each two labels that may stand in for each other, with the price."""
    yield from compounds(labels)
    of_label = {label: found for label in sorted(labels) if (found := wordnet.synsets(label))}
    for label, synsets in of_label.items():
        for other, others in of_label.items():
            if label == other or spelling_key(label) == spelling_key(other):
                continue
            prices = [SAME for synset in synsets if synset in others]
            for synset, (kind, above) in synsets.items():
                for other_synset, (other_kind, other_above) in others.items():
                    if ARTIFACT not in {kind, other_kind}:
                        prices += [ABOVE] * (synset in other_above or other_synset in above)
                        prices += [BESIDE] * (not {*above}.isdisjoint(other_above))
            if prices:
                yield label, other, min(prices)


def main() -> None:
    """Print the lexicon of the labels of networks."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("networks", nargs="+", type=Path, metavar="NETWORK")
    parser.add_argument("--wordnet", type=Path, default=Path("/usr/share/wordnet"))
    options = parser.parse_args()
    network = foon_asp.load(options.networks, lenient=True).network
    prices: dict[tuple[str, str], int] = {}
    for label, other, price in pairs(set(network.by_label), WordNet(options.wordnet)):
        prices[label, other] = min(price, prices.get((label, other), price))
    sys.stdout.writelines(f"{label}\t{other}\t{price}\n" for (label, other), price in prices.items())


if __name__ == "__main__":
    main()
