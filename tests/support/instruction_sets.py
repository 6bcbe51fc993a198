"""The same program under each instruction set that the kernels are compiled for."""

from __future__ import annotations

import os
import subprocess
import sys

from support.missing import missing

SETS = ("baseline", "v3", "v4")


def assert_same_bits(program: str) -> None:
    """Run `program` with each set that this processor has; it prints hashes, and all must agree.

    Where there is only one set, nothing can be compared: the test is skipped, or fails in
    continuous integration.
    """
    seen = {}
    for name in SETS:
        check = f"from photograd import _core; assert _core.instruction_set() == {name!r}\n"
        done = subprocess.run(
            [sys.executable, "-c", check + program],
            env={**os.environ, "PHOTOGRAD_ISA": name, "PYTHONPATH": os.pathsep.join(sys.path)},
            capture_output=True,
            text=True,
            check=False,
        )
        if done.returncode == 0:
            seen[name] = done.stdout.split()
        else:
            assert "one that this processor supports" in done.stderr, done.stderr
    assert seen["baseline"], "the program printed nothing"
    if len(seen) == 1:
        missing("this processor has one instruction set of the kernels' only")
    assert all(found == seen["baseline"] for found in seen.values()), seen
