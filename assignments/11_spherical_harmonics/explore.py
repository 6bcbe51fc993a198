# %% [markdown]
# # Recovering a glazed teapot
# Photographs a teapot defined by formulas, whose highlight moves with the viewer, and recovers it
# with your functions, coarse to fine and with a fixed grid. Where the C++ core is installed, the
# same fit with its harmonics stands beside yours. Never graded. Run it as `python explore.py`;
# `--views`, `--pixels`, `--degree`, `--levels` and `--steps` (in all) change the amount of work,
# `--coarse` the cells of the coarsest level, `--rate` the learning rate. `--figure 0` leaves out
# Figure 1 of the handout, which takes about a minute.

# %%
from photograd_course import explore

given = explore.options(
    views=30,
    pixels=16,
    degree=explore.between(2, 0, 2),
    levels=3,
    steps=30,
    coarse=explore.at_least(4, 2),
    rate=explore.at_least(0.2, 0),
    figure=explore.between(1, 0, 1),
)

import importlib

import numpy as np
import plenoxels as mine
from matplotlib.figure import Figure

teapot = importlib.import_module("data.teapot")
views, pixels, degree = given.views, given.pixels, given.degree
levels, steps, coarse = given.levels, given.steps, given.coarse
cells, K = coarse * 2 ** (levels - 1), (degree + 1) ** 2
explore.set_constants(mine, RATE=given.rate)


def seen(volume, rays):
    """Colors of rays through (density, coefficients)."""
    return mine.render(*volume, mine.march(volume[0].shape, rays))


def decibels(a, b):
    return -10 * np.log10(np.mean((a - b) ** 2))


(rays, target), (unseen, truth) = teapot.photographs(views, pixels), teapot.photographs(8, 16, 1.0)
print(f"scene: a teapot, {views} photographs of {pixels} x {pixels}")

# %% [markdown]
# ## Your fit


# %%
def recover(n, count):
    """(density, coefficients) and time, from a grid of n^3 through the given levels."""
    start = np.full((n, n, n), 0.1), np.zeros((n, n, n, K, 3))
    start[1][..., 0, :] = 1.8  # gray: black fog before black would change no pixel
    watch, each = explore.Stopwatch(), max(1, steps // count)
    with explore.count_calls(f"{count} levels", count * each, mine, "loss_and_grad"):
        found = mine.fit_plenoxels(*start, rays, target, count, each)
    return found[:2], watch.stop()


fine, watch = recover(coarse, levels)
fixed, fixed_watch = recover(cells, 1)
for name, volume, took in (("coarse to fine", fine, watch), ("fixed grid", fixed, fixed_watch)):
    own, new = decibels(seen(volume, rays), target), decibels(seen(volume, unseen), truth)
    print(f"{name}: {took}, {own:.1f} dB on the photographs, {new:.1f} dB on held-out views")

# %% [markdown]
# ## The C++ core
# The same harmonics and the same fit, with the core's `sh` instead of your `sh_color` and
# `sh_color_adjoint`.

# %%
vectors = np.random.default_rng(0).normal(size=(20_000, 3))
numbers = np.random.default_rng(1).normal(size=(20_000, K, 3))
g = np.random.default_rng(2).normal(size=(20_000, 3))
d_numbers, d_vectors = mine.sh_color_adjoint(numbers, vectors, g)
core_fine = None
core = explore.by_the_core(lambda: importlib.import_module("photograd.sh"))
if core is not None:

    def unit(v):
        return v / np.linalg.norm(v, axis=1, keepdims=True)

    def core_color(coefficients, v):
        return core.evaluate(np.ascontiguousarray(coefficients), unit(v))

    def core_adjoint(coefficients, v, g):
        d = unit(v)
        d_c, d_d = core.evaluate_backward(np.ascontiguousarray(coefficients), d, g)
        along = np.sum(d_d * d, axis=1, keepdims=True)
        return d_c, (d_d - along * d) / np.linalg.norm(v, axis=1, keepdims=True)

    core_numbers, core_vectors = core_adjoint(numbers, vectors, g)
    off = max(np.abs(core_numbers - d_numbers).max(), np.abs(core_vectors - d_vectors).max())
    print(f"core: derivatives differ from yours by {off:.1e} at most")
    yours = mine.sh_color, mine.sh_color_adjoint
    mine.sh_color, mine.sh_color_adjoint = core_color, core_adjoint
    core_fine, _ = recover(coarse, levels)
    mine.sh_color, mine.sh_color_adjoint = yours
    print(
        f"core: {decibels(seen(core_fine, unseen), truth):.1f} dB on held-out views, its harmonics"
    )

# %% [markdown]
# ## Figures

# %%
shown = [("coarse to fine", fine), ("fixed grid", fixed)]
if core_fine is not None:
    shown.append(("coarse to fine, core's harmonics", core_fine))
large, pictures = teapot.photographs(3, 64, 0.7)
rows = [("held out", pictures)] + [(name, seen(volume, large)) for name, volume in shown]
figure = Figure(figsize=(9, 3.1 * len(rows)), layout="constrained")
for panels, (title, colors) in zip(figure.subplots(len(rows), 3), rows, strict=True):
    for axes, picture in zip(panels, np.split(np.clip(colors, 0, 1) ** (1 / 2.2), 3), strict=True):
        axes.imshow(picture.reshape(64, 64, 3))
        axes.set(xticks=[], yticks=[], title=title)
explore.keep_picture(figure, "plenoxels.png")
print("plenoxels.png: held-out views; does the highlight move?")

# %% [markdown]
# ## Figure 1 of the handout
# By your functions, with what its caption claims.

# %%
if given.figure:
    drawn = importlib.import_module("data.figure_1").draw
    explore.figure_1(lambda module: drawn(module, teapot), mine)
