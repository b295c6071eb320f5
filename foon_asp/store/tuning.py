"""Numbers that steer how stores are written and read; none of them changes what is stored or answered."""

from typing import NamedTuple


class StoreTuning(NamedTuple):
    """Sizes of batches and caches of this room.

    ``rows_per_write``: rows of one table that are kept in memory until they are written.
    ``cached_nodes``: nodes met lately whose ids an import keeps by node: copies are mostly close together.
    ``cached_attributes``: different lists of states, relations or contents that are kept as they were read.
    ``digest_texts``: texts that are put together before they are added to a digest.
    ``cone_nodes``: nodes whose producers one query reads; a cone reads those of up to as many too many.
    ``compared_labels``: labels that share the rarest trigrams with a wanted one, which are compared in full.
    """

    rows_per_write: int = 1_000
    cached_nodes: int = 50_000
    cached_attributes: int = 100_000
    digest_texts: int = 1_000
    cone_nodes: int = 200
    compared_labels: int = 300


STORE = StoreTuning()
