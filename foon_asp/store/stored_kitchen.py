"""The starting kitchen of a store, of which only what goals need is read."""

from collections.abc import Iterable, Sequence

from foon_asp.network.starting_kitchen import StartingKitchen
from foon_asp.store.columns import decode_ids
from foon_asp.store.store import Store
from foon_asp.store.store_file import reporting_damage
from foon_asp.store.store_tables import UNITS_OF_FILE
from foon_asp.store.stored_ids import StoredIds


class StoredStartingKitchen(StartingKitchen[int]):
    """The starting kitchen of a store. Files are given by their numbers in the store."""

    def __init__(self, store: Store) -> None:
        self.file, self._nodes = store.file, StoredIds(store, "starting")

    @property
    def nodes(self) -> StoredIds:
        """The ids of the nodes that are available, whatever the goals are."""
        return self._nodes

    @reporting_damage
    def makers(self, o: int) -> Sequence[int]:
        """Return the ids of the units that have a node as an output and not as an input."""
        rows = self.file.database.execute(
            "SELECT id, inputs FROM producer JOIN unit ON id = unit WHERE node = ? ORDER BY id", (o,)
        )
        return [unit for unit, inputs in rows if o not in decode_ids(inputs)]

    @reporting_damage
    def granting_files(self, o: int) -> Iterable[int]:
        """Return the files whose starting kitchen has a node although a unit of the file makes it."""
        rows = self.file.database.execute("SELECT file FROM granted WHERE node = ?", (o,))
        return [file for (file,) in rows]

    @reporting_damage
    def files_of(self, units: Iterable[int]) -> Iterable[int]:
        """Return the files that units are from, once for each copy of a unit."""
        rows = self.file.rows("SELECT file FROM source JOIN origin ON id = origin WHERE unit IN ids", units)
        return [file for (file,) in rows]

    @reporting_damage
    def units_of(self, file: int) -> Iterable[tuple[Sequence[int], Sequence[int]]]:
        """Return the inputs and outputs of each unit of a file, in the order of the file, each unit once."""
        rows = self.file.database.execute(UNITS_OF_FILE, (file,))
        return {unit: (decode_ids(inputs), decode_ids(outputs)) for unit, inputs, outputs in rows}.values()
