"""Read the TOML files of assignments."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ..input_files import read_text
from ..toml_limits import parse_toml


def read_toml(path: Path) -> dict[str, Any]:
    """The tables of a file.

    Raises:
        IoError: it is missing, no regular file, no TOML, or exceeds a limit of `parse_toml`.
    """
    return parse_toml("read_toml", str(path), read_text("read_toml", path))
