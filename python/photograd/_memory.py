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


def require_room(
    function: str,
    what: str,
    size: int,
    limit: int | None = None,
    *,
    argument: str = "memory_limit",
    remedy: str = "take a smaller box, or raise the limit",
) -> None:
    """Refuse what takes more than `limit` bytes, or more than there is if no limit is given.

    Call it before anything is allocated.

    Args:
        function, argument: on whose behalf, and for which argument or option, the error speaks.
        what: what the bytes are for, in words.
        size: bytes that it takes at its peak, temporary arrays included.
        limit: bytes that it may take; by default, what is available.
        remedy: what to change.

    Raises:
        RangeError: it takes more, with both sizes.
    """
    most = available_memory() if limit is None else limit
    if size > most:
        expected = f"room for {what} ({bytes_text(size)})"
        raise RangeError(message(function, argument, expected, bytes_text(most), remedy))


def bytes_text(size: int) -> str:
    """A number of bytes to be read by people: 1,023 bytes, 1.5 MiB, 2.3 GiB."""
    for unit, name in ((1 << 40, "TiB"), (1 << 30, "GiB"), (1 << 20, "MiB")):
        if size >= unit:
            return f"{size / unit:,.1f} {name}"
    return f"{size:,} bytes"
