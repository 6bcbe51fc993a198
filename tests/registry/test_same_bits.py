"""Every registered function: the same bits on any threads, again, and on any instruction set."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest
from photograd._compiled import _core

from support.bits import Case, cases, digests, same_bits
from support.instruction_sets import lines_by_set
from support.tree import ROOT

pytestmark = pytest.mark.usefixtures("core")

CASES = cases()


@pytest.mark.parametrize("name", CASES)
def test_any_number_of_threads_and_twice(name: str) -> None:
    found = []
    try:
        for threads in (1, 2, 5, 5):
            _core.set_thread_count(threads)
            found.append(digests(CASES[name]))
    finally:
        _core.set_thread_count(0)
    assert all(other == found[0] for other in found[1:])


def test_every_instruction_set() -> None:
    program = "from support.bits import lines_of_kernels; print(*lines_of_kernels(), sep='\\n')"
    seen = lines_by_set(program)
    assert [line.split("\t")[0] for line in seen["baseline"]] == [
        name for name, case in CASES.items() if case.kernels
    ]
    for lines in seen.values():
        assert lines == seen["baseline"]


def test_every_kernel_is_named() -> None:
    text = (ROOT / "cpp/kernels/kernels.h").read_text(encoding="utf-8")
    members = set(re.findall(r"\(\*(\w+)\)\(", text))
    assert len(members) > 10
    assert {kernel for case in CASES.values() for kernel in case.kernels} == members


def test_no_other_test_counts_threads() -> None:
    allowed = {
        "tests/commands/conftest.py",  # sets the number back
        "tests/commands/test_commands.py",  # the option --threads
        "tests/core/test_array_args.py",  # refusals
        "tests/registry/test_same_bits.py",
        "tests/support/core_workload.py",
    }
    users = {
        path.relative_to(ROOT).as_posix()
        for path in (ROOT / "tests").rglob("*.py")
        if "_core.set_thread_count(" in path.read_text(encoding="utf-8")
    }
    assert users <= allowed, "register the results with support.bits.same_bits"


def test_digests_see_every_bit() -> None:
    def of(*results: Any) -> list[str]:
        return digests(Case(lambda: results, (), "here"))

    one = np.ones(3)
    assert of(one) == of(one.copy())
    changed = [np.nextafter(one, 2), one.astype("f4"), one[:2], one * [1, 1, -1]]
    assert len({of(other)[0] for other in (one, *changed)}) == 5
    assert of(one, changed[0]) == of(one) + of(changed[0])
    for nothing in ([np.zeros(3)], [one, 0], []):
        with pytest.raises(AssertionError):
            of(*nothing)


def test_a_name_is_registered_once() -> None:
    name = next(iter(CASES))
    with pytest.raises(ValueError, match="is registered by"):
        same_bits(name)(list)
