# %% [markdown]
# # A ray, a volume, photographs
# Runs your renderer and its adjoint on a ray, on a small volume, and on photographs of your own,
# next to the C++ core where that is installed. Never graded. `python explore.py` takes `--steps`,
# `--thick` (a factor for extinctions), `--size` (pixels per side) and `--capture DIR`: a folder
# with `transforms.json` and its images. For a capture, `--box` is the extent of the box from the
# origin, `--voxels` its resolution, and `--views` the number of images to use. `--figure 0` leaves
# out Figure 1 of the handout, at the end.

# %%
from photograd_course import explore

given = explore.options(
    steps=48,
    thick=explore.at_least(1.0, 0),
    size=explore.at_least(48, 2),
    capture=explore.existing(),
    box=explore.at_least(1.0, 1e-6),
    voxels=32,
    views=8,
    figure=explore.between(1, 0, 1),
)

import importlib
from pathlib import Path

import numpy as np
import volume_rendering as mine
from matplotlib.figure import Figure
from photograd_course.captures import read_capture
from photograd_course.core_volume import core_volume

steps, thick, size, capture = given.steps, given.thick, given.size, given.capture


# %% [markdown]
# ## A ray
# A dark cloud before a bright one, and a background whose brightness is between both. Where does
# more extinction make the pixel brighter? Finite differences of your own forward pass check your
# derivative.

# %%
ends = np.linspace(0, 6, steps + 1)
middle, width = (ends[1:] + ends[:-1]) / 2, np.diff(ends)[None]
fog = thick * (0.6 * np.exp(-((middle - 1.5) ** 2) * 3) + 2 * np.exp(-((middle - 4.5) ** 2) * 3))
fog, shine = fog[None], np.where(middle < 3, 0.1, 1.2 - 0.1 * middle)[None, :, None]
sky = np.array([0.3])
slope, weights, _ = mine.composite_adjoint(fog, shine, width, sky, np.ones((1, 1)), np.zeros(1))
differences = np.zeros(steps)
for k in range(steps):
    nudge = 1e-5 * np.eye(steps)[k]
    up, down = (mine.composite(fog + way * nudge, shine, width, sky)[0] for way in (1, -1))
    differences[k] = (up - down)[0, 0] / 2e-5
seen, through = mine.composite(fog, shine, width, sky)
length = max(np.linalg.norm(differences), 1e-300)
off = np.linalg.norm(slope[0] - differences) / length
# Rounding error of the pixel, divided by 2e-5: that of each finite difference.
rounding = np.finfo(float).eps * np.sqrt(steps) * abs(seen[0, 0]) / 2e-5 / length
print(f"ray:    pixel {seen[0, 0]:.4f}, T_end {through[0]:.4f}, {steps} steps")
print(f"        your derivative is {off:.1e} from finite differences")
if rounding > 1e-7:
    print(f"        (derivatives are tiny here: rounding error alone is {rounding:.0e})")
figure = Figure(figsize=(9, 7), layout="constrained")
top, center, bottom = figure.subplots(3, 1, sharex=True)
top.stairs(fog[0], ends, color="0.4")
top.set(title="extinction [1/m]: a dark cloud, then a bright one")
center.stairs(weights[0, :, 0], ends, color="tab:blue")
center.set(title="weight of each step")
bottom.axhline(0, color="0.7")
bottom.plot(middle, slope[0], color="black", label="your derivative")
bottom.plot(middle, differences, "o", color="tab:orange", markersize=3, label="finite differences")
bottom.set(title="∂ pixel / ∂ extinction", xlabel="m")
bottom.legend()
explore.keep_picture(figure, "ray.png")


# %% [markdown]
# ## A volume
# An orthographic camera looks along -z through a cube of two meters: parallel rays have the same
# step, which the core requires. The truth is a ball within a ring; the guess has no ring, and an
# extra ball.


# %%
def scene(n, *, guess):
    """A volume of n x n x n voxels."""
    axis = (np.arange(n) + 0.5) / n * 2 - 1
    x, y, z = np.meshgrid(axis, axis, axis, indexing="ij")
    grid = np.zeros((n, n, n, 4))
    grid[..., :3] = (0.9, 0.7, 0.4)
    around = np.hypot(x + 0.15, y + 0.1)
    grid[around**2 + z**2 < 0.09, 3] = 8
    thing = (x - 0.7) ** 2 + (y - 0.7) ** 2 + z**2 < 0.05 if guess else around > 9
    grid[thing | ((not guess) & ((around - 0.6) ** 2 + z**2 < 0.02)), 3] = 6
    grid[..., 3] *= thick
    return grid


