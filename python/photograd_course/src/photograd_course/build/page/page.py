"""A handout of Markdown with formulas as one page of HTML."""

from __future__ import annotations

import base64
import hashlib
import re
from collections.abc import Mapping
from functools import lru_cache
from html import escape
from pathlib import Path

from .handout import Handout, read_handout

HERE = Path(__file__).parent
FIGURE = re.compile(r'src="(figures/[\w.-]+)"')
POLICY = "default-src 'none'; img-src 'self' data:; style-src 'unsafe-inline'; font-src data:; "


def handout_page(markdown: str, glossary: Mapping[str, str] | None = None) -> str:
    """HTML of a handout; its figures are named by path, see `with_figures`.

    Args:
        markdown: with formulas between `$$` and `$`.
        glossary: words that are explained where they first stand, and by which sentence.

    Raises:
        SceneError: a formula cannot be rendered.
    """
    handout = read_handout(markdown, glossary or {})
    script = _text("page.js")
    return (
        "<!doctype html>\n"
        '<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f"<title>{escape(handout.title)}</title>\n"
        f"{_security(script)}"
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        '<meta name="color-scheme" content="light dark">\n'
        f"<style>\n{_font()}{_text('page.css')}</style>\n</head>\n<body>\n"
        '<a class="skip" href="#text">Skip to the text</a>\n'
        f'{_contents(handout)}<main id="text">\n{handout.body}</main>\n'
        '<p id="said" role="status" aria-live="polite"></p>\n'
        f"<script>{script}</script>\n</body>\n</html>\n"
    )


def with_figures(page: str, files: Mapping[str, bytes]) -> str:
    """The page with its figures inside, so that it can be moved alone.

    Args:
        page: of `handout_page`.
        files: of the kit, by path; a figure that is not there stays named by its path.
    """

    def inside(found: re.Match[str]) -> str:
        data = files.get(found[1])
        if data is None:
            return found[0]
        return f'src="data:image/png;base64,{base64.b64encode(data).decode()}"'

    return FIGURE.sub(inside, page)


def _contents(handout: Handout) -> str:
    rows = "".join(
        f'<li><a href="#{name}">{escape(text)}</a></li>\n' for name, text in handout.sections
    )
    if not rows:
        return ""
    return (
        '<nav aria-label="Sections"><details open><summary>Sections</summary>'
        f"<ol>\n{rows}</ol></details></nav>\n"
    )


def _security(script: str) -> str:
    """Nothing from outside, and no script but this one."""
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    content = f"{POLICY}script-src 'sha256-{digest}'"
    return f'<meta http-equiv="Content-Security-Policy" content="{content}">\n'


@lru_cache
def _font() -> str:
    data = base64.b64encode((HERE / "mathematics.woff2").read_bytes()).decode()
    source = f"url(data:font/woff2;base64,{data}) format('woff2')"
    return f"@font-face {{ font-family: Mathematics; src: {source}; }}\n"


@lru_cache
def _text(name: str) -> str:
    return (HERE / name).read_text(encoding="utf-8")
