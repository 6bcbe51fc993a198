"""Mode A's command line: the worker sees libraries, interpreter and NumPy, and nothing else."""

from __future__ import annotations

import shutil
from pathlib import Path

from . import places

ROOM = "/room"  # the empty working folder inside


def find() -> str | None:
    """The program, where it is installed."""
    return shutil.which("bwrap")


def command(bwrap: str, program: Path, inner: list[str], *, as_root: bool) -> list[str]:
    """How to start ``inner`` with file systems, processes and network of its own.

    Nothing in there can be written to, and there is no /proc. As root, the worker keeps the right
    to change its user, and gives it up by doing so; otherwise it gets a user namespace.
    """
    line = [bwrap, "--unshare-pid", "--unshare-net", "--unshare-ipc", "--unshare-uts"]
    line += ["--unshare-cgroup-try", "--die-with-parent", "--new-session", "--cap-drop", "ALL"]
    if as_root:
        line += ["--cap-add", "CAP_SETUID", "--cap-add", "CAP_SETGID"]
    else:
        line += ["--unshare-user"]
    shown, hidden, again = places.mounts()
    for folder in _parents([*shown, *again, program]):
        line += ["--perms", "0755", "--dir", str(folder)]
    for path in shown:
        line += ["--ro-bind", str(path), str(path)]
    for path in hidden:
        line += ["--perms", "0755", "--tmpfs", str(path)]
    for path in (*again, program):
        line += ["--ro-bind", str(path), str(path)]
    for path in hidden:
        line += ["--remount-ro", str(path)]
    for target, link in places.links():
        line += ["--symlink", target, link]
    for device in places.DEVICES:
        line += ["--dev-bind-try", device, device]
    line += ["--perms", "0755", "--dir", ROOM, "--chdir", ROOM, "--remount-ro", "/", "--"]
    return line + inner


def _parents(paths: list[Path]) -> list[Path]:
    """Folders on the way, outermost first; bubblewrap would make them unreadable for others."""
    found = {parent for path in paths for parent in path.parents if parent != Path("/")}
    return sorted(found, key=lambda folder: len(folder.parts))
