"""Between the checks and your `texture_recovery.py`: two calls in a row.

Runs beside your file; do not change or submit it. Arrays reach your functions as
copies. A second call shows whether one was changed.
"""

import texture_recovery


def recover_again(T0, uv, target, n):
    """Result of `recover_texture` for the same arrays the second time."""
    texture_recovery.recover_texture(T0, uv, target, n)
    return texture_recovery.recover_texture(T0, uv, target, n)
