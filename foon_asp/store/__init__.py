"""A network on disk, of which a question reads only what it is about."""

from foon_asp.store.import_files import Imported as Imported
from foon_asp.store.import_files import import_files as import_files
from foon_asp.store.store import Store as Store
