# %% [markdown]
# # Recovering a photograph
# Measures an image at random points and recovers it with your functions, next to the C++ core where
# that is installed. Never graded. Run it as `python explore.py`, with your own image as `python
# explore.py --image FILE`; `--size`, `--samples` (per texel) and `--steps` change the amount of
# work. `--fine 4` measures an image with four times as many rows and columns as the recovered
# texture: its edges then lie inside texels. `--figure 0` leaves out Figure 1 of the handout, at the
# end.

# %%
from photograd_course import explore

given = explore.options(
    image=explore.existing(),
    size=explore.at_least(96, 2),
    samples=explore.at_least(16.0, 0.1),
    steps=40,
    fine=1,
    figure=explore.between(1, 0, 1),
)

import importlib
import sys
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import texture_recovery as mine
from matplotlib.figure import Figure
from PIL import Image

size, samples_per_texel, steps, fine = given.size, given.samples, given.steps, given.fine


# %% [markdown]
# ## An image
# Files store gamma-encoded values; only linear values may be averaged, so they are decoded first
# (approximately, by a power of 2.2).


# %%
def hills(n):
    """Two hills under a sun, by formulas, for when there is no photograph."""
    v, u = np.mgrid[0:n, 0:n] / n
    picture = np.stack([0.5 * v + 0.1, 0.4 - 0.1 * v, 0.6 - 0.4 * v], axis=2)
    picture[np.hypot(u - 0.3, v - 0.25) < 0.07] = (1.0, 0.9, 0.6)
    for base, wave in ((0.5, 9.0), (0.68, 14.0)):
        hill = v > base + 0.08 * np.sin(wave * u + wave) + 0.02 * np.sin(5 * wave * u)
        picture[hill] = np.array([0.08, 0.16, 0.10]) * (1.6 - base) ** 2
    return picture


def photograph():
    """(image, its origin); linear values (H, W, 3)."""
    if file := given.image:
        picture, origin = Image.open(file, formats=("PNG", "JPEG")).convert("RGB"), file
    elif find_spec("skimage") is not None:
        data = importlib.import_module("skimage.data")
        picture, origin = Image.fromarray(data.astronaut()), "the astronaut of scikit-image"
    else:
        return hills(size * fine), "hills drawn by formulas: scikit-image is not installed"
    scale = size / max(picture.size)
    shrunk = picture.resize([fine * max(1, round(scale * side)) for side in picture.size])
    return (np.asarray(shrunk) / 255.0) ** 2.2, origin


