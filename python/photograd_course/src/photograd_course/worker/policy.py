"""What each mode of isolation asks of a worker, and what it promises.

A  bubblewrap: file systems, processes and network of its own
B  root without it: another user in an empty root folder, namespaces for network, shared memory
C  root that may make no namespaces, as in a grading service's container: another user, empty root
D  not root: the same user, confined by Landlock and the filter of system calls
E  any system: a process of its own and nothing more; its verdicts are indicative only
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from ..assignment.manifest import Limits

MODES = ("A", "B", "C", "D", "E")
TITLES = {
    "A": "A (bubblewrap)",
    "B": "B (another user, namespaces)",
    "C": "C (another user)",
    "D": "D (same user, system calls filtered)",
    "E": "E (a plain process, indicative only)",
}
FEWEST_PROCESSES = 24  # threads count; NumPy needs one


@dataclass(frozen=True)
class Policy:
    """What a worker gives up before it loads a submission.

    Attributes:
        layers: what it must report to hold.
        uid: the user (and group) it turns into, or None.
        limits: lower-case names of RLIMIT_ constants to values.
        unshare: namespaces it leaves by itself.
        readable: for Landlock, or None where there is no Landlock.
        program: the filter of system calls, or None.
        preload: further modules to import.
        canary: a file that everybody may read by its mode, and the worker must not.
        own_mounts: whether the canary is hidden by mounts.
        own_root: whether its working folder becomes the root of all that it can name.
    """

    layers: frozenset[str]
    uid: int | None = None
    limits: dict[str, int] = field(default_factory=dict)
    unshare: tuple[str, ...] = ()
    readable: tuple[str, ...] | None = None
    program: bytes | None = None
    preload: tuple[str, ...] = ()
    canary: str = ""
    own_mounts: bool = False
    own_root: bool = False

    def to_frame(self) -> dict[str, Any] | None:
        """As the worker's `confine` reads it; None asks for nothing."""
        if not self.layers:
            return None
        code = self.program
        return {
            "uid": self.uid,
            "limits": self.limits,
            "unshare": list(self.unshare),
            "landlock": self.readable is not None,
            "readable": list(self.readable or ()),
            "filter": None if code is None else np.frombuffer(code, dtype=np.uint8),
            "preload": list(self.preload),
            "canary": self.canary,
            "own_mounts": self.own_mounts,
            "own_root": self.own_root,
        }


def resource_limits(limits: Limits, *, own_user: bool) -> dict[str, int]:
    """The kernel's limits for one worker; that of processes counts all of a user's."""
    table = {
        "cpu": max(1, round(limits.cpu_seconds)),
        "as": limits.memory_mb << 20,
        "fsize": 0,
        "nofile": 64,
        "core": 0,
        "memlock": 0,
        "msgqueue": 0,
    }
    if own_user:
        table["nproc"] = FEWEST_PROCESSES
    return table
