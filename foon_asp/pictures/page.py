"""A self-contained HTML page: data, scripts and styles are in one file, which makes no requests.

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
from foon_asp.json_layout import Json, json_line
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
    """A page of HTML.

    ``title``: the title of the page.
    ``text``: the text that browsers without scripts show.
    ``data``: the data that the scripts of the page show.
    """

    title: str
    text: str
    data: Json

    def html(self) -> str:
        """Return the page as a complete HTML document."""
        light, picture, dark, page = (
            web_text(f"{name}.css") for name in ("colours_light", "picture", "colours_dark", "page")
        )
        script = (
            '"use strict";\n(() => {\n' + "\n".join(web_text(f"{name}.js") for name in _SCRIPTS) + "})();\n"
        )
        styles = {"light": light, "picture": picture, "page": dark + page}
        return web_text("page.html").format(
            title=html.escape(_replace_unsafe(self.title)),
            text=html.escape(_replace_unsafe(self.text)),
            data=script_json(self.data),
            scripts=digest(script),
            styles=" ".join(map(digest, styles.values())),
            style="\n".join(f'<style id="{name}">{text}</style>' for name, text in styles.items()),
            script=f"<script>{script}</script>",
        )

    def write(self, file: str | Path) -> None:
        """Write the page to a file, completely or not at all; raises :class:`UserError` if it fails."""
        write_whole(Path(file), utf_8(self.html()))

    def frame(self) -> str:
        """Return HTML that shows the page within another page, in a sandboxed frame."""
        return (
            '<iframe sandbox="allow-scripts allow-downloads allow-modals" title="task tree" '
            f'style="width:100%;height:640px;border:1px solid #ccc" srcdoc="{html.escape(self.html())}">'
            "</iframe>"
        )

    def _repr_mimebundle_(
        self, include: Iterable[str] | None = None, exclude: Iterable[str] | None = None
    ) -> dict[str, str]:
        """Return the MIME bundle by which a notebook shows the page; the parameters are ignored."""
        return {"text/plain": f"<Page: {self.title}>", "text/html": self.frame()}


def web_text(name: str, folder: Path = WEB) -> str:
    """Return the text of a file in the folder ``web``, or in another folder."""
    return (folder / name).read_text(encoding="utf-8")


def digest(text: str) -> str:
    """Return the SHA-256 digest of a script or style, as a content security policy states it."""
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


def script_json(data: Json) -> str:
    """Return data as JSON that can stand in a script.

    ``<`` is escaped, so that no ``</script>`` in the data ends the script.
    """
    return json_line(data).replace("<", "\\u003c")


def _replace_unsafe(text: str) -> str:
    """Return a text with U+FFFD for every invisible or misleading character."""
    return UNSAFE.sub("\ufffd", text)
