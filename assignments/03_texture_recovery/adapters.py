"""Between the checks and your `texture_recovery.py`: what cannot be seen from the outside.

Runs beside your file; nothing here is to be changed or handed in. Arrays reach your functions as
copies, so only somebody who stands beside them sees whether they were written to.
"""

from __future__ import annotations

import numpy as np
import texture_recovery


def recover_leaves_start(T0, uv, target, n):
    """Whether `recover_texture` leaves the array T0 as it was."""
    before = T0.copy()
    texture_recovery.recover_texture(T0, uv, target, n)
    return bool(np.array_equal(T0, before))
