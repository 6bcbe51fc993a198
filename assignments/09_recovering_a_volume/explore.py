# %% [markdown]
# # A scene from its photographs
# Photographs a scene defined by formulas, shows the gradient at fog, and recovers the scene with
# your functions, next to the C++ core where that is installed. Never graded. `python explore.py`
# takes `--views`, `--pixels`, `--voxels`, `--steps`, `--tv` (the weight of total variation) and
# `--capture DIR`: a folder with `transforms.json` and its images. For a capture, `--box` is the
# extent of the box from the origin.

# %%
import importlib
import time
from pathlib import Path

import numpy as np
import volume_recovery as mine
from matplotlib.figure import Figure
from photograd_course.captures import all_around, look_at_origin, read_capture
from photograd_course.explore import option

count, pixels, voxels = option("views", 12), option("pixels", 24), option("voxels", 20)
steps, capture = option("steps", 60), option("capture", "")
mine.TV = option("tv", mine.TV)

# %% [markdown]
# ## A scene, and its photographs
# A striped ball and a small one, in a box of 2 m, seen by cameras all around.


# %%
def scene(n):
    """A volume of n x n x n voxels."""
    places = (np.stack(np.indices((n, n, n)), axis=-1) + 0.5) / n * 2 - 1
    grid = np.full((n, n, n, 4), 0.5)
    grid[..., 3] = 0.0
    for middle, size, paint in (
        ((-0.25, 0.0, 0.1), 0.45, (0.95, 0.55, 0.4)),
        ((0.4, 0.25, -0.25), 0.3, (0.5, 0.75, 0.95)),
    ):
        away = np.linalg.norm(places - np.array(middle), axis=-1)
        solid = np.clip((size - away) * n / 3 + 0.5, 0, 1)
        own = solid > grid[..., 3] / 10
        stripes = 0.75 + 0.25 * np.sin(places[own] @ np.array([6.0, 8.0, 3.0]))
        grid[own, :3] = stripes[:, None] * paint
        grid[..., 3] = np.maximum(grid[..., 3], 10 * solid)
    return grid


def photographs(grid, number, size, turn=0.0):
    """Views of a volume by your own renderer."""
    places = 3.2 * all_around(number, turn, up=1)
    views = {
        "pictures": np.zeros((number, size, size, 3)),
        "focal": 1.25 * size,
        "world_from_camera": np.stack([look_at_origin(place) for place in places]),
        "low": np.full(3, -1.0),
        "high": np.full(3, 1.0),
        "background": np.array([0.04, 0.05, 0.08]),
    }
    views["pictures"] = shown(grid, views)
    return views


def shown(grid, views, samples=32):
    """All images of a volume."""
    shape = views["pictures"].shape
    origins, directions, _ = mine.ray_batch(views, np.arange(int(np.prod(shape[:3]))))
    box = views["low"], views["high"]
    seen = mine.render_rays(grid, *box, origins, directions, samples, views["background"])
    return seen.reshape(shape)


def gradient(grid, views):
    """Gradient of the loss of all photographs with respect to a volume."""
    everything = np.arange(views["pictures"][..., 0].size)
    origins, directions, truth = mine.ray_batch(views, everything)
    asked = (views["low"], views["high"], origins, directions, mine.SAMPLES, views["background"])
    _, cotangent = mine.mse_and_cotangent(mine.render_rays(grid, *asked), truth)
    return mine.render_adjoint(grid, *asked, cotangent)[0]


def some(views, which):
    """Some of the views."""
    names = ("pictures", "world_from_camera")
    return {**views, **{name: views[name][which] for name in names}}


def recover(views, n, number):
    """(volume, losses, seconds) of a fit from fog."""
    before = time.perf_counter()
    start = mine.fog((n, n, n))
    grid, losses = mine.fit_volume(views, start, number, np.random.default_rng(0))
    return grid, losses, time.perf_counter() - before


