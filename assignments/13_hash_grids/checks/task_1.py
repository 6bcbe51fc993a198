"""Task 13.1, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, asks, checks_for

from .common import EXACT, FAITHFUL, whole

check = checks_for(calls=("tabulate",), tolerance=EXACT)


def counting(function, dimensions, asked):
    """The field as a service; keeps the points that it was asked for."""

    def field(points):
        asked.append(points)
        return function(points)

    return asks(field, Array((None, dimensions)), name="field")


def tabulated(t, function, n, offsets, tolerance):
    """(leaf, values): what `tabulate` says; its leaves and the points it asks for are valid."""
    D, asked = offsets.shape[1], []
    spec = Items(Array(D * (n,), "i8"), Array((None, None)), names=("leaf", "values"))
    field = counting(function, D, asked)
    leaf, values = t.call("tabulate", field, n, offsets, tolerance, returns=spec)
    points = np.concatenate(asked) if asked else np.zeros((0, D))
    t.require(
        bool(((points >= 0) & (points <= 1)).all()),
        "the field was asked for points outside of 0 to 1",
        hint="handout, equation (4): offsets are in units of the cell",
    )
    used = np.unique(leaf)
    t.require(
        used[0] >= 0 and used[-1] < len(values),
        f"leaf: numbers from {used[0]} to {used[-1]}, for {len(values)} rows of values",
        hint="each cell needs the number of its leaf, a row of the values, from 0",
    )
    t.require(len(used) == len(values), f"{len(values)} leaves, of which {len(used)} have cells")
    most = len(offsets) * n**D
    t.require(
        len(points) <= most,
        f"the field was asked for {len(points)} points, {most} are enough",
        hint="ask once for each cell and offset, and merge cells from what you have",
    )
    return leaf, values


def same_cubes(leaf):
    """For each cell the number of cells in its leaf."""
    return np.bincount(leaf.ravel())[leaf]


def numbers_of_cells(cells):
    """A field with these values (n, ..., C), constant in each cell."""
    n, D = len(cells), cells.ndim - 1

    def function(points):
        index = np.clip(np.floor(points * n).astype(np.int64), 0, n - 1)
        return cells[tuple(index.T)]

    return function, n, D


def blocks(t, n, D, channels, alike=0.0):
    """Random cells (n, ..., C), alike in cubes of all sizes."""
    if n == 1 or t.rng.random() < alike:
        return np.broadcast_to(t.rng.integers(0, 8, channels) / 4.0, (*D * (n,), channels))
    cells, half = np.zeros((*D * (n,), channels)), n // 2
    for upper in np.ndindex(D * (2,)):
        where = tuple(slice(half * up, half * up + half) for up in upper)
        cells[where] = blocks(t, half, D, channels, 0.4)
    return cells


def sizes_of(cells, tolerance):
    """For each cell the number of cells in the largest cube in which values agree."""
    n, D = len(cells), cells.ndim - 1
    size, side = np.ones(D * (n,), np.int64), 1
    while side < n:
        side *= 2
        split = cells.reshape(*np.ravel([(n // side, side)] * D), -1)
        axes = tuple(range(1, 2 * D, 2))
        alike = (split.max(axis=axes) - split.min(axis=axes) <= tolerance).all(axis=-1)
        for axis in range(D):
            alike = np.repeat(alike, side, axis=axis)
        size[alike] = side**D
    return size


@check(
    "13.1.means",
    points=4,
    hint="handout, equation (4): sample each cell at all offsets, and take the mean of the values",
    sole="closed forms for what a cell holds",
)
def cells_hold_means(t):
    """For a quadratic field each cell holds the mean of its samples, the cell's own samples."""
    for D, n in ((2, 8), (3, 4)):
        offsets = t.rng.uniform(0.0, 1.0, (3, D))
        mix = t.rng.uniform(0.5, 1.5, (D, 2)) * np.array([1.0, 10.0]) ** np.arange(D)[:, None]
        leaf, values = tabulated(t, lambda x, mix=mix: x**2 @ mix, n, offsets, 0.0)
        cell = np.stack(np.indices(D * (n,)), axis=-1)
        square = cell**2 + 2 * cell * offsets.mean(axis=0) + (offsets**2).mean(axis=0)
        t.close(f"values of the cells, D = {D}", values[leaf], square / n**2 @ mix, reveal=True)


@check(
    "13.1.leaves",
    points=4,
    hint="handout, equation (5): a cube is one leaf if its cells are alike, as large as possible",
    sole="which cubes are leaves, where values are alike or not at all",
)
def equal_cells_are_one_leaf(t):
    """Cells that are equal in a cube are one leaf, the largest such cube; others are not."""
    for D, n in ((2, 16), (3, 8), (2, 1)):
        cells = blocks(t, n, D, 2)
        function, *_ = numbers_of_cells(cells)
        leaf, values = tabulated(t, function, n, np.full((2, D), 0.5), 0.0)
        whole(t, f"cells in the leaf of each cell, D = {D}", same_cubes(leaf), sizes_of(cells, 0.0))
        t.close("values", values[leaf], cells, FAITHFUL)
    one, values = tabulated(t, lambda x: 0 * x[:, :1] + 3.0, 4, np.full((1, 3), 0.5), 0.0)
    t.require(len(values) == 1 and not one.any(), "a constant field is one leaf, number 0")


@check(
    "13.1.tolerance",
    points=3,
    hint="handout, equation (5): the largest value of any cell minus the smallest, channel by "
    "channel; the leaf holds the mean of its cells",
    sole="which cubes are leaves, where values differ",
)
def the_tolerance_decides(t):
    """Cells in one leaf differ by at most the tolerance, in every channel, which may be equal."""
    for D, n, tolerance in ((2, 16, 0.25), (2, 16, 0.5), (3, 8, 0.25)):
        # Steps of eighths: a difference may be the tolerance exactly.
        cells = blocks(t, n, D, 2) + t.rng.integers(0, 3, (*D * (n,), 2)) / 8.0
        function, *_ = numbers_of_cells(cells)
        leaf, values = tabulated(t, function, n, np.full((1, D), 0.5), tolerance)
        right = sizes_of(cells, tolerance)
        t.require(len(np.unique(right)) > 2, "the test case is not informative")
        whole(t, f"cells in the leaf of each cell, D = {D}", same_cubes(leaf), right)
        total = [np.bincount(leaf.ravel(), cells[..., c].ravel()) for c in range(2)]
        mean = np.stack(total, axis=1) / np.bincount(leaf.ravel())[:, None]
        t.close("values of the leaves", values, mean)
