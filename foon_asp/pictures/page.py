"""A page of HTML that is whole in itself: data, code and looks in one file, and no request leaves it.

What it is made of is in the folder ``web``, written for this page. Its policy allows the scripts and styles
in it by their digests and nothing else, so whatever a name in the data may be, it is shown and never run.
"""

import base64
import hashlib
import html
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

from foon_asp.escapes import UNSAFE
from foon_asp.text.json_value import Json, json_line
from foon_asp.whole_file import utf_8, write_whole

WEB = Path(__file__).resolve().parent / "web"

_SCRIPTS = (
    "element",
    "movable",
    "layout",
    "tree",
    "page",
    "obstacle",
    "answers",
    "proof",
    "network",
    "start",
)


class Page(NamedTuple):
    """A page: its title, a text for browsers without scripts, and the data that it shows."""

    title: str
    text: str
    data: Json

    def html(self) -> str:
        """Give the page, a document by itself."""
        light, picture, dark, page = (web(f"{name}.css") for name in ("light", "picture", "dark", "page"))
        script = '"use strict";\n(() => {\n' + "\n".join(web(f"{name}.js") for name in _SCRIPTS) + "})();\n"
        styles = {"light": light, "picture": picture, "page": dark + page}
        return web("page.html").format(
            title=html.escape(_seen(self.title)),
            text=html.escape(_seen(self.text)),
            data=in_script(self.data),
            scripts=digest(script),
            styles=" ".join(map(digest, styles.values())),
            style="\n".join(f'<style id="{name}">{text}</style>' for name, text in styles.items()),
            script=f"<script>{script}</script>",
        )

    def write(self, file: str | Path) -> None:
        """Write the page into a file; raises :class:`UserError` if it cannot be written."""
        write_whole(Path(file), utf_8(self.html()))

    def frame(self) -> str:
        """Give HTML that shows the page inside another one, from which it is cut off."""
        return (
            '<iframe sandbox="allow-scripts allow-downloads allow-modals" title="task tree" '
            f'style="width:100%;height:640px;border:1px solid #ccc" srcdoc="{html.escape(self.html())}">'
            "</iframe>"
        )

    def _repr_mimebundle_(
        self, include: Iterable[str] | None = None, exclude: Iterable[str] | None = None
    ) -> dict[str, str]:
        """Give what a notebook shows."""
        return {"text/plain": f"<Page: {self.title}>", "text/html": self.frame()}


def web(name: str, folder: Path = WEB) -> str:
    """Give a file that pages are made of."""
    return (folder / name).read_text(encoding="utf-8")


def digest(text: str) -> str:
    """Give the digest of a script or style, as a policy names what it allows."""
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


def in_script(data: Json) -> str:
    """Write data into a script, which ends at </script>: that is nowhere in them with < as a number."""
    return json_line(data).replace("<", "\\u003c")


def _seen(text: str) -> str:
    return UNSAFE.sub("\ufffd", text)