truth = scene(24)
views, unseen = photographs(truth, count, pixels), photographs(truth, 4, pixels, 1.0)
fog = mine.fog((voxels,) * 3)
print(f"scene:  {count} photographs of {pixels} x {pixels}, a volume of {voxels}^3")
print(
    f"        fog has {mine.psnr(shown(fog, unseen), unseen['pictures']):.1f} dB on held-out views"
)

# %% [markdown]
# ## Your signs, your fit

# %%
slope, signs = gradient(fog, views)[..., 3], mine.gradient_sign_map(fog, views)
print(f"signs:  {np.mean(signs < 0):.0%} of all voxels negative, {np.mean(signs > 0):.0%} positive")
found, losses, seconds = recover(views, voxels, steps)
own = mine.psnr(shown(found, views), views["pictures"])
new = mine.psnr(shown(found, unseen), unseen["pictures"])
print(
    f"fit:    {steps} steps in {seconds:.1f} s, {own:.1f} dB on the photographs, "
    f"{new:.1f} dB on held-out views"
)

# %% [markdown]
# ## The C++ core
# Its renderer and its adjoint instead of yours. Its steps have equal lengths, where 08 takes equal
# numbers of steps: the derivatives differ as two quadratures do, less with finer steps. They are
# compared with a hundred steps per ray or more.


# %%
def of_the_core():
    """(render_rays, render_adjoint) by the core."""
    grids = importlib.import_module("photograd.fields.dense_grid")
    marches = importlib.import_module("photograd.fields.march")
    base = importlib.import_module("photograd.representation")

    def asked(grid, low, high, origins, directions, n):
        policy = marches.MarchPolicy(
            box=(tuple(low), tuple(high)),
            dt=float(np.max(high - low)) / n,
            lattice="entry",
            density_activation="identity",
            color_activation="identity",
        )
        aims = directions / np.linalg.norm(directions, axis=1, keepdims=True)
        numbers = np.arange(len(origins), dtype=np.uint32)
        batch = base.RayBatch(np.ascontiguousarray(origins), aims, numbers)
        field = grids.DenseGrid(grid.copy(), policy)
        return field, *field.render(batch, options=base.RenderOptions(), seed=0, step=0), base

    def render(grid, low, high, origins, directions, n, background):
        _, out, _, _ = asked(grid, low, high, origins, directions, n)
        opacity = np.asarray(out.opacity).reshape(-1, 1)
        return np.asarray(out.color) + (1 - opacity) * background

    def adjoint(grid, low, high, origins, directions, n, background, d_pixel):
        field, out, context, base = asked(grid, low, high, origins, directions, n)
        back = base.Outputs(d_pixel, -(d_pixel @ background), None)
        d_grid = np.asarray(field.render_backward(context, back)["values"])
        opacity = np.asarray(out.opacity).reshape(-1, 1)
        return d_grid.reshape(grid.shape), np.sum((1 - opacity) * d_pixel, axis=0)

    render(fog, views["low"], views["high"], np.zeros((1, 3)), np.ones((1, 3)), 4, np.zeros(3))
    return render, adjoint


FINE = 160


def finely(grid, views):
    """The derivative with respect to extinction with many samples per ray."""
    samples, mine.SAMPLES = mine.SAMPLES, FINE
    slope = gradient(grid, views)[..., 3]
    mine.SAMPLES = samples
    return slope


core = None
try:
    functions = of_the_core()
except (ImportError, AttributeError, TypeError):  # none, or another than this was written for
    print("core not installed")
else:
    kept = mine.render_rays, mine.render_adjoint
    mine.render_rays, mine.render_adjoint = functions
    core_slope = gradient(fog, views)[..., 3]
    core_fine = finely(fog, some(views, slice(0, 2)))
    core, _, core_seconds = recover(views, voxels, steps)
    mine.render_rays, mine.render_adjoint = kept
    fine = finely(fog, some(views, slice(0, 2)))
    gap = np.linalg.norm(core_fine - fine) / np.linalg.norm(core_fine)
    score = mine.psnr(shown(core, unseen), unseen["pictures"])
    print(
        f"core:   its derivative is {gap:.2%} from yours at {FINE} steps a ray; "
        f"{score:.1f} dB on held-out views in {core_seconds:.1f} s"
    )


