"""Functions of a C++ source and their lengths, read from its braces, without a compiler."""

from __future__ import annotations

import re
from typing import NamedTuple

# Raw strings, comments, strings and characters (not the ' of 1'000), preprocessor lines.
_HIDDEN = re.compile(
    r'R"(\w*)\((?:.|\n)*?\)\1"|//[^\n]*|/\*(?:.|\n)*?\*/|"(?:\\.|[^"\\\n])*"'
    r"|(?<![0-9A-Fa-f])'(?:\\.|[^'\\\n])+'|^[ \t]*#(?:\\\n|[^\n])*",
    re.MULTILINE,
)
_CONTAINER = re.compile(r"(?:^|>|\s)(?:namespace|class|struct|union|enum|extern)\b")
_NAME = re.compile(r"([~\w:]+|operator\s*\S+?)\s*\(")


class CppFunction(NamedTuple):
    """A function, or a lambda that stands outside of one; `line` counts from 1."""

    name: str
    line: int
    lines: int


def blanked(text: str) -> str:
    """The text with comments, literals and preprocessor lines as blanks, its lines in place."""
    return _HIDDEN.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)


def _opens_function(head: str) -> bool:
    without_templates = re.sub(r"^\s*template\s*<(?:[^<>]|<[^<>]*>)*>", "", head)
    before = without_templates.partition("(")
    return bool(before[1]) and not _CONTAINER.search(before[0])


def functions(text: str) -> list[CppFunction]:
    """All functions with a body, in the order of their ends."""
    source = blanked(text)
    found, starts = [], []  # of each open brace: where its function's head starts, or None
    head, inside, depth = 0, 0, 0
    for at, sign in enumerate(source):
        if sign in "()":
            depth += 1 if sign == "(" else -1
        elif sign == "{":
            begin = None
            if not inside and depth == 0 and _opens_function(source[head:at]):
                begin = head + len(source[head:at]) - len(source[head:at].lstrip())
            inside += begin is not None
            starts.append(begin)
            if begin is None and depth == 0:
                head = at + 1
        elif sign == "}" and starts:
            begin = starts.pop()
            if begin is not None:
                inside -= 1
                line = source.count("\n", 0, begin) + 1
                names = _NAME.search(source, begin, at)
                name = names[1] if names else "?"
                found.append(CppFunction(name, line, source.count("\n", begin, at) + 1))
            if depth == 0:
                head = at + 1
        elif sign == ";" and depth == 0:
            head = at + 1
    return found
