# %% [markdown]
# # Recovering a photograph
# Measures a picture at scattered places and recovers it with your functions, next to the C++ core
# where that is installed. Never graded. Run it as `python explore.py`, with your own picture as
# `python explore.py --image FILE`; `--size`, `--samples` and `--steps` change the amount of work.

# %%
from __future__ import annotations

import importlib
import sys
import time
from importlib.util import find_spec

import numpy as np
import texture_recovery as mine
from matplotlib.figure import Figure
from PIL import Image


def option(name, default):
    """The value after --name on the command line; the default in a notebook."""
    words = sys.argv[1:]
    return words[words.index(f"--{name}") + 1] if f"--{name}" in words else default


size = int(option("size", 96))
samples_per_texel = float(option("samples", 16))
steps = int(option("steps", 40))


# %% [markdown]
# ## A picture
# Files hold encoded values; light adds up only when they are decoded, so that is done first
# (roughly, by a power of 2.2).


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
    """(picture, where it is from); linear values (H, W, 3)."""
    if file := option("image", ""):
        picture, origin = Image.open(file).convert("RGB"), file
    elif find_spec("skimage") is not None:
        data = importlib.import_module("skimage.data")
        picture, origin = Image.fromarray(data.astronaut()), "the astronaut of scikit-image"
    else:
        return hills(size), "hills drawn by formulas: scikit-image is not installed"
    scale = size / max(picture.size)
    shrunk = picture.resize([max(1, round(scale * side)) for side in picture.size])
    return (np.asarray(shrunk) / 255.0) ** 2.2, origin


truth, origin = photograph()
rng = np.random.default_rng(0)
places = rng.random((int(samples_per_texel * truth.shape[0] * truth.shape[1]), 2))
measured = mine.bilinear_sample(truth, places)
print(f"picture: {origin}, {truth.shape[1]} x {truth.shape[0]}, measured {len(places)} times")

# %% [markdown]
# ## Your functions

# %%
beginning = np.full(truth.shape, 0.5)
before = time.perf_counter()
found, history, unknown = mine.recover_texture(beginning, places, measured, steps)
seconds = time.perf_counter() - before
error = np.mean((found - truth)[~unknown] ** 2)
decibels = -10 * np.log10(error)
print(f"yours: {steps} steps in {seconds:.2f} s, {decibels:.1f} dB, {unknown.sum()} texels unseen")

# %% [markdown]
# ## The C++ core on the same samples

# %%
if find_spec("photograd") is not None and find_spec("photograd.texture") is not None:
    core = importlib.import_module("photograd.texture")
    before = time.perf_counter()
    result = core.recover(places, measured, truth.shape[:2], steps=steps)
    core_seconds = time.perf_counter() - before
    core_error = np.mean((result.texture - truth)[~unknown] ** 2)
    print(
        f"core:  {steps} steps in {core_seconds:.2f} s, {-10 * np.log10(core_error):.1f} dB: "
        f"{seconds / core_seconds:.0f} times as fast"
    )
else:
    print("core not installed")

# %% [markdown]
# ## Pictures
# Look at the gradient of the first step beside what was missing: the adjoint paints the one
# from the other.

# %%
_, slope = mine.loss_and_grad(beginning, places, measured)
missing = (truth - beginning).mean(axis=2)
painted = -slope.mean(axis=2)
painted *= np.abs(missing).max() / np.abs(painted).max()
levels = mine.build_mips(found[: 2 ** int(np.log2(size)) // 2, : 2 ** int(np.log2(size)) // 2])
figure = Figure(figsize=(11, 6), layout="constrained")
shown = [
    ("truth", truth),
    (f"{steps} steps, {decibels:.1f} dB", found),
    ("mip level 2 of a part", levels[min(2, len(levels) - 1)]),
    ("missing at the start", missing),
    ("minus the gradient, scaled alike", painted),
]
for k, (title, values) in enumerate(shown):
    axes = figure.add_subplot(2, 3, k + 1)
    if values.ndim == 3:
        axes.imshow(np.clip(values, 0, 1) ** (1 / 2.2), interpolation="nearest")
    else:
        top = np.abs(missing).max()
        axes.imshow(values, cmap="RdBu_r", vmin=-top, vmax=top, interpolation="nearest")
    axes.set(title=title, xticks=[], yticks=[])
axes = figure.add_subplot(2, 3, 6)
axes.semilogy(history)
axes.set(title="loss", xlabel="step")
figure.savefig("recovered.png", dpi=110)
print("recovered.png: what was found, and the first gradient beside what was missing")
