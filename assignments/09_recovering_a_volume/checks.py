"""Checks of assignment 09."""

from __future__ import annotations

import numpy as np
from photograd_course.grading import Array, Items, Number, Subject, Tolerance, agree, check
from photograd_course.grading.adjoint_gate import (
    central_differences,
    require_cheap,
    require_gradients,
    require_zero_for_zero,
)

# Evidence: worst of the solution and three alternatives, against the nearest of all named wrong
# solutions.
EXACT = Tolerance(
    1e-11, "right ones differ by at most 1e-15, the nearest wrong one (psnr_capped) by 6e-10"
)
DECIBELS = Tolerance(EXACT.relative, EXACT.evidence, floor=100.0)
GATE = Tolerance(1e-6, "differences leave 2e-10, the nearest wrong one (mse_root) 0.2")
CHAINED = Tolerance(
    1e-7, "right ones differ by at most 1e-10, the nearest wrong one (fit_colors_free) by 1e-3"
)
RATES = np.array([0.05, 0.05, 0.05, 0.5])
# One pass over a picture against total variation of as many numbers with its derivative: 20 to 40
# where whole arrays are used, 700 in loops over single numbers, 40,000 for differences.
TV_COST = 2500.0
# What a renderer of 08 needs for the gradient of a few rays: 0.05 s in whole arrays.
PATIENCE = 5.0


def turned(rng):
    """A rotation (3, 3) about any axis."""
    q, r = np.linalg.qr(rng.normal(size=(3, 3)))
    q = q * np.sign(np.diag(r))
    q[:, 0] *= np.sign(np.linalg.det(q))
    return q


def looking(place, roll=0.0):
    """The pose of a camera at a place that looks at the origin."""
    forward = -place / np.linalg.norm(place)
    side = np.cross(forward, [0.3, 1.0, 0.2])
    side /= np.linalg.norm(side)
    down = np.cross(forward, side)
    c, s = np.cos(roll), np.sin(roll)
    pose = np.eye(4)
    pose[:3, :3] = np.stack([c * side + s * down, c * down - s * side, forward], axis=1)
    pose[:3, 3] = place
    return pose


def around(count, distance=3.2, turn=0.0, roll=0.0):
    """Poses (count, 4, 4) of cameras all around the origin."""
    height = 1 - (np.arange(count) + 0.5) * 2 / count
    phi = np.arange(count) * 2.399963 + turn
    ring = np.sqrt(1 - height**2)
    places = np.stack([ring * np.cos(phi), height, ring * np.sin(phi)], axis=1)
    return np.stack([looking(distance * place, roll) for place in places])


def views_of(pictures, poses, background, focal=None):
    """Views of the box from -1 to 1, which fits into each picture."""
    width = pictures.shape[2]
    return {
        "pictures": pictures,
        "world_from_camera": poses,
        "focal": focal or 1.25 * width,
        "low": np.full(3, -1.0),
        "high": np.full(3, 1.0),
        "background": background,
    }


def random_views(t, count=2, rows=3, columns=4):
    """Views of random colours by cameras all around."""
    pictures = t.rng.uniform(0.0, 1.0, (count, rows, columns, 3))
    poses = around(count, turn=t.rng.uniform(0, 6), roll=t.rng.uniform(-0.5, 0.5))
    return views_of(pictures, poses, t.rng.uniform(0.0, 0.5, 3))


def ball_views(t, count=2, size=5):
    """Photographs of an opaque ball of one colour before a dark background, by ray and sphere."""
    views = random_views(t, count, size, size)
    centre, radius = t.rng.uniform(-0.2, 0.2, 3), t.rng.uniform(0.4, 0.6)
    axis = ((np.arange(size) + 0.5) - size / 2) / views["focal"]
    down, side = np.meshgrid(axis, axis, indexing="ij")
    local = np.stack([side, down, np.ones_like(side)], axis=2)
    views["background"] = t.rng.uniform(0.0, 0.1, 3)
    for k, pose in enumerate(views["world_from_camera"]):
        d = local @ pose[:3, :3].T
        d /= np.linalg.norm(d, axis=2, keepdims=True)
        away = centre - pose[:3, 3]
        along = d @ away
        hit = away @ away - along**2 < radius**2
        views["pictures"][k] = np.where(
            hit[..., None], t.rng.uniform(0.6, 1.0, 3), views["background"]
        )
    return views


