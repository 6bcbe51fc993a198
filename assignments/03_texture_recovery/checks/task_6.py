"""Task 03.6, public checks."""

import numpy as np
from photograd_course.grading import Array, CheckFailed, Items, StudentFailure, checks_for

from .common import EXACT

check = checks_for(calls=("build_mips",), tolerance=EXACT)


def pyramid(shape):
    """The shapes of all levels below (H, W, C), and what they must be."""
    shapes = [tuple(shape)]
    while max(shapes[-1][:2]) > 1:
        shapes.append((*(max(n // 2, 1) for n in shapes[-1][:2]), shape[2]))
    return shapes, Items(*map(Array, shapes), names=tuple(f"level {k}" for k in range(len(shapes))))


def mips(t, T):
    """`build_mips`; says what is special where one side gets down to a single texel first."""
    square = T.shape[0] == T.shape[1]
    single = "where one side is a single texel already, average the two along the other"
    try:
        return t.call("build_mips", T, returns=pyramid(T.shape)[1])
    except CheckFailed as failure:
        ends = "level 0 is T itself, the last level a single texel"
        failure.details.setdefault("advice", ends if square else single)
        raise
    except StudentFailure as failure:
        if square or failure.reason not in {"raised", "timeout"}:
            raise
        rows, columns = T.shape[:2]
        said = f"{failure.text} for a texture of {rows} x {columns}: {single}"
        raise StudentFailure(failure.reason, said, failure.private, failure.line) from failure


@check(
    "03.6.mean",
    points=3,
    hint="handout, equation (16): each texel is the mean of those it replaces",
    sole="what a mipmap is for: the same light at each size",
)
def each_level_has_the_same_mean(t):
    """Levels shrink by halves down to one texel, and all have the same mean."""
    for shape in ((8, 8, 3), (2, 16, 1), (4, 1, 2)):
        T = t.rng.uniform(0.5, 1.5, shape)
        got = mips(t, T)
        t.close("level 0", got[0], T)
        for k, level in enumerate(got):
            bright = level.mean() / T.mean()
            said = (
                f"level {k} of a texture of {shape[0]} x {shape[1]} is {bright:.3g} times as "
                "bright as that texture: a mean divides by how many texels it adds"
            )
            t.close(f"mean of level {k}", level.mean(axis=(0, 1)), T.mean(axis=(0, 1)), hint=said)


@check(
    "03.6.spot",
    points=2,
    hint="rows 2 i and 2 i + 1 become row i",
    sole="where a texel goes; a mean does not see that",
)
def a_spot_keeps_its_place(t):
    """A single bright texel grows fainter from level to level, and stays where it was."""
    for _ in range(3):
        row, column = (int(k) for k in t.rng.integers(0, [8, 4]))
        T = np.zeros((8, 4, 1))
        T[row, column] = 1.0
        got = mips(t, T)
        for k, shape in enumerate(pyramid(T.shape)[0]):
            expected = np.zeros(shape)
            share = shape[0] * shape[1] / 32
            expected[row * shape[0] // 8, column * shape[1] // 4] = share
            t.close(f"level {k}", got[k], expected, reveal=True)
