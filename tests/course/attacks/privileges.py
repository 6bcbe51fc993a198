"""Run the suite as root in a container of a grading service: no new namespaces, few capabilities.

The capabilities are those that Docker leaves by default. They are taken from the bounding set, so
that nothing brings them back, and a filter refuses unshare, setns, mount and clone with any
namespace, for this process and all that it starts.
"""

from __future__ import annotations

import ctypes
import errno
import json
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

TESTS = Path(__file__).resolve().parents[2]
PR_CAPBSET_DROP, PR_SET_NO_NEW_PRIVS = 24, 38
CAPABILITY_VERSION = 0x20080522
# chown, dac_override, fowner, fsetid, kill, setgid, setuid, setpcap, net_bind_service, net_raw,
# sys_chroot, mknod, audit_write, setfcap
LEFT = (0, 1, 3, 4, 5, 6, 7, 8, 10, 13, 18, 27, 29, 31)
SYS_ADMIN = 21
NAMESPACES = 0x7E020000  # CLONE_NEW*: net, pid, user, ipc, uts, cgroup, mount


def run_like_a_container(words: Sequence[str]) -> dict[str, Any]:
    """What `suite.main` prints with these words in such a process.

    Raises:
        RuntimeError: it did not come to an end.
    """
    code = (
        "import sys; from course.attacks import privileges; privileges.give_up();"
        "sys.argv[0] = 'suite'; from course.attacks import suite; suite.main()"
    )
    path = os.pathsep.join([str(TESTS), str(TESTS.parent)])
    done = subprocess.run(
        [sys.executable, "-c", code, *words],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "PYTHONPATH": path},
    )
    if done.returncode:
        raise RuntimeError(done.stderr[-3000:])
    results: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return results


def give_up() -> None:
    """Lose the capabilities and the way to namespaces, for good, and make sure of it."""
    libc = ctypes.CDLL(None, use_errno=True)
    for capability in range(64):
        if capability not in LEFT:
            libc.prctl(PR_CAPBSET_DROP, capability, 0, 0, 0)
    _set_capabilities(libc, sum(1 << capability for capability in LEFT))
    if libc.prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0):
        raise OSError(ctypes.get_errno(), "no_new_privs")
    _deny_namespaces()
    status = Path("/proc/self/status").read_text(encoding="utf-8")
    effective = int(status.split("CapEff:")[1].split()[0], 16)
    if effective >> SYS_ADMIN & 1 or libc.unshare(0x40000000) == 0:
        raise RuntimeError("this process still may make namespaces")


def _set_capabilities(libc: ctypes.CDLL, mask: int) -> None:
    header = (ctypes.c_uint32 * 2)(CAPABILITY_VERSION, 0)
    low, high = mask & 0xFFFFFFFF, mask >> 32
    data = (ctypes.c_uint32 * 6)(low, low, 0, high, high, 0)
    if libc.capset(header, data):
        raise OSError(ctypes.get_errno(), "capset")


def _deny_namespaces() -> None:
    import pyseccomp

    table = pyseccomp.SyscallFilter(pyseccomp.ALLOW)
    refusal = pyseccomp.ERRNO(errno.EPERM)
    for name in ("unshare", "setns", "mount", "pivot_root"):
        table.add_rule(refusal, name)
    for bit in range(32):
        if NAMESPACES >> bit & 1:
            flag = pyseccomp.Arg(0, pyseccomp.MASKED_EQ, 1 << bit, 1 << bit)
            table.add_rule(refusal, "clone", flag)
    table.add_rule(pyseccomp.ERRNO(errno.ENOSYS), "clone3")
    table.load()
