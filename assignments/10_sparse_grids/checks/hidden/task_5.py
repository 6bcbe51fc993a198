"""Task 10.5, hidden checks."""

import numpy as np
from photograd_course.grading import Subject, checks_for

from ..common import looking, same_voxels
from ..task_5 import CHAINED, STEPS, Fit, fitted, small_case

check = checks_for(calls=("fit_sparse",), needs=STEPS, visibility="hidden")


def for_steps(t, n):
    """Arguments of `fit_sparse`, for two rounds of n steps."""
    return *small_case(t, 4, 2, 3), 2, n, 0.01, 1


def for_rays(t, n):
    """The same for n rays through the middle of the cube, and two steps each round."""
    return *small_case(t, 4, n, 1), 2, 2, 0.01, 1


@check(
    "10.5.hidden",
    points=4,
    tolerance=CHAINED,
    sole="the same mistakes at unseen scenes",
    battery=[
        Subject("fit_sparse", for_steps, lambda n: Fit(2 * n), sizes=(0, 1, 3), large=20),
        Subject("fit_sparse", for_rays, lambda _: Fit(4), large=100),
    ],
)
def fits_of_random_scenes(t):
    """Three rounds of two steps end where they should."""
    given = *small_case(t), 3, 2, 0.05, 1
    given[2][::2, 3] /= 20
    got, right = fitted(t, *given), t.reference.fit_sparse(*given)
    same_voxels(t, "voxels", given[0], got[0], right[0])
    t.close("values", got[1], right[1])
    t.close("losses", got[2], right[2])


def rods(t, n):
    """(voxels, values) of three rods through the cube."""
    x = (np.argwhere(np.ones((n, n, n), bool)) + 0.5) / n * 2 - 1
    values = np.zeros((len(x), 4))
    for axis, paint in enumerate(((0.9, 0.5, 0.2), (0.3, 0.8, 0.3), (0.3, 0.5, 0.9))):
        away = np.delete(x, axis, axis=1) - t.rng.uniform(-0.45, 0.45, 2)
        inside = np.clip((0.17 - np.linalg.norm(away, axis=1)) * n / 3 + 0.5, 0, 1)
        inside *= np.abs(x[:, axis]) < 0.75
        values[inside > 0, :3] = paint
        values[:, 3] = np.maximum(values[:, 3], 8 * inside)
    active = values[:, 3] > 0
    return np.floor((x[active] + 1) / 2 * n).astype(np.int64), values[active]


@check(
    "10.5.topology",
    points=6,
    seconds=60.0,
    sole="the experiment: what the gradient cannot bring back, and who can",
)
def what_is_pruned_too_early_is_lost(t):
    """Pruned after four steps, a scene loses 3 dB for good, unless what is left may grow."""
    ref = t.reference
    n = 8
    voxels, values = rods(t, n)

    def seen(n, voxels, values, rays):
        return ref.render(values, ref.march(n, voxels, rays))

    rays, unseen = looking(t, 8, 5), looking(t, 4, 5)
    target, truth = (seen(n, voxels, values, each) for each in (rays, unseen))
    every = np.argwhere(np.ones((n, n, n), bool))
    start = np.tile(ref.START, (len(every), 1))
    scores = []
    for grow in (0, 1):
        found = fitted(t, n, every, start, rays, target, 4, 4, 0.05, grow)
        inside = bool(((found[0] >= 0) & (found[0] < n)).all())
        t.require(
            inside and len(np.unique(found[0], axis=0)) == len(found[0]),
            "voxels lie outside of the cube, or occur twice",
        )
        error = seen(n, found[0], found[1], unseen) - truth
        scores.append(-10 * np.log10(max(float(np.mean(error**2)), 1e-30)))
    lost, kept = scores
    # Eight seeds: 24.1 dB at worst, 5.1 dB more than without growth; an empty volume has 13.
    said = f"pruned and dilated {kept:.1f} dB, pruned alone {lost:.1f} dB"
    t.require(kept >= lost + 3.0, f"{said}: threshold 3 dB more")
    t.require(kept >= 20.8, f"{said}: threshold 20.8 dB when it may grow")
