"""Helpers for the checks of several tasks."""

import numpy as np
from photograd_course.grading import Tolerance
from photograd_course.grading.failures import CheckFailed

FAITHFUL = Tolerance(1e-12, "numbers that are handed on unchanged")


def same_counts(t, what, got, right, hint=""):
    """Like `t.close`, for counts and truths: says what is there and what should be."""
    try:
        t.close(what, got, right, FAITHFUL, reveal=True, hint=hint)
    except CheckFailed as failure:
        told = "tolerance" in failure.details and t.check.visibility == "public"
        if told and np.ndim(right) == 0:
            failure.text = f"{what}: {got}, expected {right}"
        elif told:
            got, right = np.asarray(got), np.asarray(right)
            off = np.argwhere(got != right)
            at = tuple(off[0].tolist())
            failure.text = (
                f"{what}: {len(off)} of {right.size} are wrong, the first at index "
                f"{at}: {got[at]}, expected {right[at]}"
            )
        raise


def blocks(t, n, cut=0.75):
    """A random cube (n, n, n) of bool with uniform parts of all sizes."""
    if n == 1 or t.rng.random() > cut:
        return np.full((n, n, n), t.rng.random() < 0.5)
    half = n // 2
    full = np.zeros((n, n, n), bool)
    for octant in np.ndindex(2, 2, 2):
        where = tuple(slice(half * up, half * up + half) for up in octant)
        full[where] = blocks(t, half, cut)
    return full


def equal_cubes(full):
    """For each cell the side (n, n, n) of the largest cube of the octree that is all alike."""
    n, side, size = len(full), 1, np.ones(full.shape, np.int64)
    while side < n:
        side *= 2
        m = n // side
        parts = full.reshape(m, side, m, side, m, side)
        alike = parts.all(axis=(1, 3, 5)) | ~parts.any(axis=(1, 3, 5))
        for axis in range(3):
            alike = np.repeat(alike, side, axis=axis)
        size[alike] = side
    return size


def in_order(voxels):
    """By x, then y, then z."""
    return voxels[np.lexsort(voxels.T[::-1])]


def marked(voxels, n):
    """(n, n, n), how often each voxel of the cube is in a list."""
    often = np.zeros((n, n, n))
    inside = ((voxels >= 0) & (voxels < n)).all(axis=1)
    np.add.at(often, tuple(voxels[inside].T), 1.0)
    return often


def same_voxels(t, what, n, got, right, hint=""):
    inside = bool(((got >= 0) & (got < n)).all())
    cut = "handout, equation (12): growth is cut off at the faces of the cube"
    t.require(inside, f"{what}: a voxel lies outside of the cube", hint=cut)
    same_counts(
        t,
        f"{what}, how often each voxel is there",
        marked(got, n).astype(np.int64),
        marked(right, n).astype(np.int64),
        hint,
    )
    t.require(
        bool((got == in_order(got)).all()),
        f"{what}: not ordered by x, then y, then z",
        hint="sort the list: by x, where that is the same by y, then by z",
    )


# What `march` is made of.
EARLIER = ("octree_from_dense", "skip_empty", "prune_and_dilate")


def looking(t, views, size):
    """Rays (2, views size^2, 3) of cameras all around, 3.2 from the middle."""
    middle = t.rng.normal(size=(views, 3))
    middle /= np.linalg.norm(middle, axis=1, keepdims=True)
    right = np.cross(middle, t.rng.normal(size=(views, 3)))
    right /= np.linalg.norm(right, axis=1, keepdims=True)
    up = np.cross(middle, right)
    a = ((np.arange(size) + 0.5) / size * 2 - 1) * 0.38
    v, u = (each.ravel()[None, :, None] for each in np.meshgrid(a, a, indexing="ij"))
    d = -middle[:, None] + u * right[:, None] - v * up[:, None]
    d /= np.linalg.norm(d, axis=2, keepdims=True)
    return np.stack([np.repeat(3.2 * middle, size**2, axis=0), d.reshape(-1, 3)])


def lump(t, n, radius=0.5):
    """(voxels, values) of a random lump in the middle of the cube."""
    x = (np.argwhere(np.ones((n, n, n), bool)) + 0.5) / n * 2 - 1
    inside = np.linalg.norm(x - t.rng.uniform(-0.2, 0.2, 3), axis=1) < radius
    inside &= t.rng.random(len(x)) < 0.7
    voxels = np.floor((x[inside] + 1) / 2 * n).astype(np.int64)
    values = t.rng.uniform(0.1, 1.0, (len(voxels), 4))
    values[:, 3] *= 6
    return voxels, values
