"""The body of a handout's page: headings, figures, equations and what refers to them."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from html import escape
from typing import TYPE_CHECKING, Any

from .mathematics import split_pieces, split_tag, to_mathml
from .references import Kind, Names, Prose

if TYPE_CHECKING:
    from markdown_it import MarkdownIt
    from markdown_it.token import Token

CAPTION = re.compile(r"Figure (\d+)\.")
VALUES = re.compile(r"(?:Check values|Values to check)\b")
CITED = re.compile(r"\[([A-Z][A-Za-z-]+\d{4}[a-z]?)\] ")
LONG, LONGER = 69, 84  # characters of a formula that is set smaller, to fit the column
NUMBERED = re.compile(r"(\d+)\. ")


@dataclass
class Handout:
    """What a page is made of.

    Attributes:
        title: of the assignment.
        body: HTML.
        sections: id and text of each section's heading.
    """

    title: str
    body: str
    sections: list[tuple[str, str]] = field(default_factory=list)


def read_handout(markdown: str, glossary: Mapping[str, str]) -> Handout:
    """Parse and render; see `page.handout_page` for arguments and errors."""
    parser = _parser()
    tokens = _figures(parser.parse(markdown))
    names = _names(tokens)
    sections = _headings(tokens)
    title = next((t.content for t in _after(tokens, "h1")), "Handout")
    prose = Prose(names, glossary)
    for token in tokens:
        if token.type == "inline":
            token.children = _joined(token.children or [])
    body = parser.renderer.render(tokens, parser.options, {"prose": prose})
    return Handout(title, body + prose.words(), sections)


def _parser() -> MarkdownIt:
    from markdown_it import MarkdownIt
    from mdit_py_plugins.dollarmath import dollarmath_plugin

    parser = MarkdownIt("commonmark", {"html": False}).enable("table")
    parser.use(dollarmath_plugin, allow_labels=False, double_inline=True)
    for kind in ("text", "math_inline", "math_inline_double", "math_block", "image", "fence"):
        parser.add_render_rule(kind, globals()[f"_render_{kind}"])
    for kind in ("paragraph_open", "heading_open", "table_open", "table_close"):
        parser.add_render_rule(kind, globals()[f"_render_{kind}"])
    return parser


def _figures(tokens: list[Token]) -> list[Token]:
    """A picture alone and the caption below it become a figure."""
    made: list[Token] = []
    at = 0
    while at < len(tokens):
        picture, caption = tokens[at : at + 3], tokens[at + 3 : at + 6]
        if not _is_picture(picture):
            made.append(tokens[at])
            at += 1
            continue
        opened, shown, closed = picture
        opened.tag = closed.tag = "figure"
        found = _caption_of(caption)
        if found is None:
            made += picture
            at += 3
            continue
        opened.attrSet("id", f"fig-{found}")
        caption[0].tag = caption[2].tag = "figcaption"
        made += [opened, shown, *caption, closed]
        at += 6
    return made


def _is_picture(tokens: Sequence[Token]) -> bool:
    if len(tokens) < 3 or tokens[0].type != "paragraph_open":
        return False
    children = tokens[1].children or []
    return len(children) == 1 and children[0].type == "image"


def _caption_of(tokens: Sequence[Token]) -> str | None:
    if len(tokens) < 3 or tokens[0].type != "paragraph_open":
        return None
    found = CAPTION.match(tokens[1].content.lstrip("*"))
    return found[1] if found else None


def _names(tokens: Sequence[Token]) -> Names:
    """What a page can refer to; each gets an id."""
    names = Names()
    item: Token | None = None
    for token in tokens:
        if token.type == "math_block" and (tag := split_tag(token.content)[1]):
            names.equations.add(tag)
        elif token.tag == "figure" and "id" in token.attrs:
            names.figures.add(str(token.attrs["id"]).removeprefix("fig-"))
        elif token.type == "list_item_open":
            item = token
        elif token.type == "inline" and item is not None:
            if cited := CITED.match(token.content):
                item.attrSet("id", cited[1])
                names.cited.add(cited[1])
            item = None
    headings = [tokens[at + 1] for at, each in enumerate(tokens) if each.type == "heading_open"]
    numbers = [NUMBERED.match(each.content) for each in headings]
    names.sections.update(number[1] for number in numbers if number)
    return names


def _headings(tokens: Sequence[Token]) -> list[tuple[str, str]]:
    """Give each heading an id; id and text of those of the second level."""
    taken: dict[str, int] = {}
    sections = []
    for at, token in enumerate(tokens):
        if token.type != "heading_open":
            continue
        text = tokens[at + 1].content.replace("`", "").replace("*", "")
        number = NUMBERED.match(text)
        plain = re.sub(r"[^a-z0-9]+", "-", text.lower()).strip("-")
        name = f"section-{number[1]}" if number else plain or "section"
        taken[name] = taken.get(name, 0) + 1
        if taken[name] > 1:
            name = f"{name}-{taken[name]}"
        token.attrSet("id", name)
        if token.tag == "h2":
            sections.append((name, text))
    return sections


def _after(tokens: Sequence[Token], tag: str) -> list[Token]:
    return [tokens[at + 1] for at, token in enumerate(tokens[:-1]) if _opens(token, tag)]


def _opens(token: Token, tag: str) -> bool:
    return token.type == "heading_open" and token.tag == tag


def _joined(children: Sequence[Token]) -> list[Token]:
    """Texts and the line ends between them as one, so that what is broken over lines is seen."""
    joined: list[Token] = []
    for child in children:
        if child.type == "softbreak":
            child.type, child.content = "text", " "
        if child.type == "text" and joined and joined[-1].type == "text":
            joined[-1].content += child.content
        else:
            joined.append(child)
    return joined


# Rules of the renderer: (renderer, tokens, place, options, env) -> HTML.


def _render_paragraph_open(_self: Any, tokens: Any, at: int, _options: Any, env: Any) -> str:
    token = tokens[at]
    content = tokens[at + 1].content.lstrip("*")
    if CITED.match(content):
        kind = Kind.CITED
    elif token.tag == "figcaption":
        kind = Kind.CAPTION
    else:
        kind = Kind.VALUES if VALUES.match(content) else Kind.TEXT
    env["prose"].begin(kind)
    if token.hidden:
        return ""
    name = f' id="{token.attrs["id"]}"' if "id" in token.attrs else ""
    return f"<{token.tag}{name}>"


def _render_heading_open(_self: Any, tokens: Any, at: int, _options: Any, env: Any) -> str:
    token = tokens[at]
    env["prose"].begin(Kind.CAPTION)
    return f'<{token.tag} id="{token.attrs["id"]}">'


def _render_text(_self: Any, tokens: Any, at: int, _options: Any, env: Any) -> str:
    linked = any(t.type == "link_open" for t in tokens[:at])
    return str(env["prose"].html(tokens[at].content, links=not linked))


def _render_math_inline(_self: Any, tokens: Any, at: int, _options: Any, _env: Any) -> str:
    return to_mathml(tokens[at].content, display=False)


def _render_math_inline_double(_self: Any, tokens: Any, at: int, options: Any, env: Any) -> str:
    return _render_math_block(_self, tokens, at, options, env)


def _render_math_block(_self: Any, tokens: Any, at: int, _options: Any, _env: Any) -> str:
    tex, tag = split_tag(tokens[at].content)
    name = f' id="eq-{tag}"' if tag else ""
    called = f"Equation {tag}" if tag else "Formula"
    number = f'<span class="number">({escape(tag)})</span>' if tag else ""
    pieces = [to_mathml(piece, display=True) for piece in split_pieces(tex)]
    shown = "".join(pieces)
    length = max(_length(piece) for piece in pieces)
    size = " longer" if length > LONGER else " long" if length > LONG else ""
    return (
        f'<div class="equation{size}"{name}><div class="scroll" tabindex="0" role="group" '
        f'aria-label="{called}">{shown}</div>{number}</div>\n'
    )


def _length(mathml: str) -> int:
    """Characters on the longest line of a formula, about; a fraction counts with both parts."""
    rows = re.split(r"</mtr>", mathml)
    return max(len(re.sub(r"<[^>]*>", "", row)) for row in rows)


def _render_image(_self: Any, tokens: Any, at: int, _options: Any, _env: Any) -> str:
    token = tokens[at]
    return f'<img src="{escape(str(token.attrs["src"]))}" alt="{escape(token.content)}">'


def _render_fence(_self: Any, tokens: Any, at: int, _options: Any, _env: Any) -> str:
    shown = escape(tokens[at].content, quote=False)
    button = '<button type="button" class="copy">copy</button>'
    return f'<div class="code">{button}<pre tabindex="0"><code>{shown}</code></pre></div>\n'


def _render_table_open(_self: Any, _tokens: Any, _at: int, _options: Any, _env: Any) -> str:
    return '<div class="table" tabindex="0" role="group" aria-label="Table"><table>\n'


def _render_table_close(_self: Any, _tokens: Any, _at: int, _options: Any, _env: Any) -> str:
    return "</table></div>\n"
