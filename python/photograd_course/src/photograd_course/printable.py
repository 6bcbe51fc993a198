"""Text written by students, made safe for wherever a report goes.

A submission chooses names of files and exceptions, and values in messages. None of these may move
a terminal's cursor, become markup, turn a line around, or become a formula in a spreadsheet.
"""

from __future__ import annotations

import re
import unicodedata

_UNSAFE = {"Cc", "Cf", "Cs", "Co", "Cn", "Zl", "Zp"}
_MARKDOWN = re.compile(r"([!-/:-@\[-`{-~])")  # every ASCII punctuation mark


def printable(text: object, longest: int = 600) -> str:
    """One line without control, format and unassigned characters, cut at ``longest``."""
    try:
        whole = str(text)
    except ValueError:  # Python writes no integers of more than 4,300 digits
        whole = f"({type(text).__name__} too long to be shown)"
    words = "".join(
        " " if char in "\t\r\n" else "\N{REPLACEMENT CHARACTER}" if _is_unsafe(char) else char
        for char in whole[: longest + 1]
    )
    return words if len(words) <= longest else words[: longest - 1] + "\N{HORIZONTAL ELLIPSIS}"


def markdown(text: object) -> str:
    """The text as Markdown that says just that."""
    return _MARKDOWN.sub(r"\\\1", printable(text))


def csv_cell(value: object) -> str:
    """A cell that no spreadsheet takes for a formula.

    An apostrophe goes before what begins like one, also behind blanks; numbers stay as they are.
    """
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return f"{value:g}"
    text = printable(value)
    return f"'{text}" if text.lstrip()[:1] in tuple("=+-@|%") else text


def file_name(text: str, longest: int = 48) -> str:
    """Letters, digits and dashes of a name: a part of a file's name on any system."""
    plain = unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode()
    return re.sub(r"[^A-Za-z0-9]+", "-", plain).strip("-")[:longest] or "submission"


def _is_unsafe(char: str) -> bool:
    return unicodedata.category(char) in _UNSAFE
