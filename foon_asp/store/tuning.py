"""Numbers that steer how stores are written and read. None of them changes a result."""

from typing import NamedTuple


class StoreTuning(NamedTuple):
    """Sizes of batches and caches.

    ``rows_per_write``: rows of one table that are kept in memory until they are written.
    ``cached_nodes``: recent nodes whose ids an import keeps in memory, since copies are mostly close
    together.
    ``cached_attributes``: distinct lists of states, relations or contents that are kept in memory after
    reading.
    ``digest_texts``: texts that are joined before they are added to a digest.
    ``cone_nodes``: nodes whose producers one query reads. A cone with a limit may not use all of them.
    ``compared_labels``: labels that are compared in full with a wanted one, whose rarest trigrams they share.
    """

    rows_per_write: int = 1_000
    cached_nodes: int = 50_000
    cached_attributes: int = 100_000
    digest_texts: int = 1_000
    cone_nodes: int = 200
    compared_labels: int = 300


STORE = StoreTuning()
