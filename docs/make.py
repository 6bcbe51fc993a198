"""Build the book into build/docs; any warning fails the build."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

DOCS = Path(__file__).resolve().parent


def main() -> int:
    """Exit status of Sphinx."""
    target = DOCS.parent / "build" / "docs"
    command = [
        sys.executable,
        "-m",
        "sphinx",
        "-q",
        "-W",
        "--keep-going",
        "-b",
        "html",
        DOCS,
        target,
    ]
    status = subprocess.run(command, check=False).returncode
    if status == 0:
        sys.stderr.write(f"written: {target / 'index.html'}\n")
    return status


if __name__ == "__main__":
    sys.exit(main())