def batch(n):
    """What `ray_batch` returns."""
    return Items(
        Array((n, 3)), Array((n, 3)), Array((n, 3)), names=("origins", "directions", "truth")
    )


def unit(v):
    """Rows of length 1."""
    return v / np.maximum(np.linalg.norm(v, axis=1, keepdims=True), 1e-300)


# 09.1 ---------------------------------------------------------------------------------------------


@check(
    "09.1.values",
    task="09.1",
    points=3,
    calls=("psnr",),
    tolerance=EXACT,
    hint="handout, equation (3): decibels are ten times the decimal logarithm",
    sole="small enough to work out by hand",
)
def known_decibels(t):
    """An error of 0.1 everywhere is 20 dB, of 0.01 40 dB; twice the error costs 6.02 dB."""
    picture = t.rng.uniform(0.0, 1.0, (4, 5, 3))
    for error, decibels in ((0.1, 20.0), (0.01, 40.0), (1.0, 0.0)):
        way = np.where(t.rng.random(picture.shape) < 0.5, -error, error)
        got = t.call("psnr", picture + way, picture, returns=Number())
        t.close(f"an error of {error:g}", got, decibels, DECIBELS, reveal=True)
    rough = t.rng.normal(size=picture.shape) * 0.05
    once, twice = (t.call("psnr", picture + k * rough, picture, returns=Number()) for k in (1, 2))
    t.close("what twice the error costs", once - twice, 20 * np.log10(2), reveal=True)
    with np.errstate(divide="ignore"):
        got = t.call("psnr", picture, picture, returns=Number(finite=False))
    t.require(got == np.inf, "equal pictures have infinitely many decibels")


@check(
    "09.1.mean",
    task="09.1",
    points=2,
    calls=("psnr",),
    tolerance=EXACT,
    hint="handout, section 1: first one mean over everything, then one logarithm",
    sole="says that the mean comes first",
)
def one_mean_for_all(t):
    """One wrong number among n has 10 log10 n decibels more than n of them, wherever it is."""
    for shape in ((4, 5, 3), (2, 3, 4, 3), (7, 3)):
        truth = t.rng.uniform(0.0, 1.0, shape)
        one = truth.copy()
        one[tuple(t.rng.integers(0, n) for n in shape)] += 0.5
        got = t.call("psnr", one, truth, returns=Number())
        all_wrong = t.call("psnr", truth - 0.5, truth, returns=Number())
        t.close(f"decibels more, {shape}", got - all_wrong, 10 * np.log10(truth.size), reveal=True)


# 09.2 ---------------------------------------------------------------------------------------------


@check(
    "09.2.middle",
    task="09.2",
    points=3,
    calls=("ray_batch",),
    tolerance=EXACT,
    hint="handout, section 2: the pose's columns are right, down, forward, and the place",
    sole="names the part of the pose that is misread",
)
def the_middle_pixel_looks_forward(t):
    """With odd H and W the middle ray starts at the camera and follows its forward axis."""
    views = random_views(t, 3, 5, 7)
    poses = views["world_from_camera"]
    poses[:, :3, 3] += t.rng.normal(size=(3, 3))  # or o would lie along the forward axis
    middle = np.array([k * 35 + 2 * 7 + 3 for k in (2, 0, 1)])
    origins, directions, _ = t.call("ray_batch", views, middle, returns=batch(3))
    t.close("origins", origins, poses[[2, 0, 1], :3, 3], reveal=True)
    t.close("directions, made unit vectors", unit(directions), poses[[2, 0, 1], :3, 2], reveal=True)


