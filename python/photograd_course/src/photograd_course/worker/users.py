"""Numbers of users that belong to nobody, lent to one grading run at a time. POSIX."""

from __future__ import annotations

import contextlib
import os
import tempfile
from pathlib import Path

from ..grading.failures import GraderFault

# 60706 to 61183 is what systemd's table of user ids leaves unused.
FIRST, BLOCK, BLOCKS = 61000, 16, 11


class UserBlock:
    """`BLOCK` user ids that no other grading run on this machine uses, until closed."""

    def __init__(self) -> None:
        import fcntl

        for number in range(BLOCKS):
            lock = _open_lock(number)
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError:
                os.close(lock)
                continue
            self._lock = lock
            self.first = FIRST + BLOCK * number
            return
        raise GraderFault(f"{BLOCKS} grading runs are under way on this machine: wait for one")

    def uid(self, slot: int) -> int:
        """The user of a slot.

        Raises:
            GraderFault: there are not that many.
        """
        if not 0 <= slot < BLOCK:
            raise GraderFault(f"slot {slot}: at most {BLOCK} workers at a time")
        return self.first + slot

    def close(self) -> None:
        """Give the numbers back."""
        with contextlib.suppress(OSError):
            os.close(self._lock)
        self._lock = -1


def _open_lock(number: int) -> int:
    for folder in (Path("/run"), Path(tempfile.gettempdir())):
        with contextlib.suppress(OSError):
            flags = os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_CLOEXEC
            return os.open(folder / f"photograd-users-{number}.lock", flags, 0o600)
    raise GraderFault("no place for a lock file: neither /run nor the folder for temporary files")
