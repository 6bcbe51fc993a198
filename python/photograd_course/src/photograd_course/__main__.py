"""``python -m photograd_course`` is the ``photograd`` command where scripts are not on the path."""

from __future__ import annotations

from .cli import main

if __name__ == "__main__":
    main()
