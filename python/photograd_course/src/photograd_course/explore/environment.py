"""Where an exploration runs: as a script, or in the kernel of a notebook."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any


def kernel() -> Any | None:
    """The shell of the notebook in which this process runs cells; None in a script."""
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    return shell if hasattr(shell, "kernel") else None


def words() -> list[str]:
    """What stands behind the script's name on the command line; nothing in a notebook.

    A kernel's own command line is that of Jupyter. ``%run explore.py --steps 9`` in a notebook
    puts the script's in its place.
    """
    program = Path(sys.argv[0]).name
    is_script = program.endswith(".py") and "kernel" not in program and program != "__main__.py"
    return sys.argv[1:] if kernel() is None or is_script else []