@check(
    "09.2.projected",
    task="09.2",
    points=4,
    calls=("ray_batch",),
    tolerance=EXACT,
    hint="handout, equations (4) to (6): what projects to the middle of that pixel?",
    sole="needs no formula for a ray: only that it is seen where it should be",
)
def points_of_a_ray_are_seen_in_its_pixel(t):
    """A point on a ray projects to the middle of the pixel, in pictures of any shape."""
    for rows, columns in ((3, 5), (6, 4)):
        views = random_views(t, 2, rows, columns)
        chosen = t.rng.permutation(2 * rows * columns)[:9]
        origins, directions, _ = t.call("ray_batch", views, chosen, returns=batch(9))
        view, row, column = np.unravel_index(chosen, (2, rows, columns))
        point = origins + t.rng.uniform(1.0, 3.0, (9, 1)) * directions
        pose = views["world_from_camera"][view]
        seen = np.einsum("rji,rj->ri", pose[:, :3, :3], point - pose[:, :3, 3])
        t.require(
            bool((seen[:, 2] > 0).all()),
            "a ray goes backwards: forward is +z",
            hint="if 09.2.middle fails too, look there first",
        )
        places = views["focal"] * seen[:, :2] / seen[:, 2:] + [columns / 2, rows / 2]
        t.close(
            "where points are seen (column, row)",
            places,
            np.stack([column + 0.5, row + 0.5], axis=1),
            reveal=True,
        )


@check(
    "09.2.truth",
    task="09.2",
    points=2,
    calls=("ray_batch",),
    tolerance=EXACT,
    hint="pixels are counted as they lie in memory: picture by picture, row by row",
    sole="asks about the colours alone",
)
def colours_belong_to_the_chosen_pixels(t):
    """The colours are those of the chosen pixels, in that order, repeated ones too."""
    views = random_views(t, 3, 2, 4)
    chosen = np.array([23, 0, 5, 8, 5, 16, 19])
    _, _, truth = t.call("ray_batch", views, chosen, returns=batch(7))
    t.close("truth", truth, views["pictures"].reshape(-1, 3)[chosen], reveal=True)


# 09.3 ---------------------------------------------------------------------------------------------


def loss_and_slope(shape):
    """What `mse_and_cotangent` and `tv_loss_adjoint` return."""
    return Items(Number(), Array(shape), names=("loss", "derivative"))


@check(
    "09.3.values",
    task="09.3",
    points=3,
    calls=("mse_and_cotangent",),
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
    "Loss and derivative do not belong together: one of them divides by something that the "
    "other does not. See 09.3.values."
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
    task="09.3",
    points=3,
    calls=("mse_and_cotangent",),
    tolerance=GATE,
    hint="differentiate equation (7) by one number of one ray",
    sole="the derivative itself, without the reference",
)
def the_cotangent_agrees_with_differences(t):
    """Moving a pixel by a little moves your loss as your derivative says."""
    d, expected = slope_of_loss(t, *t.rng.uniform(0.0, 1.0, (2, 5, 3)))
    t.require(bool(expected.any()), "your loss does not change with the pixels")
    t.close("d_pixels", d, expected, GATE, hint=advice_on_loss(t))


RENDERER = (
    "your cotangent is right: what lies between it and the voxels is volume_rendering.py; "
    "photograd course check 08"
)


