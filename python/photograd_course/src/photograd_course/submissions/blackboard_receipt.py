"""The text file that Blackboard lays beside each attempt: who handed in which files."""

from __future__ import annotations

import re
from dataclasses import dataclass

from .listing import Entry

LONGEST_RECEIPT = 64 << 10
_NAME = re.compile(r"\s*Name:[ \t]*(\S.*?)[ \t]*\(([^()]*)\)[ \t]*\n")  # its first line
_FILE = re.compile(
    r"^[ \t]*Original filename:[ \t]*(\S.*?)[ \t]*\r?\n[ \t]*Filename:[ \t]*(\S.*?)[ \t]*\r?$",
    re.MULTILINE,
)
_TYPED = re.compile(
    r"^Submission Field:[ \t]*\r?\n(?!There is no student submission text data)[ \t]*\S",
    re.MULTILINE,
)


@dataclass(frozen=True)
class Receipt:
    """What a receipt says.

    Attributes:
        name: the student's full name; "" where it is not there.
        originals: the name of each file in the export to the one its student gave it.
        is_typed: there is text that was typed online.
    """

    name: str
    originals: dict[str, str]
    is_typed: bool


def read_receipt(entry: Entry) -> Receipt:
    """What a receipt says; one that cannot be read says nothing.

    Args:
        entry: the text file.
    """
    try:
        data = entry.read(LONGEST_RECEIPT) if entry.kind == "file" else b""
    except Exception:  # of the disk, or a damaged archive
        data = b""
    text = data.decode("utf-8-sig", errors="replace").replace("\r\n", "\n")
    who = _NAME.match(text)
    originals = {exported: original for original, exported in _FILE.findall(text)}
    return Receipt(who[1] if who else "", originals, bool(_TYPED.search(text)))
