"""Task 09.4, public checks."""

import numpy as np
from photograd_course.grading import Tolerance, checks_for
from photograd_course.grading.adjoint_gate import agrees_with_finite_differences

from .common import EXACT, GATE, rough

check = checks_for(calls=("tv_loss_adjoint",), tolerance=EXACT)

ROUGHNESS = (
    "handout, equations (8) and (9): three differences under one root; none at the far "
    "border; the mean over voxels, the sum over channels"
)


@check("09.4.values", points=4, hint=ROUGHNESS, sole="small enough to work out by hand")
def the_roughness_of_ramps(t):
    """The loss of even slopes has a closed form: inside, on a border, along an edge; flat has 0."""
    flat, slope = rough(t, np.full((3, 2, 4, 2), 0.7), 0.1)
    t.require(abs(flat) < 1e-14, "the total variation of what is flat must be 0")
    t.require(not np.abs(slope).max() > 1e-14, "the derivative of what is flat must be 0")
    shape = np.array([4, 3, 5])
    a, eps = t.rng.uniform(0.2, 0.6, 3), float(t.rng.uniform(0.1, 0.3))
    cells = np.stack(np.indices(tuple(shape)), axis=-1)
    for axis in range(3):
        grid = (a[axis] * cells[..., axis])[..., None]
        expected = (1 - 1 / shape[axis]) * (np.hypot(eps, a[axis]) - eps)
        t.close(f"loss of a ramp along axis {axis}", rough(t, grid, eps)[0], expected, reveal=True)
    inside = np.minimum(cells, shape - 2)  # of a ramp along all axes: which differences are there
    there = (cells == inside) * a
    expected = np.mean(np.sqrt(eps**2 + np.sum(there**2, axis=-1)) - eps)
    grid = np.stack([cells @ a, -(cells @ a)], axis=-1)
    t.close("loss of two channels", rough(t, grid, eps)[0], 2 * expected, reveal=True)


@check(
    "09.4.differences",
    points=5,
    tolerance=GATE,
    hint="handout, section 4: a value is in its own difference and in that of the voxel before",
    sole="the gradient itself, without the reference",
)
def the_slope_of_roughness_agrees_with_differences(t):
    """A small change of a number changes your total variation as your derivative says."""
    for shape, eps in (((3, 4, 2, 2), 0.3), ((1, 3, 2, 1), 0.1), ((2, 1, 1, 2), 1.0)):
        grid = t.rng.uniform(0.0, 1.0, shape)
        _, d_grid = rough(t, grid, eps)

        def forward(point, eps=eps):
            return np.array(rough(t, point["grid"], eps)[0])

        agrees_with_finite_differences(
            t, {"grid": d_grid}, forward, {"grid": grid}, np.ones(()), GATE
        )


@check(
    "09.4.balance",
    points=2,
    hint="what a difference takes at one end it gives at the other",
    sole="tells at a glance which end of a difference is missing",
)
def derivatives_of_a_channel_sum_to_zero(t):
    """Lifting a whole channel changes nothing: its derivatives sum to 0. Channels are apart."""
    grid = t.rng.uniform(0.0, 1.0, (3, 4, 5, 3))
    loss, d_grid = rough(t, grid, 0.2)
    lifted = rough(t, grid + np.array([0.3, -0.2, 1.0]), 0.2)
    t.close("loss of a lifted volume", lifted[0], loss, hint=ROUGHNESS)
    size = float(np.linalg.norm(d_grid))
    total = d_grid.sum(axis=(0, 1, 2))
    bound = Tolerance(EXACT.relative, EXACT.evidence, floor=max(size, 1e-300))
    t.close("sum over voxels", total, 0 * total, bound, reveal=True)
    alone = [rough(t, grid[..., c : c + 1], 0.2) for c in range(3)]
    total = sum(each[0] for each in alone)
    t.close("loss, channel by channel", total, loss, hint=ROUGHNESS)
    t.close(
        "derivative, channel by channel",
        np.concatenate([each[1] for each in alone], axis=3),
        d_grid,
        hint="each channel goes by itself: no derivative reads another channel",
    )
