"""Docstrings of this repository as reStructuredText.

They are plain text with three conventions: names between backticks, sections in Google's style,
and indented blocks that stay as they are (formulas, code, tables). All else that docutils would
take for markup, as in |x| or a * b, is escaped. A key such as [Kerbl2023, eq. 7] becomes a link, as
does a file of the core, cpp/photograd/ops/composite.h: the pages in `SOURCES` show those.
"""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
BIBLIOGRAPHY = ROOT / "cpp/references.bib"
SOURCES = "api/sources"
"""Where the book shows files of the core that docstrings name."""
KEYS = frozenset(re.findall(r"^@\w+\{(\w+),$", BIBLIOGRAPHY.read_text(encoding="utf-8"), re.M))

_BRACKETS = re.compile(r"\[[A-Z]\w*\d{4}\w*[^\]]*\]")
_CODE = re.compile(r"(``.+?``|:\w+:`[^`]+`|`[^`]+`)", re.DOTALL)
_SOURCE = re.compile(r"\bcpp/photograd/([\w/]+\.h)\b")
_PAGE = re.compile(r"\bdocs/(\w+)\.md\b")
_SECTION = re.compile(r"(Args|Returns|Raises|Yields|Fields|Examples?|Note):$")
_ITEM = re.compile(r"(-|\*|\d+\.) ")


def link_citations(text: str) -> str:
    """The text with a link to the bibliography in place of each key in brackets."""

    def linked(match: re.Match[str]) -> str:
        return re.sub(
            r"\w+", lambda key: f":cite:label:`{key[0]}`" if key[0] in KEYS else key[0], match[0]
        )

    return _BRACKETS.sub(linked, text)


def sources_in(text: str) -> list[str]:
    """Files of the core that a docstring names, below cpp/photograd/."""
    return _SOURCE.findall(text)


def link_sources(text: str) -> str:
    """The text with a link in place of each file of the core, and of each page of the book."""
    text = _PAGE.sub(r":doc:`/\1`", text)
    return _SOURCE.sub(lambda match: f":doc:`{match[1]} </{SOURCES}/{page_name(match[1])}>`", text)


def page_name(source: str) -> str:
    """The name of the page that shows a file of the core."""
    return source.removesuffix(".h").replace("/", ".")


def escape(text: str) -> str:
    """Prose with what looks like markup escaped, names between backticks excepted."""
    parts = _CODE.split(text)
    parts[::2] = [
        re.sub(r"(\w)_(?!\w)", r"\1\_", re.sub(r"[*|\\]", r"\\\g<0>", part)) for part in parts[::2]
    ]
    # `Target`s: docutils wants a mark between markup and letters.
    parts[2::2] = [re.sub(r"^(?=\w)", r"\\ ", part) for part in parts[2::2]]
    return link_sources(link_citations("".join(parts)))


def to_rst(lines: list[str], *, is_property: bool = False) -> list[str]:
    """The lines of a docstring, dedented, as napoleon and docutils want them."""
    done: list[str] = []
    prose: list[str] = []
    literal = section = item = example = False

    def flush() -> None:
        done.extend(escape("\n".join(prose)).split("\n") if prose else [])
        prose.clear()

    # Napoleon takes what stands before a colon in the first line of a property for its type; an
    # empty comment stands in for that line.
    if is_property:
        lines = ["..", "", *lines]
    # Attributes of one name in many classes would be taken for targets of links.
    for line in ("Fields:" if line == "Attributes:" else line for line in lines):
        indented = line.startswith(" ")
        if line and not indented:
            literal = False
            section = bool(_SECTION.match(line)) or (section and not _blank_before(prose, done))
            item = bool(_ITEM.match(line)) or (item and not _blank_before(prose, done))
        example = bool(line) and (example or line.lstrip().startswith(">>>"))
        if example:
            flush()
            done.append(line)
        elif indented and not section and not item:
            if not literal:
                flush()
                done.extend(["", "::", ""])
                literal = True
            done.append(line)
        else:
            if literal is False and done and done[-1].startswith(" ") and not prose and line:
                done.append("")
            prose.append(line)
    flush()
    return done


def _blank_before(prose: list[str], done: list[str]) -> bool:
    """Whether the line before is blank, or there is none."""
    before = prose or done
    return not before or not before[-1]