truth, guess = scene(24, guess=False), scene(24, guess=True)
low, high = -np.ones(3), np.ones(3)
across = (np.arange(size) + 0.5) / size * 2 - 1
down, right = np.meshgrid(-across, across, indexing="ij")
eyes = np.stack([right.ravel(), down.ravel(), np.full(size**2, 3.0)], axis=1)
looks = np.tile([0.0, 0.0, -1.0], (size**2, 1))
backdrop = np.array([0.1, 0.1, 0.15])
rays = (low, high, eyes, looks, steps, backdrop)
photograph = mine.render_rays(truth, *rays)
both, forward = explore.Stopwatch(), explore.Stopwatch()
picture = mine.render_rays(guess, *rays)
forward.stop()
d_picture = 2 / len(picture) * (picture - photograph)
backward = explore.Stopwatch()
d_guess, _ = mine.render_adjoint(guess, *rays, d_picture)
backward.stop()
both.stop()
loss = np.sum((picture - photograph) ** 2) / len(picture)
print(f"volume: {size} x {size} pixels in {forward}, the adjoint in {backward}")
print(f"        loss {loss:.4f}; one step against the gradient, extinctions clamped to 0, gives:")
for length in (1, 10, 100):
    moved = guess - length * d_guess
    moved[..., 3] = np.maximum(moved[..., 3], 0)
    after = mine.render_rays(moved, *rays)
    print(f"        learning rate {length}: {np.sum((after - photograph) ** 2) / len(after):.4f}")

# %% [markdown]
# ## The C++ core on the same volume


# %%
def of_the_core():
    """(its derivative, the time of its two passes)."""
    _, adjoint = core_volume()
    watch = explore.Stopwatch()
    return adjoint(guess, *rays, d_picture)[0], watch.stop()


core = explore.by_the_core(of_the_core)
if core is not None:
    gap = np.linalg.norm(core[0] - d_guess) / np.linalg.norm(core[0])
    print(
        f"core:   both passes in {core[1]}, {both.times(core[1])} as fast; "
        f"its derivative is {gap:.1e} from yours"
    )


# %%
def signed(axes, values, end, title):
    """An image of values summed along the last axis: blue negative, red positive."""
    axes.imshow(values.sum(axis=2).T[::-1], cmap="RdBu_r", vmin=-end, vmax=end)
    axes.set(title=title, xticks=[], yticks=[])


def shown(axes, values, title):
    """An image of linear radiance."""
    axes.imshow(np.clip(values, 0, 1).reshape(size, size, -1) ** (1 / 2.2))
    axes.set(title=title, xticks=[], yticks=[])


figure = Figure(figsize=(14, 4), layout="constrained")
panels = figure.subplots(1, 3 if core is None else 4)
shown(panels[0], photograph, "photograph")
shown(panels[1], picture, "guess")
end = max(np.abs(d_guess[..., 3].sum(axis=2)).max(), 1e-300)
signed(panels[2], d_guess[..., 3], end, "your ∂L/∂σ")
panels[2].set_xlabel("blue: add, red: remove")
if core is not None:
    signed(panels[3], core[0][..., 3], end, "the core's, on the same scale")
explore.keep_picture(figure, "volume.png")
print("ray.png, volume.png: look at them")


# %% [markdown]
# ## Photographs of your own
# `transforms.json` has the cameras (x to the right, y up, looking along -z: columns of a matrix)
# and a field of view or a focal length in pixels. For a box of thin gray fog, the sign of the
# gradient tells where the photographs need more or less extinction. The background is the mean of
# the border of a photograph.


# %%
if capture:
    reach, n = given.box, given.voxels
    corner = np.full(3, reach)
    gray = np.full((n, n, n, 4), 0.5)
    gray[..., 3] = 0.1 * thick / reach
    total, count = np.zeros(gray.shape), 0
    for photo in read_capture(Path(capture), size, given.views):
        asked = (-corner, corner, *photo.rays(), steps, photo.border.mean(axis=0))
        wrong = mine.render_rays(gray, *asked) - photo.colors.reshape(-1, 3)
        total += mine.render_adjoint(gray, *asked, 2 * wrong / len(wrong))[0]
        count += 1
    titles = ("y to the right, z up", "x to the right, z up", "x to the right, y up")
    figure = Figure(figsize=(10, 4), layout="constrained")
    for axes, axis in zip(figure.subplots(1, 3), range(3), strict=True):
        flat = np.moveaxis(total[..., 3], axis, 2)
        signed(axes, flat, max(np.abs(flat.sum(axis=2)).max(), 1e-300), titles[axis])
    explore.keep_picture(figure, "capture.png")
    print(f"capture.png: gradient of {count} photographs for gray fog; blue: more, red: less")

# %% [markdown]
# ## Figure 1 of the handout
# By your functions, with what its caption claims.

# %%
if given.figure:
    explore.figure_1(importlib.import_module("data.figure_1").draw, mine)
