"""TeX formulas as MathML, which browsers lay out themselves.

`latex2mathml` converts; what it leaves to be desired is mended on the tree: commands that it does
not know inside of text and fences, operators that it takes for letters, and the spaces around
signs, bars and names of functions, which MathML's own dictionary sets for other uses.
"""

from __future__ import annotations

import itertools
import re
import unicodedata
from xml.etree import ElementTree as ET

from ...errors import SceneError, message

SPACE = "http://www.w3.org/1998/Math/MathML"
THIN = "0.167em"
TAG = re.compile(r"\\tag\{([^{}]*)\}")
FENCES = {"langle": "⟨", "rangle": "⟩", "lVert": "‖", "rVert": "‖", "|": "‖"}
FUNCTIONS = {
    *("arccos", "arcsin", "arctan", "argmax", "argmin", "cos", "cosh", "det", "exp", "gcd", "inf"),
    *("lim", "ln", "log", "max", "min", "mod", "sin", "sinh", "sup", "tan", "tanh"),
}
SCRIPTS = {"msub", "msup", "msubsup", "munder", "mover", "munderover"}
PARTS = {"mfrac": 2, "msub": 2, "msup": 2, "msubsup": 3, "munder": 2, "mover": 2, "munderover": 3}
NESTS = re.compile(r"(\\[{}]|[{}]|\\(?:qquad|left|right|begin|end)\b)")
CLOSING = ")]}|‖⟩⌋⌉′″‴!"


def split_tag(tex: str) -> tuple[str, str]:
    r"""A formula without its `\tag{...}`, and the tag; "" where there is none."""
    found = TAG.search(tex)
    return TAG.sub("", tex).strip(), found[1] if found else ""


def split_pieces(tex: str) -> list[str]:
    r"""The parts of a line of formulas that `\qquad` sets apart, which a narrow page may wrap."""
    pieces, depth = [""], 0
    for part in NESTS.split(tex):
        depth += (part in {"{", "\\left", "\\begin"}) - (part in {"}", "\\right", "\\end"})
        if part == "\\qquad" and depth == 0:
            pieces.append("")
        else:
            pieces[-1] += part
    return [piece.strip() for piece in pieces if piece.strip()]


def to_mathml(tex: str, *, display: bool) -> str:
    r"""MathML of a formula.

    Args:
        tex: without `$` and `\tag`.
        display: on lines of its own, not within a sentence.

    Raises:
        SceneError: the formula is wrong, or uses a command that is not known.
    """
    from latex2mathml.converter import convert

    ready = re.sub(r"\\mathrm\b", r"\\text", tex)  # whose single letters it would slant
    ready = re.sub(r"\{aligned\}", "{align*}", ready)  # which it knows
    try:
        text = convert(ready, display="block" if display else "inline")
        tree = ET.fromstring(text)
    except Exception as error:  # it raises a dozen kinds, none with a common base
        raise _bad(tex, repr(error)) from error
    if lacking := [each for each in tree.iter() if len(each) != PARTS.get(_name(each), len(each))]:
        raise _bad(tex, f"{_name(lacking[0])} with {len(lacking[0])} parts")
    _mend(tree)
    _strip_names(tree)
    if left := [each.text for each in tree.iter() if each.text and "\\" in each.text]:
        raise _bad(tex, f"{left[0]!r} left as it is")
    return ET.tostring(tree, encoding="unicode")


def _bad(tex: str, got: str) -> SceneError:
    expected = "a formula of TeX that latex2mathml knows"
    return SceneError(message("to_mathml", tex, expected, got, "write it in simpler commands"))


def _strip_names(tree: ET.Element) -> None:
    """In HTML, MathML needs no namespace but on the outermost element."""
    for each in tree.iter():
        each.tag = each.tag.rpartition("}")[2]
    tree.set("xmlns", SPACE)


