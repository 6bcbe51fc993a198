"""Between the checks and your `texture_recovery.py`: two calls in a row.

Runs beside your file; nothing here is to be changed or handed in. Arrays reach your functions as
copies. Whether one was written to shows in what a second call makes of the same array.
"""

import texture_recovery


def recover_again(T0, uv, target, n):
    """What `recover_texture` returns for the same arrays the second time."""
    texture_recovery.recover_texture(T0, uv, target, n)
    return texture_recovery.recover_texture(T0, uv, target, n)
