"""Marked regions of an instructor's source, found by the tokenizer.

    # >>> solution 01.2        one task's solution; a stub takes its place
    # <<< solution
    # >>> student              comment lines: the stub, where the default one will not do; directly
    # <<< student              below the solution it stands in for

A marker is a comment with a line of its own. The same characters inside a string mean nothing.
"""

from __future__ import annotations

import io
import re
import tokenize
from dataclasses import dataclass

from ..errors import SceneError, message

KINDS = ("solution", "student")
_LOOKS = re.compile(r"#\s*(>>>|<<<)")
_OPEN = re.compile(r"# >>> (solution|student)(?: (\d\d\.\w+))?")
_CLOSE = re.compile(r"# <<< (solution|student)")


class RegionError(SceneError):
    """A marker that is misnamed, nested, or has no partner; says file and line."""


@dataclass(frozen=True)
class Region:
    """Lines from one marker to its partner, counted from 1, both included.

    Attributes:
        kind: one of KINDS.
        task: such as "01.2"; empty except for solutions.
        first, last: the lines of the two markers.
        indent: spaces before the first marker.
    """

    kind: str
    task: str
    first: int
    last: int
    indent: int


def find_regions(text: str, file: str = "source") -> tuple[Region, ...]:
    """The regions of a text, in order.

    Args:
        text: Python source.
        file: its name, for messages.

    Raises:
        RegionError: a marker is misnamed, nested or without partner, or the text is no Python.
    """
    regions: list[Region] = []
    begun: Region | None = None
    for line, column, comment, alone in _comments(text, file):
        if not _LOOKS.match(comment):
            continue
        if not alone:
            raise region_error(file, line, "a marker with a line of its own", comment)
        opens, closes = _OPEN.fullmatch(comment), _CLOSE.fullmatch(comment)
        if opens:
            if begun is not None:
                raise region_error(file, line, f"'# <<< {begun.kind}' first", comment)
            begun = _begin(opens, file, line, column)
        elif closes:
            if begun is None or closes[1] != begun.kind:
                wanted = "no end here" if begun is None else f"'# <<< {begun.kind}'"
                raise region_error(file, line, wanted, comment)
            regions.append(Region(begun.kind, begun.task, begun.first, line, begun.indent))
            begun = None
        else:
            raise region_error(file, line, f"a marker of {sorted(KINDS)}", comment)
    if begun is not None:
        raise region_error(file, begun.first, f"'# <<< {begun.kind}' below", "the end of the file")
    return tuple(regions)


def _begin(match: re.Match[str], file: str, line: int, column: int) -> Region:
    kind, task = match[1], match[2] or ""
    if (kind == "solution") != bool(task):
        wanted = "'# >>> solution NN.k'" if kind == "solution" else f"'# >>> {kind}' alone"
        raise region_error(file, line, wanted, match[0])
    return Region(kind, task, line, line, column)


def _comments(text: str, file: str) -> list[tuple[int, int, str, bool]]:
    """Line, column and text of each comment, and whether it has the line to itself."""
    try:
        tokens = list(tokenize.generate_tokens(io.StringIO(text).readline))
    except (tokenize.TokenError, SyntaxError) as error:
        line = error.args[1][0] if isinstance(error, tokenize.TokenError) else error.lineno or 0
        raise region_error(file, line, "Python", str(error.args[0])) from error
    return [
        (token.start[0], token.start[1], token.string, not token.line[: token.start[1]].strip())
        for token in tokens
        if token.type == tokenize.COMMENT
    ]


def region_error(file: str, line: int, expected: str, got: str) -> RegionError:
    """The error about one line of a file, in the form that all errors have."""
    return RegionError(message("find_regions", f"{file}, line {line}", expected, got))
