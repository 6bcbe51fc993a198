"""Every system call is decided, and the compiled filter decides as the tables say."""

from __future__ import annotations

import os
import re
import signal
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from photograd_course.worker import syscall_filter
from photograd_course.worker.system_calls import REVIEWED, decisions

from course.isolation.packet_filter import LITTLE_ENDIAN, decide
from support.missing import missing, need_module

HEADERS = [
    Path(folder) / name
    for folder in ("/usr/include/x86_64-linux-gnu/asm", "/usr/include/asm")
    for name in ("unistd_64.h", "unistd_32.h", "unistd_x32.h")
]
GENERIC = Path("/usr/include/asm-generic/unistd.h")
# Numbers of the newest calls, which a library may not know by name; they are the same everywhere.
NEW = (
    "cachestat fchmodat2 map_shadow_stack futex_wake futex_wait futex_requeue statmount listmount "
    "lsm_get_self_attr lsm_set_self_attr lsm_list_modules mseal setxattrat getxattrat listxattrat "
    "removexattrat open_tree_attr file_getattr file_setattr"
)
NEWEST = {name: 451 + k for k, name in enumerate(NEW.split())}
BASES = {"MIPS": 4000, "MIPSEL": 4000, "MIPS64": 5000, "MIPSEL64": 5000}
BASES |= {"MIPS64N32": 6000, "MIPSEL64N32": 6000, "X32": 0x40000000}


def arches() -> dict[str, int]:
    """libseccomp's architectures, by name."""
    found: dict[str, int] = dict(vars(need_module("pyseccomp").Arch))
    return {name: arch for name, arch in found.items() if name.isupper() and name != "NATIVE"}


@cache
def compiled(arch: int) -> bytes:
    return syscall_filter.filter_for(need_module("pyseccomp"), arch)


def numbers(name: str) -> Iterator[int]:
    """Where an architecture's calls may lie."""
    base = BASES.get(name, 0)
    yield from (*range(base, base + 600), *range(0xF0000, 0xF0010))


def known(name: str, arch: int) -> Iterator[tuple[int, str]]:
    """Numbers and names of an architecture's calls, as this libseccomp knows them."""
    library = need_module("pyseccomp")
    for number in numbers(name):
        try:
            yield number, library.resolve_syscall(arch, number).decode()
        except (OSError, ValueError):
            continue


def native() -> int:
    arch: int = need_module("pyseccomp").system_arch()
    return arch


def number_of(name: str) -> int:
    number: int = need_module("pyseccomp").resolve_syscall(native(), name)
    return NEWEST.get(name, number)


def test_each_call_of_the_kernels_headers_is_decided() -> None:
    texts = [path.read_text("utf-8") for path in (*HEADERS, GENERIC) if path.exists()]
    if not texts:
        missing("the kernel's headers (linux-libc-dev)")
    pattern = re.compile(r"#define __NR_(\w+)\s+\(?(?:__X32_SYSCALL_BIT \+ )?(\d+)")
    calls = {name: int(number) for text in texts for name, number in pattern.findall(text)}
    assert len(calls) > 300
    assert calls["mount_setattr"] == 442
    reviewed = {name for name, number in calls.items() if number <= REVIEWED}
    assert reviewed - set(decisions()) - {"syscalls", "arch_specific_syscall"} == set()


def test_each_call_that_libseccomp_knows_is_decided() -> None:
    names = {name for each, arch in arches().items() for _, name in known(each, arch)}
    assert len(names) > 400
    assert names - set(decisions()) == set()
    assert max(NEWEST.values()) == REVIEWED
    assert set(NEWEST) < set(decisions())


def test_the_filter_decides_as_the_tables_say() -> None:
    """On each architecture, for each number; what the tables do not name is unknown.

    libseccomp exports programs for processors of the other byte order in a mixture of both.
    """
    tables = decisions()
    alike = {each: arch for each, arch in arches().items() if not (arch ^ native()) & LITTLE_ENDIAN}
    for each, arch in alike.items():
        token = arches()["X86_64"] if each == "X32" else arch
        names = dict(known(each, arch))
        for number in numbers(each):
            wanted = tables.get(names.get(number, ""), "unknown")
            if wanted != "by argument":
                found = decide(compiled(arch), token, number)
                assert found == wanted, (each, number, names.get(number))


