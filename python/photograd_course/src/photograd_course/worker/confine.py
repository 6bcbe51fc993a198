"""The worker's own part of its isolation: give up all that the policy names, and prove it. POSIX.

A policy is what `policy.Policy.to_frame` makes. Order matters: folders are opened and modules
loaded while that is allowed, the filter of system calls comes last.
"""

from __future__ import annotations

import errno
import os
import resource
from typing import Any

from . import kernel, landlock
from .preload import preload

HIGHEST_DESCRIPTOR = 4096
FIRST_PIDS = 3  # in a process namespace of its own, below bubblewrap


def confine(policy: dict[str, Any], keep: set[int]) -> list[str]:
    """Put every layer of the policy in force.

    Args:
        policy: which.
        keep: descriptors that stay open besides 0, 1 and 2.

    Returns:
        names of the layers that were found to be in force afterwards, by trying.
    """
    close_descriptors(keep)
    preload(policy["preload"])
    before = namespace_ids()
    if policy["unshare"]:
        kernel.unshare(policy["unshare"])
    after = namespace_ids()
    rules = landlock.open_ruleset([*policy["readable"], "."]) if policy["landlock"] else None
    if policy["own_root"]:
        enter_empty_root()
    for name, amount in policy["limits"].items():
        limit(name, amount)
    if policy["uid"] is not None:
        become(policy["uid"])
    kernel.drop_capabilities()
    kernel.prctl(kernel.PR_SET_NO_NEW_PRIVS, 1)
    kernel.prctl(kernel.PR_SET_DUMPABLE, 0)
    kernel.prctl(kernel.PR_SET_PDEATHSIG, 9)  # changing the uid has cleared it
    if rules is not None:
        landlock.restrict(rules)
    if policy["filter"] is not None:
        kernel.install_filter(policy["filter"].tobytes())
    layers = confirm(policy)
    if policy["unshare"] and all(before[name] != after[name] for name in policy["unshare"]):
        layers.append("namespaces")
    return layers


def close_descriptors(keep: set[int]) -> None:
    """Close everything that may have been inherited by mistake."""
    start = 3
    for kept in (*sorted(keep), HIGHEST_DESCRIPTOR):
        os.closerange(start, kept)
        start = kept + 1


def enter_empty_root() -> None:
    """Make the empty working folder all that there is: names, sizes and times of files, too."""
    os.chroot(".")
    os.chdir("/")


def limit(name: str, amount: int) -> None:
    """Set one resource limit; processor time gets a second between warning and end."""
    number = getattr(resource, f"RLIMIT_{name.upper()}")
    hard = amount + 1 if name == "cpu" else amount
    highest = resource.getrlimit(number)[1]
    if highest != resource.RLIM_INFINITY:
        hard = min(hard, highest)
    resource.setrlimit(number, (min(amount, hard), hard))


def become(uid: int) -> None:
    """Turn into another user, without a way back."""
    os.setgroups([])
    os.setresgid(uid, uid, uid)
    os.setresuid(uid, uid, uid)


def namespace_ids() -> dict[str, str]:
    """What the kernel calls the namespaces of this process; empty strings without /proc."""
    kinds = {"network": "net", "ipc": "ipc", "uts": "uts"}
    found = {}
    for name, kind in kinds.items():
        try:
            found[name] = os.readlink(f"/proc/self/ns/{kind}")  # noqa: PTH115
        except OSError:
            found[name] = ""
    return found


def confirm(policy: dict[str, Any]) -> list[str]:
    """Which layers hold, judged by what happens when they are tested."""
    layers = []
    if all(has_limit(name, amount) for name, amount in policy["limits"].items()):
        layers.append("limits")
    uid = policy["uid"]
    if uid is not None and (*os.getresuid(), *os.getresgid(), *os.getgroups()) == (uid,) * 6:
        layers.append("user")
    if kernel.prctl(kernel.PR_GET_NO_NEW_PRIVS) == 1:
        layers.append("no new privileges")
    if kernel.capabilities() == 0:
        layers.append("capabilities")
    if policy["landlock"] and not can_read(policy["canary"]):
        layers.append("files")
    if policy["own_root"] and not os.path.lexists(policy["canary"]):
        layers.append("names of files")
    if policy["filter"] is not None and filter_holds():
        layers.append("system calls")
    if policy["own_mounts"] and not can_read(policy["canary"]):
        layers.append("mounts")
    if policy["own_mounts"] and os.getpid() <= FIRST_PIDS:
        layers.append("processes")
    return layers


def has_limit(name: str, amount: int) -> bool:
    """Whether a limit is at least as strict as asked."""
    soft, hard = resource.getrlimit(getattr(resource, f"RLIMIT_{name.upper()}"))
    return all(value != resource.RLIM_INFINITY and value <= amount + 1 for value in (soft, hard))


def can_read(path: str) -> bool:
    """Whether a file that anybody may read by its mode can be opened."""
    try:
        os.close(os.open(path, os.O_RDONLY))
    except OSError:
        return False
    return True


def filter_holds() -> bool:
    """A filter is there, and a harmless call that it must refuse is refused."""
    if kernel.prctl(kernel.PR_GET_SECCOMP) != kernel.SECCOMP_MODE_FILTER:
        return False
    try:
        os.kill(os.getpid(), 0)
    except OSError as error:
        return error.errno == errno.EPERM
    return False
