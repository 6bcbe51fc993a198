"""The variables with which a process starts that gets one thread for the linear algebra of NumPy.

Matrices of the course are small: several threads spend their time waiting for each other, and on a
busy machine a training takes ten times as long.
"""

from __future__ import annotations

# Read once, when the library is loaded: OpenBLAS, OpenMP, MKL, BLIS, and Apple's Accelerate.
ONE_THREAD = {
    "OPENBLAS_NUM_THREADS": "1",
    "OMP_NUM_THREADS": "1",
    "MKL_NUM_THREADS": "1",
    "BLIS_NUM_THREADS": "1",
    "VECLIB_MAXIMUM_THREADS": "1",
}
