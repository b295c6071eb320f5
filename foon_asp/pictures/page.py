"""A self-contained page of HTML: data, scripts and styles in one file, which makes no requests.

The folder ``web`` has the parts of the page. The content security policy of the page allows only its scripts
and styles, by their digests, so that no name in the data is ever executed as code.
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
        """Return the page as a complete HTML document."""
        light, picture, dark, page = (web(f"{name}.css") for name in ("light", "picture", "dark", "page"))
        script = '"use strict";\n(() => {\n' + "\n".join(web(f"{name}.js") for name in _SCRIPTS) + "})();\n"
        styles = {"light": light, "picture": picture, "page": dark + page}
        return web("page.html").format(
            title=html.escape(_visible(self.title)),
            text=html.escape(_visible(self.text)),
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
        """Return HTML that shows the page inside another one, in a sandboxed frame."""
        return (
            '<iframe sandbox="allow-scripts allow-downloads allow-modals" title="task tree" '
            f'style="width:100%;height:640px;border:1px solid #ccc" srcdoc="{html.escape(self.html())}">'
            "</iframe>"
        )

    def _repr_mimebundle_(
        self, include: Iterable[str] | None = None, exclude: Iterable[str] | None = None
    ) -> dict[str, str]:
        """Return the MIME bundle that a notebook shows."""
        return {"text/plain": f"<Page: {self.title}>", "text/html": self.frame()}


def web(name: str, folder: Path = WEB) -> str:
    """Return the text of a file of the folder ``web``."""
    return (folder / name).read_text(encoding="utf-8")


def digest(text: str) -> str:
    """Return the digest of a script or style in the syntax of a content security policy."""
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


def in_script(data: Json) -> str:
    """Return data as JSON that can stand in a script: ``<`` is escaped, so that no ``</script>`` ends it."""
    return json_line(data).replace("<", "\\u003c")


def _visible(text: str) -> str:
    return UNSAFE.sub("\ufffd", text)