# %% [markdown]
# ## Figures


# %%
def signed(axes, values, title):
    """The middle slice of a volume: blue negative (add), red positive (remove); roots."""
    flat = values[:, :, values.shape[2] // 2].T
    root = np.sign(flat) * np.sqrt(np.abs(flat) / max(np.abs(flat).max(), 1e-300))
    axes.imshow(root, cmap="RdBu_r", vmin=-1, vmax=1, origin="lower")
    axes.set(title=title, xticks=[], yticks=[])


def light(axes, picture, title):
    """An image of linear radiance."""
    axes.imshow(np.clip(picture, 0, 1) ** (1 / 2.2))
    axes.set(title=title, xticks=[], yticks=[])


def absent(axes):
    axes.text(0.5, 0.5, "core not installed", ha="center")
    axes.set_axis_off()


figure = Figure(figsize=(13, 6.5), layout="constrained")
panels = figure.subplots(2, 4)
large = photographs(truth, 4, 48, 1.0)
light(panels[0, 0], large["pictures"][1], "a new view: the truth")
light(panels[0, 1], shown(found, large)[1], "your fit")
if core is None:
    absent(panels[0, 2])
    absent(panels[1, 1])
else:
    light(panels[0, 2], shown(core, large)[1], "with the core's renderer")
    signed(panels[1, 1], core_slope, "the core's")
panels[0, 3].semilogy(np.maximum(losses, 1e-12))
panels[0, 3].set(title="your losses", xlabel="step")
signed(panels[1, 0], slope, "your derivative by σ, from fog")
signed(panels[1, 2], signs, "your sign map, from fog")
signed(panels[1, 3], gradient(found, views)[..., 3], "your derivative after the fit")
figure.savefig("recovery.png", dpi=100)
print("recovery.png: a held-out view, your derivative, the recovered volume")


# %% [markdown]
# ## Photographs of your own
# `transforms.json` has the cameras (x to the right, y up, looking along -z: columns of a matrix)
# and a field of view or a focal length in pixels. The background is the mean of the borders of the
# images. The last photograph is held out.


# %%
def taken(folder, size):
    """Views of a capture, its pictures made small."""
    photos = list(read_capture(folder, size, max(2, count)))
    reach = np.full(3, option("box", 1.0))
    return {
        "pictures": np.stack([photo.colors for photo in photos]),
        "world_from_camera": np.stack([photo.world_from_camera for photo in photos]),
        "focal": photos[0].focal,
        "low": -reach,
        "high": reach,
        "background": np.concatenate([photo.border for photo in photos]).mean(axis=0),
    }


if capture:
    photos = taken(Path(capture), max(pixels, 16))
    train, last = some(photos, slice(0, -1)), some(photos, slice(-1, None))
    volume, _, seconds = recover(train, voxels, steps)
    kept_back, guess = last["pictures"], shown(volume, last)
    print(
        f"capture: {len(train['pictures'])} photographs, {steps} steps in {seconds:.1f} s; "
        f"{mine.psnr(guess, kept_back):.1f} dB on the held-out one"
    )
    figure = Figure(figsize=(13, 3.4), layout="constrained")
    panels = figure.subplots(1, 5)
    light(panels[0], train["pictures"][0], "a photograph")
    light(panels[1], shown(volume, train)[0], "recovered")
    light(panels[2], kept_back[0], "kept back")
    light(panels[3], guess[0], "recovered")
    signed(panels[4], gradient(mine.fog(volume.shape[:3]), train)[..., 3], "derivative, from fog")
    figure.savefig("capture.png", dpi=100)
    print("capture.png: your photographs, the recovered volume, the gradient at fog")
