# %% [markdown]
# # A scene from its photographs
# Photographs a scene defined by formulas, shows the gradient at fog, and recovers the scene with
# your functions, next to the C++ core where that is installed. Never graded. `python explore.py`
# takes `--views`, `--pixels`, `--voxels`, `--steps`, `--tv` (the weight of total variation) and
# `--capture DIR`: a folder with `transforms.json` and its images. For a capture, `--box` is the
# extent of the box from the origin. `--figure 0` leaves out Figure 1 of the handout, at the end.

# %%
from photograd_course import explore

given = explore.options(
    views=12,
    pixels=24,
    voxels=explore.at_least(20, 2),
    steps=60,
    tv=explore.at_least(0.01, 0),
    capture=explore.existing(),
    box=explore.at_least(1.0, 1e-6),
    figure=explore.between(1, 0, 1),
)

import importlib
from pathlib import Path

import numpy as np
import volume_recovery as mine
from matplotlib.figure import Figure
from photograd_course.captures import all_around, look_at_origin, read_capture, two_striped_balls
from photograd_course.core_volume import core_volume

count, pixels, voxels = given.views, given.pixels, given.voxels
steps, capture = given.steps, given.capture
explore.set_constants(mine, TV=given.tv)

# %% [markdown]
# ## A scene, and its photographs
# A striped ball and a small one, in a box of 2 m, seen by cameras all around.


# %%
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
    """(volume, losses, time) of a fit from fog."""
    watch, start = explore.Stopwatch(), mine.fog((n, n, n))
    with explore.count_calls("fit", number, mine, "render_adjoint"):
        grid, losses = mine.fit_volume(views, start, number, np.random.default_rng(0))
    return grid, losses, watch.stop()


truth = two_striped_balls(24)
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
found, losses, watch = recover(views, voxels, steps)
own = mine.psnr(shown(found, views), views["pictures"])
new = mine.psnr(shown(found, unseen), unseen["pictures"])
print(
    f"fit:    {steps} steps in {watch}, {own:.1f} dB on the photographs, "
    f"{new:.1f} dB on held-out views"
)

# %% [markdown]
# ## The C++ core
# Its renderer and its adjoint instead of yours. Its steps have equal lengths, where 08 takes equal
# numbers of steps: the derivatives differ as two quadratures do, less with finer steps. They are
# compared with a hundred steps per ray or more.


# %%
FINE = 160


def finely(grid, views):
    """The derivative with respect to extinction with many samples per ray."""
    samples, mine.SAMPLES = mine.SAMPLES, FINE
    slope = gradient(grid, views)[..., 3]
    mine.SAMPLES = samples
    return slope


core, functions = None, explore.by_the_core(core_volume)
if functions is not None:
    kept = mine.render_rays, mine.render_adjoint
    mine.render_rays, mine.render_adjoint = functions
    core_slope = gradient(fog, views)[..., 3]
    core_fine = finely(fog, some(views, slice(0, 2)))
    core, _, core_watch = recover(views, voxels, steps)
    mine.render_rays, mine.render_adjoint = kept
    fine = finely(fog, some(views, slice(0, 2)))
    gap = np.linalg.norm(core_fine - fine) / np.linalg.norm(core_fine)
    score = mine.psnr(shown(core, unseen), unseen["pictures"])
    print(
        f"core:   its derivative is {gap:.2%} from yours at {FINE} steps a ray; "
        f"{score:.1f} dB on held-out views in {core_watch}"
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


large = photographs(truth, 4, 48, 1.0)
above = [(large["pictures"][1], "a held-out view"), (shown(found, large)[1], "your fit")]
below = [
    (slope, "your ∂L/∂σ, from fog"),
    (signs, "your sign map, from fog"),
    (gradient(found, views)[..., 3], "your ∂L/∂σ after the fit"),
]
if core is not None:
    above.append((shown(core, large)[1], "the core's fit"))
    below.append((core_slope, "the core's ∂L/∂σ, from fog"))
figure = Figure(figsize=(13, 6.5), layout="constrained")
panels = figure.subplots(2, len(below))
for axes, (picture, title) in zip(panels[0], above, strict=False):
    light(axes, picture, title)
for axes, (values, title) in zip(panels[1], below, strict=True):
    signed(axes, values, title)
panels[0, -1].semilogy(np.maximum(losses, 1e-12))
panels[0, -1].set(title="your losses", xlabel="step")
explore.keep_picture(figure, "recovery.png")
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
    reach = np.full(3, given.box)
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
    volume, _, watch = recover(train, voxels, steps)
    kept_back, guess = last["pictures"], shown(volume, last)
    print(
        f"capture: {len(train['pictures'])} photographs, {steps} steps in {watch}; "
        f"{mine.psnr(guess, kept_back):.1f} dB on the held-out one"
    )
    figure = Figure(figsize=(13, 3.4), layout="constrained")
    panels = figure.subplots(1, 5)
    light(panels[0], train["pictures"][0], "a photograph")
    light(panels[1], shown(volume, train)[0], "recovered")
    light(panels[2], kept_back[0], "kept back")
    light(panels[3], guess[0], "recovered")
    signed(panels[4], gradient(mine.fog(volume.shape[:3]), train)[..., 3], "derivative, from fog")
    explore.keep_picture(figure, "capture.png")
    print("capture.png: your photographs, the recovered volume, the gradient at fog")

# %% [markdown]
# ## Figure 1 of the handout
# By your functions, with what its caption claims.

# %%
if given.figure:
    explore.figure_1(importlib.import_module("data.figure_1").draw, mine)
