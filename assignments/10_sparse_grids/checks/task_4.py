"""Task 10.4, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, Tolerance, checks_for

from .common import EARLIER, looking, lump, same_voxels

check = checks_for(calls=("prune_and_dilate",))

SAME = Tolerance(1e-10, "skipped and unskipped pictures differ by 1e-15, wrong ones by 1e-3")


def voxels_in(t, n, count):
    """Different voxels of the cube, in no order."""
    voxels = np.stack(np.unravel_index(t.rng.permutation(n**3)[:count], (n, n, n)), axis=1)
    return voxels.astype(np.int64)


def pruned(t, n, voxels, row, share, threshold, steps):
    return t.call(
        "prune_and_dilate", n, voxels, row, share, threshold, steps, returns=Array((None, 3), "i8")
    )


def grown(t, n, voxels, steps):
    """Nothing is pruned, all grow."""
    alone = np.arange(len(voxels))[None]
    return pruned(t, n, voxels, alone, np.ones(alone.shape), 0.5, steps)


def some_shares(t, most):
    """(row, share), (8, M) each: voxel v has the largest share most[v]; 0 means never sampled."""
    read = np.flatnonzero(most > 0)
    more = t.rng.choice(read, 7 * len(read) + 40)
    missing = 40 - (8 * len(read) + 80) % 8
    row = np.concatenate([read, more, np.full(missing, -1)])
    less = most[more] * t.rng.uniform(0, 0.6, len(more))
    share = np.concatenate([most[read], less, t.rng.uniform(1, 5, missing)])
    order = t.rng.permutation(len(row))
    return row[order].reshape(8, -1), share[order].reshape(8, -1)


@check(
    "10.4.pruned",
    points=4,
    hint="the largest share of any sample decides: one view that needs a voxel is enough",
    sole="who stays, asked without growing",
)
def the_largest_share_decides(t):
    """Voxels stay whose largest share is above the threshold; those never sampled do not."""
    n, count = 8, 60
    voxels = voxels_in(t, n, count)
    most = t.rng.uniform(0.1, 0.9, count)
    most[::7] = most[-1] = 0.0
    row, share = some_shares(t, most)
    for threshold in (0.5, 0.0):
        got = pruned(t, n, voxels, row, share, threshold, 0)
        same_voxels(t, f"threshold {threshold}", n, got, voxels[most > threshold])
    half = np.where(t.rng.random(count) < 0.5, 0.5, 0.25)
    row, share = np.arange(count)[None], half[None]
    got = pruned(t, n, voxels, row, share, 0.25, 0)
    same_voxels(t, "a share equal to the threshold", n, got, voxels[half > 0.25])


@check(
    "10.4.grown",
    points=4,
    hint="a cube around each voxel, edges and corners included, cut off at the cube's faces",
    sole="closed forms: one voxel, a corner, growth by two",
)
def one_voxel_grows_into_a_cube(t):
    """One voxel becomes a cube of side 2 grow + 1, cut off at the border; by 2 is twice by 1."""
    n = 8
    for steps in (1, 2):
        middle = t.rng.integers(steps, n - steps, 3)
        got = grown(t, n, middle[None], steps)
        around = np.stack(
            np.meshgrid(*[np.arange(m - steps, m + steps + 1) for m in middle], indexing="ij"),
            axis=-1,
        ).reshape(-1, 3)
        same_voxels(t, f"one voxel, grow = {steps}", n, got, around)
        corner = np.array([[0, n - 1, 0]])
        got = grown(t, n, corner, steps)
        right = (steps + 1) ** 3
        t.require(len(got) == right, f"a corner grows into {len(got)} voxels, expected {right}")
        near = bool((np.abs(got - corner) <= steps).all())
        t.require(near, "a corner grows out of its corner")
    voxels = voxels_in(t, n, 6)
    parts = np.concatenate([grown(t, n, voxels[k : k + 1], 1) for k in range(6)])
    once = grown(t, n, voxels, 1)
    same_voxels(t, "six voxels grow as each alone", n, once, np.unique(parts, axis=0))
    same_voxels(t, "by 2, against by 1 twice", n, grown(t, n, voxels, 2), grown(t, n, once, 1))


def photographed(t, n, voxels, values, rays):
    """(colors, wanted, step) by `march` and `render`."""
    count = rays.shape[1]
    parts = Items(
        Array((count, 3)),
        Array((count, 2 * n), "bool"),
        Array((count,)),
        names=("colors", "wanted", "step"),
    )
    return t.call("adapters.picture", n, voxels, values, rays, returns=parts)


@check(
    "10.4.render",
    points=2,
    needs=EARLIER[:2],
    tolerance=SAME,
    hint="a sample in an empty cell reads the full cell next to it: dilated by one, not less",
    sole="skipping may save work, never change a picture",
)
def skipping_changes_nothing(t):
    """The picture of a sparse grid is that of all n^3 voxels, most of its samples skipped."""
    n = 8
    voxels, values = lump(t, n)
    rays = looking(t, 3, 6)
    some, wanted, step = photographed(t, n, voxels, values, rays)
    every = np.argwhere(np.ones((n, n, n), bool))
    dense = np.zeros((n**3, 4))
    dense[voxels @ np.array([n * n, n, 1])] = values
    whole, most, _ = photographed(t, n, every, dense, rays)
    t.require(bool(whole.any()), "the picture is black")
    t.close("colors", some, whole)
    t.require(bool(most[step > 0].all()), "with every voxel active no sample may be skipped")
    t.require(wanted.sum() < 0.8 * most.sum(), "hardly a sample was skipped")
