"""Task 03.6, hidden checks."""

from photograd_course.grading import Subject, hidden_check

from ..common import EXACT
from ..task_6 import mips, pyramid


def tile(n):
    """Rows and columns of a texture, powers of two, and two channels."""
    return 1 << n // 2, 1 << (n + 1) // 2, 2


def tiled(t, n):
    """Arguments of `build_mips`."""
    return (t.rng.uniform(-1.0, 1.0, tile(n)),)


@hidden_check(
    "03.6.hidden",
    points=1,
    calls=("build_mips",),
    tolerance=EXACT,
    sole="the same mistakes on textures not known",
    battery=[
        Subject("build_mips", tiled, lambda n: pyramid(tile(n))[1], sizes=(1, 2, 7), large=12)
    ],
)
def pyramids_of_random_textures(t):
    """All levels are right for random textures."""
    for shape in ((4, 32, 2), (8, 2, 1), (1, 1, 3)):
        T = t.rng.uniform(-1.0, 1.0, shape)
        got = mips(t, T)
        for k, level in enumerate(t.reference.build_mips(T)):
            t.close(f"level {k}", got[k], level)
