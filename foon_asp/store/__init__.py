"""A network on disk, of which a question reads only what it is about."""

from foon_asp.store.import_files import Imported, import_files
from foon_asp.store.store import Store

__all__ = ["Imported", "Store", "import_files"]
