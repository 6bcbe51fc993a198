"""Landlock: this process may read the named files and folders, and no others. Linux 5.13 and later.

`Documentation/userspace-api/landlock.rst` of the kernel gives the numbers and structures.
"""

from __future__ import annotations

import ctypes
import os
import struct
from collections.abc import Iterable

from .kernel import syscall

CREATE_RULESET, ADD_RULE, RESTRICT_SELF = 444, 445, 446
EXECUTE, READ_FILE, READ_DIR = 1 << 0, 1 << 2, 1 << 3
# How many file rights, bits from 0, each version of the interface knows; later ones know the last.
FILE_RIGHTS = {1: 13, 2: 14, 3: 15, 4: 15, 5: 16}
NETWORK_SINCE, SCOPES_SINCE = 4, 6


def version() -> int:
    """The version of the interface, 0 where the kernel has none."""
    try:
        return syscall(CREATE_RULESET, None, ctypes.c_size_t(0), ctypes.c_uint32(1))
    except OSError:
        return 0


def open_ruleset(readable: Iterable[str]) -> int:
    """A ruleset that denies every right to files, TCP and outside processes but reading these.

    Called while the paths can still be opened. Returns a descriptor for `restrict`.
    """
    known = version()
    rights = (1 << FILE_RIGHTS[min(known, max(FILE_RIGHTS))]) - 1
    attributes = struct.pack("=Q", rights)
    if known >= NETWORK_SINCE:
        attributes += struct.pack("=Q", 3)  # bind and connect
    if known >= SCOPES_SINCE:
        attributes += struct.pack("=Q", 3)  # abstract sockets and signals
    size = ctypes.c_size_t(len(attributes))
    rules = syscall(CREATE_RULESET, attributes, size, ctypes.c_uint32(0))
    for path in readable:
        try:
            place = os.open(path, os.O_PATH | os.O_CLOEXEC)
        except OSError:
            continue  # what is not there need not be read
        allowed = READ_FILE | READ_DIR if os.path.isdir(path) else READ_FILE  # noqa: PTH112
        rule = struct.pack("=Qi", allowed, place)
        syscall(ADD_RULE, ctypes.c_int(rules), ctypes.c_int(1), rule, ctypes.c_uint32(0))
        os.close(place)
    return rules


def restrict(rules: int) -> None:
    """Put a ruleset in force, for good; no_new_privs must be set."""
    syscall(RESTRICT_SELF, ctypes.c_int(rules), ctypes.c_uint32(0))
    os.close(rules)
