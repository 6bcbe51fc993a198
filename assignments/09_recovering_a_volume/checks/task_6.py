"""Task 09.6, public checks."""

import numpy as np
from photograd_course.grading import Array, Items, Number, Tolerance, agree, checks_for

from .common import EARLIER, batch, loss_and_slope, random_views, rough

CHAINED = Tolerance(
    1e-7, "right ones differ by at most 1e-10, the nearest wrong one (fit_colors_free) by 1e-3"
)
RATES = np.array([0.05, 0.05, 0.05, 0.5])


def ball_views(t, count=2, size=5):
    """Photographs of an opaque ball of one color before a dark background, by ray and sphere."""
    views = random_views(t, count, size, size)
    center, radius = t.rng.uniform(-0.2, 0.2, 3), t.rng.uniform(0.4, 0.6)
    axis = ((np.arange(size) + 0.5) - size / 2) / views["focal"]
    down, side = np.meshgrid(axis, axis, indexing="ij")
    local = np.stack([side, down, np.ones_like(side)], axis=2)
    views["background"] = t.rng.uniform(0.0, 0.1, 3)
    for k, pose in enumerate(views["world_from_camera"]):
        d = local @ pose[:3, :3].T
        d /= np.linalg.norm(d, axis=2, keepdims=True)
        away = center - pose[:3, 3]
        along = d @ away
        hit = away @ away - along**2 < radius**2
        views["pictures"][k] = np.where(
            hit[..., None], t.rng.uniform(0.6, 1.0, 3), views["background"]
        )
    return views


ALL = (*EARLIER, "tv_loss_adjoint")

check = checks_for(calls=("fit_volume",), needs=ALL)


def fitted(t, views, grid, steps, seed=5, adapter="fit"):
    """`fit_volume` of the submission."""
    parts = Items(Array(grid.shape), Array((steps,)), names=("grid", "losses"))
    return t.call(f"adapters.{adapter}", views, grid, steps, seed, returns=parts)


def stepped(t, views, grid):
    """Loss and derivative of a step that sees all pixels, put together from your functions."""
    loss, d_grid = t.call(
        "adapters.gradient_of_views", grid, views, returns=loss_and_slope(grid.shape)
    )
    more, d_more = rough(t, grid, 0.1)
    return loss + 0.01 * more, d_grid + 0.01 * d_more


def kept(grid):
    """Within the limits."""
    return np.concatenate([np.clip(grid[..., :3], 0, 1), np.maximum(grid[..., 3:], 0)], axis=3)


def small_start(t, shape=(3, 2, 4)):
    """A volume from which a step leaves the limits here and there."""
    return t.rng.choice([0.02, 0.5, 0.97], (*shape, 4))


@check(
    "09.6.first",
    points=4,
    tolerance=CHAINED,
    hint="handout, equations (13) to (16), in this order",
    sole="tests the first two steps only",
)
def the_first_steps(t):
    """With few pixels a step sees all of them: two steps of Adam end where your derivatives say."""
    views, grid = random_views(t, 2, 4, 5), small_start(t)
    views["pictures"][:, :, :3] = views["background"]
    loss, first = stepped(t, views, grid)
    free = grid - RATES * first / (np.abs(first) + 1e-8)
    t.require(bool((free[..., 3] < 0).any() and (free[..., 3] > 0).any()), "not telling")
    t.require(bool((free[..., :3] > 1).any() or (free[..., :3] < 0).any()), "not telling")
    one, losses = fitted(t, views, grid, 1)
    t.close("losses", losses, np.array([loss]))
    t.close("colors after one step", one[..., :3], kept(free)[..., :3])
    t.close("sigma after one step", one[..., 3], kept(free)[..., 3])
    again, second = stepped(t, views, one)
    two, losses = fitted(t, views, grid, 2)
    m = (0.09 * first + 0.1 * second) / (1 - 0.9**2)
    v = (0.0099 * first**2 + 0.01 * second**2) / (1 - 0.99**2)
    t.close("losses of two steps", losses, np.array([loss, again]))
    t.close("volume after two steps", two, kept(one - RATES * m / (np.sqrt(v) + 1e-8)))


@check(
    "09.6.draws",
    points=3,
    tolerance=CHAINED,
    hint="one draw in each step, all of it used, and rng for nothing else",
    sole="asks which pixels a step sees",
)
def each_step_draws_its_own_pixels(t):
    """Where there are more pixels than RAYS, each step's loss is that of its own draw."""
    views, grid = random_views(t, 2, 12, 12), small_start(t, (2, 2, 3))
    chosen = t.call("adapters.draws", views, 8, 2, returns=Array((2, 192), "i8"))
    expected, reached = [], [grid]
    for k in (1, 2):
        found, losses = fitted(t, views, grid, k, 8)
        reached.append(found)
    flat = views["pictures"].reshape(1, -1, 3)
    for k in (0, 1):
        # The drawn pixels alone, as photographs of one pixel each cannot be had: ask the parts.
        origins, directions, truth = t.call("ray_batch", views, chosen[k], returns=batch(192))
        t.close("truth", truth, flat[0, chosen[k]])
        box = views["low"], views["high"]
        seen = t.call(
            "render_rays",
            reached[k],
            *box,
            origins,
            directions,
            16,
            views["background"],
            returns=Array((192, 3)),
        )
        loss = t.call("mse_and_cotangent", seen, truth, returns=loss_and_slope((192, 3)))[0]
        expected.append(loss + 0.01 * rough(t, reached[k], 0.1)[0])
    t.close("losses", losses, np.array(expected))


@check(
    "09.6.falls",
    points=3,
    hint="downhill is against the derivative",
    sole="from any start, on any scene",
)
def the_first_step_goes_down(t):
    """For 20 scenes, one step from fog lowers the loss of the photographs."""
    fog = np.full((5, 5, 5, 4), 0.5)
    fog[..., 3] = 0.1
    for scene in range(20):
        views = ball_views(t)
        before = t.call("adapters.loss_of_views", fog, views, returns=Number())
        found, _ = fitted(t, views, fog, 1, scene)
        after = t.call("adapters.loss_of_views", found, views, returns=Number())
        t.require(after < before, f"scene {scene}: the loss rose from {before:.4g} to {after:.4g}")


@check(
    "09.6.start",
    points=1,
    hint="often an array of the start is written into, or given back: copy it first",
)
def the_start_is_left_alone(t):
    """A second fit from the same array finds what the first one did; without steps a copy comes."""
    views, grid = random_views(t, 1, 2, 2), small_start(t, (2, 2, 2))
    again = fitted(t, views, grid, 2, adapter="fit_again")
    same = agree(again, fitted(t, views, grid, 2))
    t.require(same, "a second fit from the same start ends elsewhere")
    t.close("volume after no steps", fitted(t, views, grid, 0)[0], grid, CHAINED)
