# %% [markdown]
# # A scene in a network
# Photographs the scene of Figure 1, trains your network, and shows held-out views, the normals of
# its density, and a slice of it. Never graded. `python explore.py` takes `--views`, `--pixels`,
# `--steps`, `--bands` (of points), `--coarse` and `--fine` (distances on each ray), `--rays` (of
# a step), `--width` of the hidden layers, `--shown` (pixels of the views in the picture), and
# `--capture DIR`: a folder with `transforms.json` and its images. For a capture, `--near` and
# `--far` are the distances between which the scene lies.

# %%
from photograd_course import explore

given = explore.options(
    views=40,
    pixels=40,
    steps=2500,
    bands=explore.at_least(4, 0),
    coarse=explore.at_least(16, 2),
    fine=explore.at_least(16, 0),
    rays=32,
    width=64,
    shown=explore.at_least(110, 2),
    capture=explore.existing(),
    near=explore.at_least(1.8, 0),
    far=explore.at_least(4.2, 0),
)

import importlib
from pathlib import Path

import nerf as mine
import numpy as np
from matplotlib.figure import Figure
from photograd_course.captures import read_capture

scene = importlib.import_module("data.scene")
explore.set_constants(
    mine, BANDS=given.bands, COARSE=given.coarse, FINE=given.fine, RAYS=given.rays
)
steps, pixels, shown = given.steps, given.pixels, given.shown

# %% [markdown]
# ## Your training

# %%
views, unseen = scene.both_views(given.views, pixels)
print(f"scene: {given.views} photographs of {pixels} x {pixels}")


def recover(views):
    """(networks after some steps and at the end, losses) of a training from the start."""
    watch, marks = explore.Stopwatch(), [k for k in scene.MARKS if k < steps] + [steps]
    with explore.count_calls("fit", steps, mine, "loss_and_grad"):
        networks, losses = scene.trained(mine, views, given.width, marks)
    numbers = sum(array.size for layers in networks[-1].values() for array in layers)
    print(f"fit:   {numbers} numbers, {steps} steps in {watch}")
    return dict(zip(marks, networks, strict=True)), losses


networks, losses = recover(views)
network = networks[steps]
some = mine.take(views, slice(0, 3 * pixels**2))
scores = {
    k: scene.decibels(mine.render(each, unseen), unseen["colors"]) for k, each in networks.items()
}
own = scene.decibels(mine.render(network, some), some["colors"])
print(f"       {own:.1f} dB on photographs of training, {scores[steps]:.1f} dB on held-out views")

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


large = scene.photographs(scene.places(3, turn=1.7)[[2, 0]], shown)
small = scene.photographs(scene.places(3, turn=1.7)[2:], shown // 2)
normals, opacity = scene.normals(mine, network, large)
shade = 1 - opacity[:, None] + opacity[:, None] * (0.5 + 0.5 * normals)
square = (2, shown, shown, 3)
rows = [each.reshape(square) for each in (large["colors"], mine.render(network, large), shade)]
figure = Figure(figsize=(13, 10.5), layout="constrained")
grid = figure.add_gridspec(3, 20, height_ratios=(5, 5, 3.4))
for row in range(2):
    light(figure.add_subplot(grid[row, :5]), rows[0][row], "held-out photograph")
    light(figure.add_subplot(grid[row, 5:10]), rows[1][row], "your network")
    axes = figure.add_subplot(grid[row, 10:15])
    axes.imshow(np.clip(rows[2][row], 0, 1))
    axes.set(title="normals of its density", xticks=[], yticks=[])
axes = figure.add_subplot(grid[0, 15:])
axes.semilogy(np.maximum(losses, 1e-12))
axes.set(title="your losses", xlabel="step")
axes = figure.add_subplot(grid[1, 15:])
axes.imshow(slice_of_density(-0.2), cmap="gray_r", vmin=0, vmax=1)
axes.set(title="density at height -0.2", xticks=[], yticks=[])
for k, (mark, each) in enumerate([*networks.items()][-5:]):
    axes = figure.add_subplot(grid[2, 4 * k : 4 * k + 4])
    view = mine.render(each, small).reshape(shown // 2, shown // 2, 3)
    light(axes, view, f"{mark} steps: {scores[mark]:.1f} dB")
explore.keep_picture(figure, "nerf.png")
print("nerf.png: held-out views, normals, losses, a slice of the density, the training")

# %% [markdown]
# ## Photographs of your own
# `transforms.json` has the cameras (x to the right, y up, looking along -z: columns of a matrix)
# and a field of view or a focal length in pixels. The scene should fit into the box from -1 to 1.
# The background is the mean of the borders of the images. The last photograph is held out.

# %%
if given.capture:
    photos = list(read_capture(Path(given.capture), max(pixels, 16), max(2, given.views)))
    border = np.concatenate([photo.border for photo in photos]).mean(axis=0)
    around = {"background": border, "near": given.near, "far": given.far}
    network = recover(scene.views_of(photos[:-1], **around))[0][steps]
    last, truth = scene.views_of(photos[-1:], **around), photos[-1].colors
    guess = mine.render(network, last)
    score = scene.decibels(guess, last["colors"])
    print(f"capture: {score:.1f} dB on the held-out photograph")
    figure = Figure(figsize=(7, 3.4), layout="constrained")
    panels = figure.subplots(1, 2)
    light(panels[0], truth, "held out")
    light(panels[1], guess.reshape(truth.shape), "your network")
    explore.keep_picture(figure, "capture.png")
    print("capture.png: the held-out photograph, and your network")
