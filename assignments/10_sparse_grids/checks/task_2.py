"""Task 10.2, public checks."""

import numpy as np
from photograd_course.grading import Array, checks_for
from photograd_course.grading.failures import CheckFailed

from .common import blocks, equal_cubes, same_counts

check = checks_for(calls=("skip_empty",))


def counting_leaf(full, asked, most=np.inf):
    """A service that tells the leaf of points and notes in `asked` how many there were."""
    n, side = len(full), equal_cubes(full)

    def leaf(points):
        if not (isinstance(points, np.ndarray) and points.ndim == 2 and points.shape[1] == 3):
            raise CheckFailed("skip_empty: leaf wants points: an array of shape (M, 3)")
        if not ((points > -1e-6) & (points < n + 1e-6)).all():
            raise CheckFailed("skip_empty: a point that was looked up lies outside of the cube")
        asked.append(len(points))
        if sum(asked) > most:
            raise CheckFailed(
                "skip_empty: asks without end; a ray stands still",
                {"advice": "a ray stands still: on a face u is 0, see the 1 in equation (8)"},
            )
        cell = np.clip(np.floor(points), 0, n - 1).astype(np.int64)
        size = side[tuple(cell.T)]
        low = cell // size[:, None] * size[:, None]
        return full[tuple(cell.T)], low.astype(float), size.astype(float)

    return leaf


def rays_within(t, n, rays, count, still=0):
    """(first, stride) of rays whose samples all lie inside; `still` axes do not move."""
    ends = t.rng.uniform(0.02 * n, 0.98 * n, (2, rays, 3))
    first, stride = ends[0], (ends[1] - ends[0]) / max(count - 1, 1)
    for ray in range(rays):
        stride[ray, t.rng.permutation(3)[:still]] = 0.0
    return first, stride


def cells_on(first, stride, count):
    """The cell (R, count, 3) of every sample."""
    return np.floor(first[:, None] + np.arange(count)[:, None] * stride[:, None]).astype(np.int64)


def skipped(t, full, first, stride, count):
    """(wanted, points that were looked up)."""
    asked = []
    # No ray has more lookups than samples, unless it stands still; many more end the loop.
    most = 20 * len(first) * count + 200
    got = t.call(
        "skip_empty",
        counting_leaf(full, asked, most),
        first,
        stride,
        count,
        returns=Array((len(first), count), "bool"),
    )
    return got, sum(asked)


def same_samples(t, got, right):
    same_counts(t, "wanted samples", got, right)


@check(
    "10.2.samples",
    points=5,
    hint="the first face ahead is the nearest of three; samples before it share the leaf",
    sole="the picture depends on nothing else",
)
def samples_in_full_leaves(t):
    """Exactly the samples in full leaves are wanted, on rays that go anywhere."""
    for n, rays, count in ((8, 9, 40), (4, 5, 7), (8, 4, 1), (1, 3, 5)):
        for still in (0, 1, 2):
            full = blocks(t, n)
            first, stride = rays_within(t, n, rays, count, still)
            got, _ = skipped(t, full, first, stride, count)
            same_samples(t, got, full[tuple(np.moveaxis(cells_on(first, stride, count), 2, 0))])


@check(
    "10.2.faces",
    points=2,
    hint="the ray leaves by the nearest face, the minimum in (7); a point on a common face belongs "
    "to the upper leaf, so that going down u may be 0 there",
    sole="points that a random ray never meets, and a lattice always",
)
def samples_on_faces(t):
    """Samples that lie exactly on faces belong to the upper leaf, and nothing stands still."""
    n, count = 8, 9
    full = np.zeros((n, n, n), bool)
    full[4:] = True
    full[:, 2, :] ^= True
    for way in (0.5, -0.5):
        a, b = 4.0 - 4 * way, 2.0 - 2 * way
        first = np.array([[a, 2.5, 3.25], [2.5, b, 1.25], [1.5, 4.5, a], [a, b, 5.5]])
        stride = way * np.array([[1.0, 0, 0], [0, 0.5, 0], [0, 0, 1], [1, 0.5, 0]])
        got, _ = skipped(t, full, first, stride, count)
        same_samples(t, got, full[tuple(np.moveaxis(cells_on(first, stride, count), 2, 0))])


@check(
    "10.2.cost",
    points=5,
    hint="one lookup for each leaf that a ray passes; then over all samples in it at once",
    sole="what skipping is for: lookups are counted, not seconds",
)
def a_leaf_is_asked_for_once(t):
    """The samples are right, and for each leaf on a ray one point is looked up, not each sample."""
    n, count = 16, 90
    full = np.zeros((n, n, n), bool)
    full[3:9, 4:12, 5:11] = full[12:14, 1:4, 8:15] = True
    ways = (
        ("", 1, 0),
        ("going down, the face ahead is the lower one, at low", -1, 0),
        ("where a stride is 0 there is no face ahead: ignore that axis", 1, 1),
        ("where a stride is 0 there is no face ahead: ignore that axis", 1, 2),
    )
    for hint, way, still in ways:
        first, stride = rays_within(t, n, 12, count)
        last = first + (count - 1) * stride
        first, stride = (np.minimum if way > 0 else np.maximum)(first, last), way * np.abs(stride)
        stride[:, :still] = 0.0
        got, asked = skipped(t, full, first, stride, count)
        cells = tuple(np.moveaxis(cells_on(first, stride, count), 2, 0))
        same_samples(t, got, full[cells])
        size = equal_cubes(full)[cells]
        leaf = np.stack(cells, axis=2) // size[:, :, None] * size[:, :, None]
        passed = len(leaf) + int((leaf[:, 1:] != leaf[:, :-1]).any(axis=2).sum())
        t.require(
            asked <= 1.3 * passed,
            f"{asked} points were looked up; the rays pass {passed} leaves",
            hint=hint,
        )
