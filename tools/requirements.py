"""Print what pip must install, as the two pyproject.toml files say it, one requirement a line.

Usage: requirements.py build [EXTRA ...]

`build` is what building both distributions without isolation needs; an extra is a name from
[project.optional-dependencies]. Standard library only, since it runs before anything is installed.
"""

from __future__ import annotations

import sys
import tomllib
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
PROJECTS = [ROOT / "pyproject.toml", ROOT / "python" / "photograd_course" / "pyproject.toml"]


def read(path: Path) -> dict[str, Any]:
    """The parsed file."""
    return tomllib.loads(path.read_text(encoding="utf-8"))


def requirements(groups: list[str]) -> list[str]:
    """Requirements of the named groups, without repetition; KeyError for an unknown group."""
    projects = [read(path) for path in PROJECTS]
    found: list[str] = []
    for group in groups:
        if group == "build":
            found += [line for project in projects for line in project["build-system"]["requires"]]
        else:
            found += projects[0]["project"]["optional-dependencies"][group]
    return list(dict.fromkeys(found))


if __name__ == "__main__":
    print("\n".join(requirements(sys.argv[1:])))