@check(
    "09.3.chain",
    task="09.3",
    points=4,
    calls=("mse_and_cotangent", "render_rays", "render_adjoint"),
    needs=("ray_batch",),
    tolerance=GATE,
    seconds=PATIENCE,
    hint="mend what fails above first",
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


# 09.4 ---------------------------------------------------------------------------------------------


def rough(t, grid, eps):
    """`tv_loss_adjoint` of the hand-in."""
    return t.call("tv_loss_adjoint", grid, eps, returns=loss_and_slope(grid.shape))


ROUGHNESS = (
    "handout, equations (8) and (9): three differences under one root; none at the far "
    "border; the mean over voxels, the sum over channels"
)


@check(
    "09.4.values",
    task="09.4",
    points=4,
    calls=("tv_loss_adjoint",),
    tolerance=EXACT,
    hint=ROUGHNESS,
    sole="small enough to work out by hand",
)
def the_roughness_of_ramps(t):
    """The loss of even slopes has a closed form: inside, on a border, along an edge; flat has 0."""
    flat, slope = rough(t, np.full((3, 2, 4, 2), 0.7), 0.1)
    t.require(abs(flat) < 1e-14, "the roughness of what is flat must be 0")
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
    task="09.4",
    points=5,
    calls=("tv_loss_adjoint",),
    tolerance=GATE,
    hint="handout, section 4: a value is in its own difference and in that of the voxel before",
    sole="the gradient itself, without the reference",
)
def the_slope_of_roughness_agrees_with_differences(t):
    """Moving a number moves your roughness as your derivative says, one voxel wide grids too."""
    for shape, eps in (((3, 4, 2, 2), 0.3), ((1, 3, 2, 1), 0.1), ((2, 1, 1, 2), 1.0)):
        grid = t.rng.uniform(0.0, 1.0, shape)
        _, d_grid = rough(t, grid, eps)

        def forward(point, eps=eps):
            return np.array(rough(t, point["grid"], eps)[0])

        require_gradients(t, {"grid": d_grid}, forward, {"grid": grid}, np.ones(()), GATE)


