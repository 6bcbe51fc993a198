"""A limit of the address space, where it says something about memory."""

from __future__ import annotations

import os
import resource


def limit_memory(size: int) -> None:
    """Let the process have at most `size` bytes.

    Not under a sanitizer: its shadow memory alone takes terabytes of address space.
    """
    if not any(name in os.environ.get("LD_PRELOAD", "") for name in ("libasan", "libtsan")):
        resource.setrlimit(resource.RLIMIT_AS, (size, size))