wall, origin = photograph()
rows, columns = (side // fine for side in wall.shape[:2])
truth = wall.reshape(rows, fine, columns, fine, 3).mean(axis=(1, 3))  # one mean for each texel
rng = np.random.default_rng(0)
places = rng.random((int(samples_per_texel * rows * columns), 2))
measured = mine.bilinear_sample(wall, places)
print(f"image: {origin}, {truth.shape[1]} x {truth.shape[0]}, measured {len(places)} times")

# %% [markdown]
# ## Your functions

# %%
beginning = np.full(truth.shape, 0.5)
watch = explore.Stopwatch()
found, history, unknown = mine.recover_texture(beginning, places, measured, steps)
watch.stop()
error = np.mean((found - truth)[~unknown] ** 2)
decibels = -10 * np.log10(error)
print(f"yours: {steps} steps in {watch}, {decibels:.1f} dB, {unknown.sum()} texels unseen")
print(f"loss:  {history[0]:.3g} at the start, {history[-1]:.3g} at the end")

# %% [markdown]
# ## Your engine of assignment 02 checks your adjoint
# Your own `bilinear_sample`, on `Value`s: NumPy adds and multiplies objects, too. The loss is the
# sum of g times the samples, so the gradient of a texel is what the adjoint returns.

# %%
sys.path += map(str, Path("..").glob("02*"))
try:
    engine = importlib.import_module("engine")
    leaves = [engine.Value(number) for number in rng.random(24)]
    grid, spots = np.array(leaves).reshape(4, 6, 1), rng.random((60, 2))
    g = rng.normal(size=(60, 1))
    graph_watch = explore.Stopwatch()
    engine.backward(np.sum(g * mine.bilinear_sample(grid, spots)))
    graph_watch.stop()
    by_graph = np.array([leaf.grad for leaf in leaves])
    hand_watch = explore.Stopwatch()
    by_hand = mine.bilinear_sample_adjoint((4, 6), spots, g).ravel()
    slower = graph_watch.times(hand_watch.stop())
    off = np.abs(by_graph - by_hand).max()
    print(f"02:    its gradient is {off:.1e} from your adjoint, {slower} as slow")
except (ImportError, NotImplementedError):
    print("02:    no finished engine.py here or in the folder of assignment 02")
except TypeError:
    print("02:    your bilinear_sample puts samples into an array of floats, which takes no Values")

# %% [markdown]
# ## The smallest eigenvalue
# Half the largest stable learning rate shrinks each component, those of small eigenvalues least.
# The Rayleigh quotient of the remainder is an estimate, from above, of the smallest eigenvalue. One
# channel is enough.

# %%
left = np.where(unknown[:, :, None], 0.0, found - truth)
slow, nothing = left[:, :, :1], np.zeros((len(places), 1))
if slow.any() and rows * columns > 1:
    largest = mine.largest_curvature(truth.shape[:2], places, 40)
    for _ in range(40):
        slow = slow - mine.loss_and_grad(slow, places, nothing)[1] / largest
        slow = slow / np.linalg.norm(slow)
    smallest = np.sum(slow * mine.loss_and_grad(slow, places, nothing)[1])
    print(f"slow:  the smallest eigenvalue is 1/{largest / smallest:.0f} of the largest, or less;")
    print(f"       a step leaves {1 - 0.95 * 2 * smallest / largest:.3f} of its component")

# %% [markdown]
# ## The C++ core on the same samples

# %%
core = explore.by_the_core(lambda: importlib.import_module("photograd.textures"))
if core is not None:
    core_watch = explore.Stopwatch()
    result = core.recover(places, measured, truth.shape[:2], steps=steps)
    core_watch.stop()
    core_error = np.mean((result.texture - truth)[~unknown] ** 2)
    print(
        f"core:  {steps} steps in {core_watch}, {-10 * np.log10(core_error):.1f} dB: "
        f"{watch.times(core_watch)} as fast"
    )

# %% [markdown]
# ## Figures
# Compare the gradient of the first step with the error: the adjoint scatters the residuals. In the
# last image it scatters the squared residual of each sample to its texels.

# %%
_, slope = mine.loss_and_grad(beginning, places, measured)
missing = (truth - beginning).mean(axis=2)
painted = -slope.mean(axis=2)
painted *= np.abs(missing).max() / np.abs(painted).max()
rest = mine.bilinear_sample(found, places) - measured
shares = mine.bilinear_sample_adjoint(truth.shape[:2], places, np.ones((len(places), 1)))
squares = mine.bilinear_sample_adjoint(truth.shape[:2], places, rest**2).mean(axis=2)
residual = np.sqrt(squares / np.where(unknown, 1, shares[:, :, 0]))
tall, wide = (2 ** int(np.log2(side)) for side in truth.shape[:2])  # a pyramid wants powers of two
levels = mine.build_mips(found[:tall, :wide])
level = min(2, len(levels) - 1)
figure = Figure(figsize=(14, 6.5), layout="constrained")
shown = [
    ("truth", truth, None),
    (f"{steps} steps, {decibels:.1f} dB", found, None),
    (f"mip level {level} of its upper left", levels[level], None),
    ("missing at the start", missing, np.abs(missing).max()),
    ("minus the gradient, scaled alike", painted, np.abs(missing).max()),
    ("missing at the end", -left.mean(axis=2), np.abs(left).max()),
    ("residual, root of the mean square", residual, residual.max()),
]
for k, (title, values, top) in enumerate(shown):
    axes = figure.add_subplot(2, 4, k + 1)
    if top is None:
        axes.imshow(np.clip(values, 0, 1) ** (1 / 2.2), interpolation="nearest")
    else:
        end = max(float(top), 1e-12)
        image = axes.imshow(values, cmap="RdBu_r", vmin=-end, vmax=end, interpolation="nearest")
        figure.colorbar(image, ax=axes, ticks=[-end, 0, end], format="%.2g", shrink=0.7)
    axes.set(title=title, xticks=[], yticks=[])
axes = figure.add_subplot(2, 4, 8)
axes.semilogy(history)
axes.set(title="loss", xlabel="step")
explore.keep_picture(figure, "recovered.png", 110)
print("recovered.png: the texture, the first gradient beside the error, the residual")

# %% [markdown]
# ## Figure 1 of the handout
# By your functions, with what its caption claims.

# %%
if given.figure:
    explore.figure_1(importlib.import_module("data.figure_1").draw, mine)