@check(
    "09.4.balance",
    task="09.4",
    points=2,
    calls=("tv_loss_adjoint",),
    tolerance=EXACT,
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


# 09.5 ---------------------------------------------------------------------------------------------

EARLIER = ("ray_batch", "mse_and_cotangent", "render_rays", "render_adjoint")


def sign_map(t, grid, views):
    """`gradient_sign_map` of the hand-in."""
    shape = grid.shape[:3]
    signs = t.call("gradient_sign_map", grid, views, returns=Array(shape))
    t.require(bool(np.isin(signs, (-1.0, 0.0, 1.0)).all()), "only -1, 0 and 1 may occur")
    return signs


SHARE = "handout, equation (12): compare with the largest derivative before you take signs"


@check(
    "09.5.differences",
    task="09.5",
    points=3,
    calls=("gradient_sign_map",),
    needs=EARLIER,
    hint="handout, equations (11) and (12): all pixels of all photographs",
    sole="the signs themselves, without the reference",
)
def signs_agree_with_differences(t):
    """More extinction in one voxel alone raises your loss where the map says 1, lowers it at -1."""
    views = random_views(t, 3, 4, 5)
    grid = t.rng.uniform(0.2, 1.0, (3, 2, 3, 4))
    change = np.zeros((3, 2, 3))
    for index in np.ndindex(change.shape):
        for way in (1, -1):
            moved = grid.copy()
            moved[(*index, 3)] += way * 1e-4
            change[index] += way * t.call("adapters.loss_of_views", moved, views, returns=Number())
    clear = np.abs(change) > 1e-3 * np.abs(change).max()
    t.require(bool((change[clear] > 0).any() and (change[clear] < 0).any()), "not telling")
    signs = sign_map(t, grid, views)
    right = np.sign(change)
    t.require(
        not np.array_equal(signs[clear], -right[clear]),
        "all signs are turned round",
        hint="-1 is where descent adds: it goes against the derivative",
    )
    wrong = [tuple(map(int, at)) for at in np.argwhere(clear & (signs != right))]
    told = f"{len(wrong)} of {int(clear.sum())} voxels have the wrong sign"
    if wrong:
        told += f"; at {wrong[0]} yours is {signs[wrong[0]]:g}, expected {right[wrong[0]]:g}"
    t.require(not wrong, told)
    origins, directions, truth = t.call("ray_batch", views, np.arange(60), returns=batch(60))
    seen = t.call(
        "render_rays",
        grid,
        views["low"],
        views["high"],
        origins,
        directions,
        16,
        views["background"],
        returns=Array((60, 3)),
    )
    views["pictures"] = (seen + 1e-6 * (truth - seen)).reshape(3, 4, 5, 3)
    same = np.array_equal(signs, sign_map(t, grid, views))
    t.require(
        same,
        "the signs have changed when all errors became a millionth of what they were",
        hint=SHARE,
    )


@check(
    "09.5.silent",
    task="09.5",
    points=2,
    calls=("gradient_sign_map",),
    needs=EARLIER,
    hint=SHARE,
    sole="where nothing is known",
)
def no_sign_where_nothing_is_known(t):
    """Voxels that no ray passes, and voxels behind a wall, get 0."""
    camera = looking(np.array([0.0, 0.0, 9.0]))
    # In the second case everything should be brighter: no derivative is positive.
    cases = (0.2, (0.9, 0.8, 0.7), 0.3, 0.6), (0.7, (0.3, 0.2, 0.1), 0.9, 1.0)
    for fog, paint, low, high in cases:
        grid = np.full((5, 5, 5, 4), fog)
        grid[..., 3] = 0.2
        grid[:, :, 3] = (*paint, 100.0)  # a wall, with fog before and behind it
        pictures = t.rng.uniform(low, high, (1, 4, 4, 3))
        views = views_of(pictures, camera[None], np.zeros(3), focal=60.0)
        signs = sign_map(t, grid, views)
        t.require(bool((signs[1:4, 1:4, 3:] != 0).any()), "the wall is seen, and has no sign")
        t.require(
            not signs[0].any() and not signs[:, 4].any(), "a voxel that no ray passes has a sign"
        )
        t.require(not signs[:, :, :2].any(), "a voxel that lies hidden behind the wall has a sign")


# 09.6 ---------------------------------------------------------------------------------------------

ALL = (*EARLIER, "tv_loss_adjoint")


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
    task="09.6",
    points=4,
    calls=("fit_volume",),
    needs=ALL,
    tolerance=CHAINED,
    hint="handout, equations (13) to (16), in this order",
    sole="asks about the first two steps alone",
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
    t.close("colours after one step", one[..., :3], kept(free)[..., :3])
    t.close("sigma after one step", one[..., 3], kept(free)[..., 3])
    again, second = stepped(t, views, one)
    two, losses = fitted(t, views, grid, 2)
    m = (0.09 * first + 0.1 * second) / (1 - 0.9**2)
    v = (0.0099 * first**2 + 0.01 * second**2) / (1 - 0.99**2)
    t.close("losses of two steps", losses, np.array([loss, again]))
    t.close("volume after two steps", two, kept(one - RATES * m / (np.sqrt(v) + 1e-8)))


@check(
    "09.6.draws",
    task="09.6",
    points=3,
    calls=("fit_volume",),
    needs=ALL,
    tolerance=CHAINED,
    hint="if 09.6.first fails too, look there first; one draw in each step, all of it used, and "
    "rng for nothing else",
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
    task="09.6",
    points=3,
    calls=("fit_volume",),
    needs=ALL,
    hint="downhill is against the derivative",
    sole="from any start, on any scene: the least that a descent owes",
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
    task="09.6",
    points=1,
    calls=("fit_volume",),
    needs=ALL,
    hint="an array of the start has changed, or is given back: copy it first",
)
def the_start_is_left_alone(t):
    """A second fit from the same array finds what the first one did; without steps a copy comes."""
    views, grid = random_views(t, 1, 2, 2), small_start(t, (2, 2, 2))
    again = fitted(t, views, grid, 2, adapter="fit_again")
    same = agree(again, fitted(t, views, grid, 2))
    t.require(same, "fit_volume has written into the array that it was given, or gives it back")
    t.close("volume after no steps", fitted(t, views, grid, 0)[0], grid, CHAINED)


# >>> hidden
def alike(t, n):
    """Two pictures of n rows."""
    return t.rng.uniform(-0.2, 1.2, (n, 3)), t.rng.uniform(-0.2, 1.2, (n, 3))


def recovering(t, n):
    """What `fit_volume` takes for n steps, with a seed."""
    return random_views(t, 2, 3, 4), t.rng.uniform(0.1, 0.9, (2, 3, 2, 4)), n, 3


# Scenes differ: over fourteen of them the solution reaches 29.3 to 34.6 dB (black has 12), so what
# is asked hangs on what it reaches on the same scene with other draws. Between its own draws lie at
# most 1.2 dB; a fit without total variation loses 3.3 to 5.4 dB, one that forgets Adam's moments
# more.
BELOW = 2.2  # dB


@check(
    "09.1.hidden",
    task="09.1",
    points=1,
    calls=("psnr",),
    visibility="hidden",
    tolerance=EXACT,
    sole="the same mistakes at values that are not known beforehand",
    battery=[Subject("psnr", alike, lambda _: Number(), tolerance=DECIBELS)],
)
def decibels_of_random_pictures(t):
    """Decibels are right for random pictures."""
    for shape in ((6, 5, 3), (40, 3), (2, 3, 4, 3)):
        a, b = t.rng.uniform(-0.5, 1.5, (2, *shape))
        got = t.call("psnr", a, b, returns=Number())
        t.close("decibels", got, t.reference.psnr(a, b), DECIBELS)


@check(
    "09.2.hidden",
    task="09.2",
    points=3,
    calls=("ray_batch",),
    visibility="hidden",
    tolerance=EXACT,
    sole="the same mistakes at cameras that are not known beforehand",
    battery=[
        Subject(
            "ray_batch",
            lambda t, n: (random_views(t), t.rng.permutation(24)[:n]),
            batch,
            rows=(1,),
            has_right=False,
        )
    ],
)
def rays_of_random_cameras(t):
    """Rays and colours are right for random cameras and pixels."""
    for count, rows, columns in ((4, 3, 6), (1, 7, 2), (2, 1, 1)):
        views = random_views(t, count, rows, columns)
        views["world_from_camera"][:, :3, :3] = [turned(t.rng) for _ in range(count)]
        chosen = t.rng.integers(0, count * rows * columns, 11)
        got = t.call("ray_batch", views, chosen, returns=batch(11))
        right = t.reference.ray_batch(views, chosen)
        t.close("origins", got[0], right[0])
        t.close("directions, made unit vectors", unit(got[1]), unit(right[1]))
        t.close("truth", got[2], right[2])


@check(
    "09.3.hidden",
    task="09.3",
    points=2,
    calls=("mse_and_cotangent",),
    visibility="hidden",
    tolerance=EXACT,
    sole="the same mistakes at values that are not known beforehand",
    battery=[Subject("mse_and_cotangent", alike, lambda n: loss_and_slope((n, 3)))],
)
def losses_of_random_batches(t):
    """Loss and derivative are right for random batches."""
    for n in (1, 3, 50):
        pixels, truth = t.rng.uniform(-0.2, 1.2, (2, n, 3))
        got = t.call("mse_and_cotangent", pixels, truth, returns=loss_and_slope((n, 3)))
        right = t.reference.mse_and_cotangent(pixels, truth)
        t.close("loss", got[0], right[0])
        t.close("d_pixels", got[1], right[1])


@check(
    "09.4.hidden",
    task="09.4",
    points=4,
    calls=("tv_loss_adjoint",),
    needs=("psnr",),
    visibility="hidden",
    tolerance=EXACT,
    sole="the same mistakes at volumes that are not known beforehand",
    battery=[
        Subject(
            "tv_loss_adjoint",
            lambda t, n: (t.rng.uniform(0.0, 1.0, (n, 2, 3, 4)), 0.1),
            lambda n: loss_and_slope((n, 2, 3, 4)),
        )
    ],
)
def the_roughness_of_random_volumes(t):
    """Roughness and its derivative are right for random volumes, and cheap."""
    for shape, eps in (((4, 3, 5, 4), 0.1), ((1, 6, 2, 1), 0.01), ((1, 1, 1, 3), 0.5)):
        grid = t.rng.uniform(0.0, 1.0, shape)
        got, right = rough(t, grid, eps), t.reference.tv_loss_adjoint(grid, eps)
        t.close("loss", got[0], right[0])
        t.close("d_grid", got[1], right[1])
    grid, other = t.rng.uniform(0.0, 1.0, (2, 8, 8, 8, 4))
    require_cheap(
        t,
        ("psnr", (grid, other), Number()),
        ("tv_loss_adjoint", (grid, 0.1), loss_and_slope(grid.shape)),
        TV_COST,
    )


@check(
    "09.5.hidden",
    task="09.5",
    points=2,
    calls=("gradient_sign_map",),
    needs=EARLIER,
    visibility="hidden",
    sole="the same mistakes at volumes that are not known beforehand",
    battery=[
        Subject(
            "gradient_sign_map",
            lambda t, n: (t.rng.uniform(0.0, 1.0, (n, 2, 3, 4)), random_views(t)),
            lambda n: Array((n, 2, 3)),
            tolerance=EXACT,
        )
    ],
)
def signs_of_random_volumes(t):
    """The map is right for random volumes and photographs."""
    for count, shape in ((3, (4, 3, 5)), (1, (2, 6, 1))):
        views, grid = random_views(t, count, 5, 4), t.rng.uniform(0.0, 1.0, (*shape, 4))
        wrong = int(np.sum(sign_map(t, grid, views) != t.reference.gradient_sign_map(grid, views)))
        t.require(wrong == 0, f"{wrong} of {grid[..., 3].size} voxels have the wrong sign")


def two_balls(t, n, scale=1.0):
    """A volume (n, n, n, 4) of two balls, bright and striped, their insides opaque."""
    x = (np.stack(np.indices((n, n, n)), axis=-1) + 0.5) / n * 2 - 1
    centre = t.rng.normal(size=3)
    centre *= t.rng.uniform(0.25, 0.4) / np.linalg.norm(centre)
    wave = t.rng.normal(size=3)
    wave *= 9.0 / np.linalg.norm(wave)
    grid = np.full((n, n, n, 4), 0.5)
    grid[..., 3] = 0.0
    for middle, radius in ((centre, 0.45), (-1.3 * centre, 0.3)):
        away = np.linalg.norm(x - scale * middle, axis=-1)
        inside = np.clip((scale * radius - away) * n / 3 + 0.5, 0, 1)
        paint = t.rng.uniform(0.6, 1.0, 3)
        here = inside > grid[..., 3] / 10
        shade = 0.8 + 0.2 * np.sin(x[here] @ wave)
        grid[here, :3] = shade[:, None] * paint
        grid[..., 3] = np.maximum(grid[..., 3], 10 * inside)
    return grid


def photographed(t, grid, count, size, turn=0.0):
    """Views of a volume by the reference's renderer, before a dark background."""
    views = views_of(np.zeros((count, size, size, 3)), around(count, turn=turn), np.zeros(3))
    views["background"] = np.array([0.04, 0.05, 0.08])
    views["pictures"] = rendered(t, grid, views).reshape(count, size, size, 3)
    return views


def rendered(t, grid, views):
    """Pixels (R, 3) of all views of a volume, by the reference."""
    chosen = np.arange(views["pictures"][..., 0].size)
    origins, directions, _ = t.reference.ray_batch(views, chosen)
    box = views["low"], views["high"]
    return t.reference.render_rays(grid, *box, origins, directions, 32, views["background"])


@check(
    "09.5.scene",
    task="09.5",
    points=3,
    calls=("gradient_sign_map",),
    needs=EARLIER,
    visibility="hidden",
    sole="what the handout's pictures claim, on a scene that nobody has seen",
)
def inside_more_and_outside_less(t):
    """From fog, the map is -1 inside what was photographed, 1 where only background is seen."""
    scene = two_balls(t, 12, 0.7)
    views = photographed(t, scene, 6, 10)
    fog = t.reference.fog((12, 12, 12))
    signs = sign_map(t, fog, views)
    chosen = np.arange(views["pictures"][..., 0].size)
    origins, directions, truth = t.reference.ray_batch(views, chosen)
    asked = (views["low"], views["high"], origins, directions, 16, np.zeros(3))
    # A voxel touched by some ray, and by no ray that meets anything.
    meets = np.abs(truth - views["background"]).max(axis=1) > 1e-3
    white = np.ones((12, 12, 12, 4))

    def touched(rays):
        d_pixel = rays[:, None] * np.ones(3)
        return t.reference.render_adjoint(white, *asked, d_pixel)[0][..., 0] > 1e-9

    outside = touched(np.ones(len(meets))) & ~touched(meets.astype(float))
    inside = scene[..., 3] > 5
    t.require(bool(outside.sum() > 20 and inside.sum() > 20), "not telling")
    for name, where, sign in (("inside", inside, -1), ("outside", outside, 1)):
        share = float(np.mean(signs[where] == sign))
        t.require(share > 0.95, f"{name}: {share:.0%} of the voxels have the sign {sign}")


def telling_start(t, views, shape, seed):
    """A start from which the first step leaves the limits of extinction and of colour."""
    for _ in range(50):
        grid = small_start(t, shape)
        one, _ = t.reference.fit_volume(views, grid, 1, np.random.default_rng(seed))
        if (one[..., 3] == 0).any() and np.isin(one[..., :3], (0, 1)).any():
            return grid
    return t.require(False, "not telling")


@check(
    "09.6.hidden",
    task="09.6",
    points=3,
    calls=("fit_volume",),
    needs=ALL,
    visibility="hidden",
    tolerance=CHAINED,
    sole="the same mistakes at scenes that are not known beforehand",
    battery=[
        Subject(
            "adapters.fit",
            recovering,
            lambda n: Items(Array((2, 3, 2, 4)), Array((n,))),
            right=lambda ref, views, grid, n, seed: ref.fit_volume(
                views, grid, n, np.random.default_rng(seed)
            ),
            sizes=(0, 1, 12),
        )
    ],
)
def fits_of_random_scenes(t):
    """Four steps end where they should, with few pixels and with many."""
    for rows, shape in ((3, (2, 3, 2)), (14, (3, 2, 2))):
        views = random_views(t, 2, rows, 12)
        grid = telling_start(t, views, shape, 3)
        got = fitted(t, views, grid, 4, 3)
        right = t.reference.fit_volume(views, grid, 4, np.random.default_rng(3))
        t.close("losses", got[1], right[1])
        t.close("volume", got[0], right[0])


@check(
    "09.6.recovers",
    task="09.6",
    points=6,
    calls=("fit_volume",),
    needs=ALL,
    visibility="hidden",
    seconds=60.0,
    sole="the whole: a scene that nobody has seen, from its photographs",
)
def an_unseen_scene_is_recovered(t):
    """Your fit is run on a new scene, and judged by photographs that it never got."""
    scene = two_balls(t, 20)
    views = photographed(t, scene, 12, 12)
    unseen = photographed(t, scene, 3, 12, turn=1.0)
    fog, seeds = t.reference.fog((20, 20, 20)), t.rng.integers(1 << 30, size=2)
    found, _ = fitted(t, views, fog, 50, int(seeds[0]))
    t.require(bool((found[..., 3] >= 0).all()), "an extinction is negative")
    best, _ = t.reference.fit_volume(views, fog, 50, np.random.default_rng(seeds[1]))
    truth = unseen["pictures"].reshape(-1, 3)
    yours, mine = (t.reference.psnr(rendered(t, each, unseen), truth) for each in (found, best))
    asked = mine - BELOW
    t.require(yours >= asked, f"{yours:.1f} dB on unseen photographs, asked {asked:.1f} dB")


# <<< hidden