def _mend(node: ET.Element) -> None:
    for child in node:
        _mend(child)
    text = (node.text or "").replace("\\_", "_")
    if text.startswith("\\"):
        text = FENCES.get(text[1:], text)
    node.text = text or None
    name = _name(node)
    if name == "mi" and len(text) == 1 and unicodedata.category(text) in {"Sm", "So", "Po"}:
        if text not in "∞∂∇":
            node.tag = f"{{{SPACE}}}mo"
    elif name == "mo" and len(node):  # of \mathrel{+}
        node.text = "".join(node.itertext())
        for child in list(node):
            node.remove(child)
    elif name == "msup" and len(node) == 2 and (node[1].text or "?") in "′″‴":
        node.tag, node[1].tag = f"{{{SPACE}}}mrow", f"{{{SPACE}}}mo"  # it is raised already
        node[1].attrib.update(lspace="0", rspace="0")
    elif name == "msubsup" and (node[2].text or "?") in "′″‴":
        _prime_within(node)
    if name in {"mrow", "math", "mtd", "mstyle", "msqrt"}:
        _join_relation(node)
        _set_spaces(node)


def _prime_within(node: ET.Element) -> None:
    """Of a letter with an index and a prime: the prime beside the letter, the index below both."""
    letter, index, prime = list(node)
    primed = ET.Element(f"{{{SPACE}}}mrow")
    prime.tag = f"{{{SPACE}}}mo"
    prime.attrib.update(lspace="0", rspace="0")
    primed.extend([letter, prime])
    node.tag = f"{{{SPACE}}}msub"
    node[:] = [primed, index]


def _join_relation(row: ET.Element) -> None:
    """A sign of its own before "=", as in "+=", is one operator with it."""
    items = list(row)
    for first, second in itertools.pairwise(items):
        if (first.text, second.text) in {("+", "="), ("-", "="), ("−", "=")}:
            row.remove(first)
            second.text = f"{first.text}="


def _set_spaces(row: ET.Element) -> None:
    previous: ET.Element | None = None
    for place, node in reversed(list(enumerate(row))):
        if _is_function(node) and _name(_base(node)) == "mi":
            _space_function(row, place)
    for node in row:
        text, name = node.text or "", _name(node)
        if (name == "mo" and text in {"|", "‖"}) or (name in SCRIPTS and _base(node).text == "|"):
            _base(node).set("lspace", "0")
            _base(node).set("rspace", "0")
        elif name == "mo" and text in {"−", "+", "±"} and _starts(previous):
            node.set("form", "prefix")
        elif _is_function(node) and _name(_base(node)) == "mo":
            _base(node).set("lspace", THIN)
            _base(node).set("rspace", THIN)
        previous = node


def _space_function(row: ET.Element, place: int) -> None:
    """Thin spaces between the name of a function and letters or numbers beside it."""
    after = row[place + 1] if place + 1 < len(row) else None
    if after is not None and _name(after) not in {"mo", "mspace"}:
        row.insert(place + 1, _thin())
    before = row[place - 1] if place else None
    closes = before is not None and (_name(before) != "mo" or (before.text or "?") in CLOSING)
    if before is not None and closes and _name(before) != "mspace":
        row.insert(place, _thin())


def _thin() -> ET.Element:
    return ET.Element(f"{{{SPACE}}}mspace", {"width": THIN})


def _starts(previous: ET.Element | None) -> bool:
    """Whether a sign after `previous` belongs to what follows, as in "= -x"."""
    if previous is None:
        return True
    name, text = _name(previous), previous.text or ""
    return name == "mspace" or (name == "mo" and (not text or text not in CLOSING))


def _is_function(node: ET.Element) -> bool:
    return (_base(node).text or "") in FUNCTIONS


def _base(node: ET.Element) -> ET.Element:
    while _name(node) in SCRIPTS and len(node):
        node = node[0]
    return node


def _name(node: ET.Element) -> str:
    return node.tag.rpartition("}")[2]
