"""The elements of an SVG file, read with suspicion.

A file from elsewhere may define entities that grow a thousandfold, or name other files. Document
types are refused, and with them all entities but the five of XML itself; so are references that
leave the file. Sizes, elements and depths are bounded.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path
from xml.parsers import expat

from photograd_course.input_files import require_file
from photograd_course.limits import SVG_BYTES

from photograd.errors import IoError, message
from photograd.vector.svg_path import refused

MOST_ELEMENTS = 1 << 18
MOST_DEPTH = 64
SVG = "http://www.w3.org/2000/svg"
_ELSEWHERE = re.compile(r"url\(\s*['\"]?(?!#)", re.IGNORECASE)


@dataclass
class Element:
    """One element.

    Attributes:
        tag: its name, without the namespace of SVG.
        attributes: with those of `style` among them, which win.
        children: in their order.
    """

    tag: str
    attributes: dict[str, str]
    children: list[Element] = field(default_factory=list)


def read_tree(source: str | Path | bytes) -> Element:
    """The root of a file.

    Args:
        source: path of the file, or its bytes.

    Raises:
        IoError: not there, too large or too deep, no XML, a document type or an entity, a reference
            that leaves the file.
    """
    if isinstance(source, bytes):
        data, size = source, len(source)
    else:
        size = require_file("read_svg", Path(source))
        data = b"" if size > SVG_BYTES.value() else Path(source).read_bytes()
    if size > SVG_BYTES.value():
        raise IoError(
            message("read_svg", "source", SVG_BYTES.expected(), f"{size:,}", SVG_BYTES.remedy())
        )
    builder = _Builder()
    try:
        builder.parser.Parse(data, True)
    except expat.ExpatError as failure:
        raise IoError(message("read_svg", "source", "XML", failure)) from failure
    assert builder.root is not None
    return builder.root


class _Builder:
    """Makes elements of what expat calls."""

    def __init__(self) -> None:
        self.root: Element | None = None
        self._open: list[Element] = []
        self._count = 0
        self.parser = expat.ParserCreate(namespace_separator=" ")
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end
        self.parser.StartDoctypeDeclHandler = self._refuse_doctype
        self.parser.EntityDeclHandler = self._refuse_doctype
        self.parser.ExternalEntityRefHandler = self._refuse_doctype
        self.parser.SetParamEntityParsing(expat.XML_PARAM_ENTITY_PARSING_NEVER)

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        self._count += 1
        if self._count > MOST_ELEMENTS or len(self._open) >= MOST_DEPTH:
            limits = f"up to {MOST_ELEMENTS} elements, {MOST_DEPTH} deep"
            raise IoError(message("read_svg", "source", limits, "more"))
        space, _, tag = name.rpartition(" ")
        element = Element(tag if space in (SVG, "") else name, _with_style(tag, attributes))
        if self._open:
            self._open[-1].children.append(element)
        elif element.tag != "svg":
            raise refused("source", "an element svg first", tag)
        else:
            self.root = element
        self._open.append(element)

    def _end(self, _name: str) -> None:
        self._open.pop()

    def _refuse_doctype(self, *_arguments: object) -> int:
        expected = "a file without a document type and without entities"
        remedy = "remove the line <!DOCTYPE ...>, if you trust the file"
        raise IoError(message("read_svg", "source", expected, "one", remedy))


def _with_style(tag: str, attributes: dict[str, str]) -> dict[str, str]:
    found = {name: value for name, value in attributes.items() if name != "style"}
    for part in attributes.get("style", "").split(";"):
        name, colon, value = part.partition(":")
        if colon:
            found[name.strip()] = value.strip()
    for name, value in found.items():
        link = name.endswith("href") and not value.startswith("#")
        if (link and tag != "a") or _ELSEWHERE.search(value):
            raise refused(f"{name} of {tag}", "a reference within the file", value[:40])
    return found
