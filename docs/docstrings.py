"""Docstrings of this repository as reStructuredText.

They are plain text with three conventions: names between backticks, sections in Google's style,
and indented blocks that stay as they are (formulas, code, tables). All else that docutils would
take for markup, as in |x| or a * b, is escaped. A key such as [Kerbl2023, eq. 7] becomes a link.
"""

from __future__ import annotations

import re
from pathlib import Path

BIBLIOGRAPHY = Path(__file__).resolve().parents[1] / "cpp/references.bib"
KEYS = frozenset(re.findall(r"^@\w+\{(\w+),$", BIBLIOGRAPHY.read_text(encoding="utf-8"), re.M))

_BRACKETS = re.compile(r"\[[A-Z]\w*\d{4}\w*[^\]]*\]")
_CODE = re.compile(r"(``.+?``|:\w+:`[^`]+`|`[^`]+`)", re.DOTALL)
_SECTION = re.compile(r"(Args|Returns|Raises|Yields|Fields|Examples?|Note):$")
_ITEM = re.compile(r"(-|\*|\d+\.) ")


def link_citations(text: str) -> str:
    """The text with a link to the bibliography in place of each key in brackets."""

    def linked(match: re.Match[str]) -> str:
        return re.sub(
            r"\w+", lambda key: f":cite:label:`{key[0]}`" if key[0] in KEYS else key[0], match[0]
        )

    return _BRACKETS.sub(linked, text)


def escape(text: str) -> str:
    """Prose with what looks like markup escaped, names between backticks excepted."""
    parts = _CODE.split(text)
    parts[::2] = [
        re.sub(r"(\w)_(?!\w)", r"\1\_", re.sub(r"[*|\\]", r"\\\g<0>", part)) for part in parts[::2]
    ]
    # `Target`s: docutils wants a mark between markup and letters.
    parts[2::2] = [re.sub(r"^(?=\w)", r"\\ ", part) for part in parts[2::2]]
    return link_citations("".join(parts))


def to_rst(lines: list[str]) -> list[str]:
    """The lines of a docstring, dedented, as napoleon and docutils want them."""
    done: list[str] = []
    prose: list[str] = []
    literal = section = item = False

    def flush() -> None:
        done.extend(escape("\n".join(prose)).split("\n") if prose else [])
        prose.clear()

    # Attributes of one name in many classes would be taken for targets of links.
    for line in ("Fields:" if line == "Attributes:" else line for line in lines):
        indented = line.startswith(" ")
        if line and not indented:
            literal = False
            section = bool(_SECTION.match(line)) or (section and not _blank_before(prose, done))
            item = bool(_ITEM.match(line)) or (item and not _blank_before(prose, done))
        if line.lstrip().startswith((">>>", "...")):
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
