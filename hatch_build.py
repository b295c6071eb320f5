"""What a build does beside packing: an editable install compiles the package, as pip does with copies.

Else every start compiles it again where Python may not keep what it compiled: a third of a short question.
"""

import compileall
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class CompileEditable(BuildHookInterface):  # type: ignore[type-arg]
    """Compiles ``foon_asp`` in the checkout when it is installed from there."""

    PLUGIN_NAME = "custom"

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Compile before an editable wheel is built; a file that is changed later is compiled anew."""
        del build_data
        if version == "editable":
            compileall.compile_dir(Path(self.root, "foon_asp"), quiet=1)
