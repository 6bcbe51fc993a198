"""The same program under each instruction set that the kernels are compiled for."""

from __future__ import annotations

import os
import subprocess
import sys

from support.missing import missing

SETS = ("baseline", "v3", "v4")


def lines_by_set(program: str) -> dict[str, list[str]]:
    """What `program` prints under each set that this processor has; it must print something.

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
            seen[name] = done.stdout.splitlines()
        else:
            assert "one that this processor supports" in done.stderr, done.stderr
    assert seen["baseline"], "the program printed nothing"
    if len(seen) == 1:
        missing("this processor has one instruction set of the kernels' only")
    return seen
