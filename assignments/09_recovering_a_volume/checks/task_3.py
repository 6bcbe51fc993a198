"""Task 09.3, public checks."""

import numpy as np
from photograd_course.grading import Number, checks_for
from photograd_course.grading.adjoint_gate import central_differences, require_zero_for_zero

from .common import EXACT, GATE, loss_and_slope, random_views

check = checks_for(calls=("mse_and_cotangent",), tolerance=GATE)

# What a renderer of 08 needs for the gradient of a few rays: 0.05 s in whole arrays.
PATIENCE = 5.0


@check(
    "09.3.values",
    points=3,
    tolerance=EXACT,
    hint="handout, equation (7): over which axis is the mean, over which the sum?",
    sole="small enough to work out by hand",
)
def the_loss_of_known_errors(t):
    """Errors of (a, b, c) at every ray are a loss of a^2 + b^2 + c^2, however many rays."""
    error = t.rng.uniform(0.1, 0.5, 3) * [1, -1, 1]
    for n in (1, 4, 9):
        truth = t.rng.uniform(0.0, 1.0, (n, 3))
        loss, d = t.call("mse_and_cotangent", truth + error, truth, returns=loss_and_slope((n, 3)))
        t.close(f"loss of {n} rays", loss, error @ error, reveal=True)
    loss, d = t.call("mse_and_cotangent", truth, truth, returns=loss_and_slope((9, 3)))
    t.require(loss == 0, "the loss of what is equal must be 0")
    require_zero_for_zero(t, {"pixels": d})


ROOT = "You return the root of the loss."
APART = (
    "The loss of errors that can be worked out by hand is wrong already: begin with 09.3.values."
)


def advice_on_loss(t):
    """What is wrong with the loss itself, by errors whose loss can be worked out by hand."""
    error = np.array([0.3, -0.4, 1.2])
    shown = loss_and_slope((5, 3))
    loss, _ = t.call("mse_and_cotangent", np.tile(error, (5, 1)), np.zeros((5, 3)), returns=shown)
    if abs(loss - error @ error) < 1e-9:
        return ""
    return ROOT if abs(loss**2 - error @ error) < 1e-9 else APART


def slope_of_loss(t, pixels, truth):
    """The derivative of `mse_and_cotangent`, and what differences of its loss say it is."""
    shown = loss_and_slope(pixels.shape)
    _, d = t.call("mse_and_cotangent", pixels, truth, returns=shown)

    def forward(point):
        given = point["pixels"], truth
        return np.array(t.call("mse_and_cotangent", *given, returns=shown)[0])

    return d, central_differences(forward, {"pixels": pixels}, "pixels", np.ones(()))


@check(
    "09.3.differences",
    points=3,
    hint="differentiate equation (7) by one number of one ray",
    sole="the derivative itself, without the reference",
)
def the_cotangent_agrees_with_differences(t):
    """A small change of a pixel changes your loss as your derivative says."""
    d, expected = slope_of_loss(t, *t.rng.uniform(0.0, 1.0, (2, 5, 3)))
    t.require(bool(expected.any()), "your loss does not change with the pixels")
    t.close("d_pixels", d, expected, GATE, hint=advice_on_loss(t))


RENDERER = (
    "your cotangent agrees with your loss: between it and the voxels lies volume_rendering.py; "
    "photograd course check 08"
)


@check(
    "09.3.chain",
    points=4,
    calls=("mse_and_cotangent", "render_rays", "render_adjoint"),
    needs=("ray_batch",),
    seconds=PATIENCE,
    hint="the chain rule, from the pixels to the voxels",
    sole="no fit before the gradient is proved: with your renderer of 08",
)
def from_photographs_to_voxels(t):
    """Moving one voxel moves the loss of your photographs as your adjoint of 08 says."""
    views = random_views(t, 2, 3, 3)
    grid = t.rng.uniform(0.2, 1.0, (2, 1, 3, 4))
    _, d_grid = t.call(
        "adapters.gradient_of_views", grid, views, returns=loss_and_slope(grid.shape)
    )

    def forward(point):
        moved = np.concatenate([point["color"], point["sigma"][..., None]], axis=3)
        return np.array(t.call("adapters.loss_of_views", moved, views, returns=Number()))

    point = {"color": grid[..., :3], "sigma": grid[..., 3]}
    slopes = {"color": d_grid[..., :3], "sigma": d_grid[..., 3]}
    d, expected = slope_of_loss(t, *t.rng.uniform(0.0, 1.0, (2, 5, 3)))
    begins_well = np.linalg.norm(d - expected) <= GATE.relative * np.linalg.norm(expected)
    for name, slope in slopes.items():
        right = central_differences(forward, point, name, np.ones(()))
        t.require(bool(right.any()), f"your loss does not change with {name}")
        # Another name where 08 is to blame: its mistakes may give the numbers of known ones of 09.
        what = f"d_{name} by volume_rendering.py" if begins_well else f"d_{name}"
        t.close(what, slope, right, hint=RENDERER if begins_well else advice_on_loss(t))
