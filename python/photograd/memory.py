"""How much memory there is, asked before it is taken."""

from __future__ import annotations

import os
from pathlib import Path

from photograd.errors import RangeError, message


def available_memory() -> int:
    """Bytes that can be taken without swapping, as far as the system tells; else 4 GiB."""
    try:
        lines = Path("/proc/meminfo").read_text(encoding="ascii").splitlines()
        stated = next(line for line in lines if line.startswith("MemAvailable:"))
        return 1024 * int(stated.split()[1])
    except (OSError, StopIteration):
        pass
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") // 2
    except (AttributeError, ValueError, OSError):
        return 4 << 30


def require_room(function: str, what: str, size: int, limit: int | None) -> None:
    """Refuse what takes more than `limit` bytes, or more than there is if no limit is given.

    Raises:
        RangeError: it does, with both numbers.
    """
    most = available_memory() if limit is None else limit
    if size > most:
        raise RangeError(
            message(
                function, "memory_limit", f"room for {what} ({size:,} bytes)", f"{most:,} bytes",
                "take a smaller box, or raise the limit",
            )
        )  # fmt: skip
