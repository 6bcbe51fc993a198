"""Read TOML on every supported Python."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

from ..errors import IoError, message

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib


def read_toml(path: Path) -> dict[str, Any]:
    """The tables of a file.

    Raises:
        IoError: it is missing, or no TOML.
    """
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise IoError(message("read_toml", str(path), "a TOML file", str(error))) from error
