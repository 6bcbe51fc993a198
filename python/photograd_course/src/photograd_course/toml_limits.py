"""TOML parsed within limits: every TOML text that comes from outside passes through here.

`tomllib` keeps each prefix of a dotted key, so its time and memory grow with the square of the
number of parts: 100 kB of `a.a.a...` take more than a minute.
"""

from __future__ import annotations

import re
import sys
from itertools import accumulate
from typing import Any

from .errors import IoError, message
from .limits import TOML_BYTES

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

MOST_PARTS = 16
MOST_NESTING = 32
# Strings and comments. One that is not closed runs to the end of the text or line: the parser
# refuses it there, and the pattern never starts over within it, so matching takes linear time.
_OPAQUE = re.compile(
    r'"""(?:[^"\\]+|\\.?|"(?!""))*(?:"{3,5}|\Z)'
    r"|'''(?:[^']+|'(?!''))*(?:'{3,5}|\Z)"
    r'|"(?:[^"\\\n]|\\[^\n])*"?'
    r"|'[^'\n]*'?"
    r"|\#[^\n]*",
    re.DOTALL,
)
_VISIBLE = re.compile(r"[^\n]")
_SEPARATOR = re.compile(r"[=,\[\]{}\n]")
_BRACKET = re.compile(r"[\[\]{}]")


def parse_toml(function: str, place: str, text: str, most: int | None = None) -> dict[str, Any]:
    """The tables of a TOML text.

    Args:
        function: reader on whose behalf errors speak.
        place: name of the file.
        text: its content.
        most: limit on the number of bytes; None for `PHOTOGRAD_MAX_TOML_BYTES`, else 4 MiB.

    Raises:
        IoError: it is no TOML, or it exceeds a limit: the size, `MOST_PARTS` in a dotted key,
            `MOST_NESTING` brackets within each other.
    """
    size = len(text.encode("utf-8", "surrogatepass"))
    if size > (TOML_BYTES.value() if most is None else most):
        expected = TOML_BYTES.expected() if most is None else f"at most {most:,} bytes of TOML"
        remedy = TOML_BYTES.remedy() if most is None else None
        raise IoError(message(function, place, expected, f"{size:,}", remedy))
    bare = without_strings(text)
    parts = 1 + max(piece.count(".") for piece in _SEPARATOR.split(bare))
    if parts > MOST_PARTS:
        expected = f"dotted keys of at most {MOST_PARTS} parts"
        raise IoError(message(function, place, expected, parts))
    steps = (1 if bracket in "[{" else -1 for bracket in _BRACKET.findall(bare))
    nesting = max(accumulate(steps, initial=0))
    if nesting > MOST_NESTING:
        expected = f"at most {MOST_NESTING} brackets within each other"
        raise IoError(message(function, place, expected, nesting))
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:  # ValueError: also a decimal of 5,000 digits
        raise IoError(message(function, place, "TOML", error)) from error


def without_strings(text: str) -> str:
    """TOML with each string and comment blanked out by `_`; lines and columns stay."""
    return _OPAQUE.sub(lambda found: _VISIBLE.sub("_", found[0]), text)
