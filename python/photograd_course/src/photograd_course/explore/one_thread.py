"""One thread for linear algebra in an exploration, as `check` and the grader have it."""

from __future__ import annotations

import importlib
import os
import sys

from ..one_thread import ONE_THREAD


def use_one_thread() -> bool:
    """Limit NumPy's linear algebra to one thread, in this process and those that it starts.

    Returns:
        whether the limit holds. Where NumPy was loaded before, it needs `threadpoolctl`; where that
        is missing as well, a line says what to do.
    """
    os.environ.update(ONE_THREAD)
    if "numpy" not in sys.modules:
        return True
    try:
        importlib.import_module("threadpoolctl").threadpool_limits(1, "blas")
    except ImportError:
        sys.stdout.write(
            "NumPy was loaded before this exploration, with several threads: restart the kernel "
            "and run this cell first, or everything below may take ten times as long\n"
        )
        return False
    return True
