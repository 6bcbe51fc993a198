# %% [markdown]
# # A scene in a network
# Photographs a scene defined by formulas, trains your network, and shows held-out views and a
# slice of the density. Never graded. `python explore.py` takes `--views`, `--pixels`,
# `--steps`, `--bands` (of points), `--coarse` and `--fine` (distances on each ray), `--width` of
# the hidden layers, and `--capture DIR`: a folder with `transforms.json` and its images. For a
# capture, `--near` and `--far` are the distances between which the scene lies.

# %%
import time
from pathlib import Path

import nerf as mine
import numpy as np
from matplotlib.figure import Figure
from photograd_course.captures import (
    Photograph,
    all_around,
    look_at_origin,
    read_capture,
    striped_balls,
)
from photograd_course.explore import option

count, pixels, steps = option("views", 30), option("pixels", 24), option("steps", 600)
mine.BANDS = option("bands", mine.BANDS)
mine.COARSE, mine.FINE = option("coarse", mine.COARSE), option("fine", mine.FINE)
width, capture = option("width", 64), option("capture", "")
BACKGROUND = np.array([0.9, 0.93, 1.0])


def views_of(photos, near, far, background):
    """Views of all pixels of some photographs."""
    origins, directions = (
        np.concatenate(each) for each in zip(*[photo.rays() for photo in photos], strict=True)
    )
    return {
        "origins": origins,
        "directions": directions / np.linalg.norm(directions, axis=1, keepdims=True),
        "colors": np.concatenate([photo.colors.reshape(-1, 3) for photo in photos]),
        "background": background,
        "near": near,
        "far": far,
    }


def photographs(number, size, turn=0.0):
    """Views of the scene by formulas."""
    dark, poses = (
        np.zeros((size, size, 3)),
        map(look_at_origin, 3.0 * all_around(number, turn, up=1)),
    )
    views = views_of([Photograph(dark, pose, 1.4 * size) for pose in poses], 1.8, 4.2, BACKGROUND)
    rays = (views[name].reshape(number, -1, 3) for name in ("origins", "directions"))
    seen = [striped_balls(places[0], d, BACKGROUND) for places, d in zip(*rays, strict=True)]
    return {**views, "colors": np.concatenate(seen)}


def decibels(a, b):
    return -10 * np.log10(np.mean((a - b) ** 2))


# %% [markdown]
# ## Your training

# %%
views, unseen = photographs(count, pixels), photographs(3, pixels, 1.0)
print(f"scene: {count} photographs of {pixels} x {pixels}")


def recover(views):
    """(network, losses) of a training from the start."""
    rng = np.random.default_rng(0)
    before = time.perf_counter()
    network, losses = mine.train_nerf(views, mine.make_network(width, 16, rng), steps, rng)
    numbers = sum(array.size for layers in network.values() for array in layers)
    print(f"fit:   {numbers} numbers, {steps} steps in {time.perf_counter() - before:.1f} s")
    return network, losses


network, losses = recover(views)
some = mine.take(views, slice(0, 3 * pixels**2))
own = decibels(mine.render(network, some), some["colors"])
new = decibels(mine.render(network, unseen), unseen["colors"])
print(f"       {own:.1f} dB on photographs of training, {new:.1f} dB on held-out views")

# %% [markdown]
# ## Figures


# %%
def light(axes, picture, title):
    """An image of linear radiance."""
    axes.imshow(np.clip(picture, 0, 1) ** (1 / 2.2))
    axes.set(title=title, xticks=[], yticks=[])


def slice_of_density(z, size=64):
    """Opacity of 1/16 m of the density in the plane of height z, from above."""
    a = np.linspace(-1, 1, size)
    x, y = np.meshgrid(a, a)
    p = np.stack([x.ravel(), np.full(x.size, z), y.ravel()], axis=1)
    sigma = mine.radiance_field(network, p, np.tile([0.0, -1.0, 0.0], (len(p), 1)))[0]
    return (1 - np.exp(-sigma / 16)).reshape(size, size)


large = photographs(3, 64, 1.0)
got = mine.render(network, large).reshape(3, 64, 64, 3)
figure = Figure(figsize=(13, 6.2), layout="constrained")
panels = figure.subplots(2, 4)
for k in range(3):
    light(panels[0, k], large["colors"].reshape(3, 64, 64, 3)[k], "held out")
    light(panels[1, k], got[k], "your network")
panels[0, 3].semilogy(np.maximum(losses, 1e-12))
panels[0, 3].set(title="your losses", xlabel="step")
panels[1, 3].imshow(slice_of_density(0.0), cmap="gray_r", vmin=0, vmax=1)
panels[1, 3].set(title="density at height 0", xticks=[], yticks=[])
figure.savefig("nerf.png", dpi=100)
print("nerf.png: held-out views, losses, a slice of the density")

# %% [markdown]
# ## Photographs of your own
# `transforms.json` has the cameras (x to the right, y up, looking along -z: columns of a matrix)
# and a field of view or a focal length in pixels. The scene should fit into the box from -1 to 1.
# The background is the mean of the borders of the images. The last photograph is held out.

# %%
if capture:
    photos = list(read_capture(Path(capture), max(pixels, 16), max(2, count)))
    border = np.concatenate([photo.border for photo in photos]).mean(axis=0)
    around = option("near", 1.8), option("far", 4.2), border
    network, _ = recover(views_of(photos[:-1], *around))
    last, truth = views_of(photos[-1:], *around), photos[-1].colors
    guess = mine.render(network, last)
    print(f"capture: {decibels(guess, last['colors']):.1f} dB on the held-out photograph")
    figure = Figure(figsize=(7, 3.4), layout="constrained")
    panels = figure.subplots(1, 2)
    light(panels[0], truth, "held out")
    light(panels[1], guess.reshape(truth.shape), "your network")
    figure.savefig("capture.png", dpi=100)
    print("capture.png: the held-out photograph, and your network")