def test_numbers_that_nobody_reviewed_are_unknown() -> None:
    beyond = (*range(REVIEWED + 1, REVIEWED + 300), 10_000, 1 << 20, 1 << 31, (1 << 32) - 1)
    for number in beyond:
        assert decide(compiled(native()), native(), number, (0, 0, 0)) == "unknown"
    for name, number in NEWEST.items():
        found = decide(compiled(native()), native(), number)
        assert (found == "allowed") <= (decisions()[name] == "allowed"), name


def test_other_interfaces_are_refused_as_a_whole() -> None:
    """The 32-bit calls of a 64-bit kernel, x32, and whatever another processor would call."""
    program = compiled(native())
    for arch in set(arches().values()) - {native()}:
        assert {decide(program, native(), n, said=arch) for n in range(600)} == {"unknown"}
    x32 = range(0x40000000, 0x40000000 + 600)
    assert {decide(program, native(), number) for number in x32} == {"unknown"}


def test_an_older_library_weakens_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Names that it does not know are refused like everything else that no table names."""
    library = need_module("pyseccomp")
    resolve = library.resolve_syscall
    forgotten = {"mount_setattr", "setxattr", "io_uring_setup", "pidfd_open", "statx", "rseq"}

    def older(arch: int, name: str) -> Any:
        return -1 if name in forgotten else resolve(arch, name)

    monkeypatch.setattr(library, "resolve_syscall", older)
    program = syscall_filter.filter_for(library)
    monkeypatch.undo()
    for name in forgotten:
        assert decide(program, native(), number_of(name)) == "unknown"
    assert decide(program, native(), number_of("read")) == "allowed"


F_SETOWN, F_SETSIG, F_SETLEASE, F_NOTIFY, F_SETLK = 8, 10, 1024, 1026, 6
HIGH = 1 << 40  # the kernel does not read it in an int
CASES = [
    ("clone", (0x3D0F00,), "allowed"),  # what pthread_create passes
    ("clone", (signal.SIGCHLD,), "refused"),
    ("clone", (0x4111,), "refused"),
    *(("clone", (0x3D0F00 | 1 << bit,), "refused") for bit in (7, 17, 25, 26, 27, 28, 29, 30)),
    ("openat", (0, 0, os.O_RDONLY), "allowed"),
    ("openat", (0, 0, os.O_RDONLY | os.O_CLOEXEC | os.O_DIRECTORY), "allowed"),
    *(
        ("openat", (0, 0, flags | extra), "refused")
        for flags in (os.O_WRONLY, os.O_RDWR, 3, os.O_CREAT, os.O_TRUNC, os.O_PATH)
        for extra in (0, os.O_CLOEXEC, HIGH)
    ),
    *(("fcntl", (0, command), "allowed") for command in (0, 1, 2, 3, 4, 1030)),
    *(
        ("fcntl", (0, command | high), "refused")
        for command in (F_SETLK, F_SETOWN, F_SETSIG, 15, F_SETLEASE, F_NOTIFY, 1033)
        for high in (0, HIGH)
    ),
    ("ioctl", (0, 0x5401), "allowed"),
    # FS_IOC_SETFLAGS, FS_IOC_ENABLE_VERITY, TIOCSTI
    *(("ioctl", (0, request), "refused") for request in (0x40086602, 0x40806685, 0x5412)),
    ("prctl", (15, 0), "allowed"),
    # PDEATHSIG, DUMPABLE, KEEPCAPS, SECCOMP, SECUREBITS, MM, SUBREAPER, DISPATCH, PTRACER
    *(
        ("prctl", (option | high, 0), "refused")
        for option in (1, 4, 8, 22, 28, 35, 36, 59, 0x59616D61)
        for high in (0, HIGH)
    ),
    ("prlimit64", (0, 7, 0, 1 << 47), "allowed"),
    ("prlimit64", (0, 7, 1 << 47, 0), "refused"),
    ("prlimit64", (0, 7, 8, 0), "refused"),
    ("prlimit64", (1, 7, 0, 0), "refused"),
]


@pytest.mark.parametrize(("name", "args", "decision"), CASES)
def test_some_calls_are_decided_by_their_arguments(
    name: str, args: tuple[int, ...], decision: str
) -> None:
    number = number_of(name)
    assert decide(compiled(native()), native(), number, args) == decision
