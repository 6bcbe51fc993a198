"""One thread for the linear algebra of NumPy.

Matrices of the course are small: several threads spend their time waiting for each other, and on a
busy machine a training takes ten times as long. `check` and the grader use one thread too.
"""

from __future__ import annotations

import importlib
import os
import sys

# Read once, when the library is loaded: OpenBLAS, OpenMP, MKL, BLIS, and Apple's Accelerate.
ONE_THREAD = {
    "OPENBLAS_NUM_THREADS": "1",
    "OMP_NUM_THREADS": "1",
    "MKL_NUM_THREADS": "1",
    "BLIS_NUM_THREADS": "1",
    "VECLIB_MAXIMUM_THREADS": "1",
}


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
