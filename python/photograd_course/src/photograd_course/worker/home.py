"""Prepared once for a grading run, so that a worker starts in the time Python needs."""

from __future__ import annotations

import contextlib
import os
import shutil
import stat
import tempfile
from collections.abc import Sequence
from pathlib import Path
from types import TracebackType
from typing import Any

from .program import install_program
from .watchdog import Watchdog

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]

PREFIX, LOCK = "photograd-home-", "lock"


class WorkerHome:
    """A private folder with the worker program and the working folders of running workers.

    Those that killed graders left behind are removed first.

    Attributes:
        folder: absolute.
        program: what `program.plain_command` takes.
        imports: modules that graded code may import, loaded before reading ends.
        canary: a file that anybody may read by its mode, and no confined worker must.
        watchdog: ends its workers if this process is killed.
    """

    def __init__(self, imports: Sequence[str] = ()) -> None:
        remove_abandoned(Path(tempfile.gettempdir()))
        self.folder = Path(tempfile.mkdtemp(prefix=PREFIX)).resolve()
        self._lock = lock_folder(self.folder)
        self.folder.chmod(0o711)  # a worker must reach its own folder, and list nothing
        self.program = install_program(self.folder / "program")
        self.imports = tuple(imports)
        self.canary = self.folder / "canary"
        self.canary.write_text("read by a worker that should not be able to\n", encoding="utf-8")
        self.canary.chmod(0o644)
        self.watchdog = Watchdog()
        self._users: Any = None

    def __enter__(self) -> WorkerHome:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """Remove it all, and give the user ids back."""
        self.watchdog.close()
        remove_tree(self.folder)
        if self._lock >= 0:
            os.close(self._lock)
            self._lock = -1
        if self._users is not None:
            self._users.close()
            self._users = None

    @property
    def has_users(self) -> bool:
        """Whether a block of user ids is borrowed."""
        return self._users is not None

    def uid(self, slot: int) -> int:
        """The user id of a slot; a block of them is borrowed at the first call.

        Raises:
            GraderFault: no block is free, or the slot is beyond it.
        """
        if self._users is None:
            from .users import UserBlock

            self._users = UserBlock()
        uid: int = self._users.uid(slot)
        return uid

    def scratch(self) -> Path:
        """A new working folder. Only in mode E can a worker write to it."""
        folder = Path(tempfile.mkdtemp(prefix="room-", dir=self.folder))
        folder.chmod(0o755)
        return folder


def lock_folder(folder: Path) -> int:
    """Lock a new folder for as long as this process lives; a descriptor, -1 without such locks."""
    if fcntl is None:
        return -1
    lock = os.open(folder / "lock.new", os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
    fcntl.flock(lock, fcntl.LOCK_EX)
    (folder / "lock.new").rename(folder / LOCK)  # under this name it has never been free
    return lock


def remove_abandoned(place: Path) -> None:
    """Remove the homes in a folder whose grader was killed: ours, and locked by nobody."""
    if fcntl is None:
        return
    for folder in place.glob(f"{PREFIX}*"):
        with contextlib.suppress(OSError):
            status = folder.lstat()
            if not stat.S_ISDIR(status.st_mode) or status.st_uid != os.geteuid():
                continue
            lock = os.open(folder / LOCK, os.O_RDWR | os.O_NOFOLLOW | os.O_CLOEXEC)
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                remove_tree(folder)
            finally:
                os.close(lock)


def remove_tree(folder: Path) -> None:
    """Remove a folder, even where somebody took away the rights to do so; never follows links."""
    if hasattr(os, "chown"):  # POSIX: give folders their rights back, top down
        for place, names, _ in os.walk(folder):
            for name in (".", *names):
                path = os.path.join(place, name)  # noqa: PTH118
                with contextlib.suppress(OSError):
                    if stat.S_ISDIR(os.lstat(path).st_mode):
                        os.chmod(path, 0o700)  # noqa: PTH101
    shutil.rmtree(folder, ignore_errors=True)
