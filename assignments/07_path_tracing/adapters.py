"""Between the checks and your `path_tracing.py`: functions that need a generator.

Runs beside your file; do not change or submit it.
"""

import numpy as np
import path_tracing as yours


def traced(scene, origins, directions, depth, seed):
    """`trace_paths` with a generator of this seed."""
    return yours.trace_paths(scene, origins, directions, depth, np.random.default_rng(seed))


def recovered(scene, primitive, origins, directions, picture, steps, seed):
    """(base color, roughness) that `recover` finds with your gradient."""
    rng = np.random.default_rng(seed)
    return yours.recover(scene, primitive, origins, directions, picture, steps, rng)[:2]
