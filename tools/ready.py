"""Print the README's line about what is ready and where it has been tried, or write it there.

Usage: ready.py [--write]
"""

from __future__ import annotations

import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
START = "Assignments ready: "
# What makes an assignment ready: everything that a submission meets.
FILES = (
    "assignment.toml",
    "checks/__init__.py",
    "handout.md",
    "explore.py",
    "figures.py",
    "hints.json",
)


def ready_line() -> str:
    """One line for the README."""
    manifests = sorted((ROOT / "assignments").glob("[0-9]*/assignment.toml"))
    folders = [path.parent for path in manifests]
    ready = [folder.name for folder in folders if all((folder / name).exists() for name in FILES)]
    places = tomllib.loads((ROOT / "docs" / "tested_on.toml").read_text(encoding="utf-8"))
    tested, untested = "; ".join(places["tested"]), ", ".join(places["not_tested"])
    names = ", ".join(name.replace("_", " ") for name in ready)
    return f"{START}{names}. Tested on: {tested}. Not tested on: {untested}."


def main() -> None:
    """Print or write."""
    line = ready_line()
    if "--write" not in sys.argv:
        print(line)
        return
    readme = ROOT / "README.md"
    lines = readme.read_text(encoding="utf-8").splitlines()
    changed = [line if text.startswith(START) else text for text in lines]
    readme.write_text("\n".join(changed) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
