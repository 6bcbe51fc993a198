# %% [markdown]
# # Recovering a glossy scene
# Photographs a scene defined by formulas, recovers it with your functions, coarse to fine and with
# a fixed grid, and shows your derivative as glyphs. Where the C++ core is installed, its harmonics
# stand beside yours. Never graded. Run it as `python explore.py`; `--views`, `--pixels`,
# `--degree`, `--levels` and `--steps` (in all) change the amount of work, `--coarse` the cells of
# the coarsest level.

# %%
import importlib
import time

import numpy as np
import plenoxels as mine
from matplotlib.figure import Figure
from photograd_course.captures import all_around, rays_to_origin
from photograd_course.explore import option

views, pixels, degree = option("views", 30), option("pixels", 12), option("degree", 2)
levels, steps, coarse = option("levels", 3), option("steps", 36), option("coarse", 4)
cells = coarse * 2 ** (levels - 1)
K = (degree + 1) ** 2

# %% [markdown]
# ## A scene
# Two balls, the larger one red, the smaller one blue, and a light that both reflect.


# %%
def shiny_balls(n):
    """Density (n, n, n) and coefficients (n, n, n, 9, 3)."""
    x = (np.stack(np.indices((n, n, n)), axis=-1) + 0.5) / n * 2 - 1
    light = np.array([0.48, 0.6, 0.64])
    density, c = np.zeros((n, n, n)), np.zeros((n, n, n, 9, 3))
    for center, radius, paint in (
        ((-0.25, 0.0, 0.1), 0.45, (0.8, 0.25, 0.15)),
        ((0.4, 0.2, -0.3), 0.3, (0.15, 0.35, 0.8)),
    ):
        away = x - np.array(center)
        distance = np.linalg.norm(away, axis=-1)
        inside = np.clip((radius - distance) * n / 3 + 0.5, 0, 1)
        normal = away / distance[..., None]
        facing = normal @ light
        mirrored = (2 * facing[..., None] * normal - light).reshape(-1, 3)
        shine = mine.sh_basis(mirrored, 2) * np.repeat([0.5, 0.45, 0.35], [1, 3, 5])
        own = np.repeat(shine.reshape(n, n, n, 9, 1), 3, axis=4)
        own[..., 0, :] += 3.0 * (0.3 + 0.5 * np.maximum(facing, 0))[..., None] * np.array(paint)
        c[inside > density / 8] = own[inside > density / 8]
        density = np.maximum(density, 8 * inside)
    return density, c


def photographs(count, size, turned=0.0):
    """Rays (2, count size^2, 3) of cameras all around the scene."""
    return rays_to_origin(3.2 * all_around(count, turned), size, 0.39)


def seen(volume, rays):
    """Colors of rays through (density, coefficients)."""
    return mine.render(*volume, mine.march(volume[0].shape, rays))


def decibels(a, b):
    return -10 * np.log10(np.mean((a - b) ** 2))


scene = shiny_balls(24)
rays, unseen = photographs(views, pixels), photographs(8, 16, 1.0)
target, truth = seen(scene, rays), seen(scene, unseen)
print(f"scene: two glossy balls, {views} photographs of {pixels} x {pixels}")

# %% [markdown]
# ## Your fit


# %%
def recover(n, count):
    """(density, coefficients) and seconds, from a grid of n^3 through the given levels."""
    start = np.full((n, n, n), 0.1), np.zeros((n, n, n, K, 3))
    before = time.perf_counter()
    found = mine.fit_plenoxels(*start, rays, target, count, max(1, steps // count))
    return found[:2], time.perf_counter() - before


fine, seconds = recover(coarse, levels)
fixed, fixed_seconds = recover(cells, 1)
for name, volume, took in (("coarse to fine", fine, seconds), ("fixed grid", fixed, fixed_seconds)):
    own, new = decibels(seen(volume, rays), target), decibels(seen(volume, unseen), truth)
    print(f"{name}: {took:.1f} s, {own:.1f} dB on the photographs, {new:.1f} dB on held-out views")
    pairs = zip(np.split(seen(volume, unseen), 8), np.split(truth, 8), strict=True)
    print("  each held-out view:", *(f"{decibels(a, b):.1f}" for a, b in pairs), "dB")

# %% [markdown]
# ## The C++ core
# The same harmonics and the same fit, with the core's `sh` instead of your `sh_color` and
# `sh_color_adjoint`.

# %%
vectors = np.random.default_rng(0).normal(size=(20_000, 3))
numbers = np.random.default_rng(1).normal(size=(20_000, K, 3))
g = np.random.default_rng(2).normal(size=(20_000, 3))
before = time.perf_counter()
d_numbers, d_vectors = mine.sh_color_adjoint(numbers, vectors, g)
mine_seconds = time.perf_counter() - before
core_fine = None
try:
    core = importlib.import_module("photograd.sh")
except ImportError:
    print("core not installed")
else:

    def unit(v):
        return v / np.linalg.norm(v, axis=1, keepdims=True)

    def core_color(coefficients, v):
        return core.evaluate(np.ascontiguousarray(coefficients), unit(v))

    def core_adjoint(coefficients, v, g):
        d = unit(v)
        d_c, d_d = core.evaluate_backward(np.ascontiguousarray(coefficients), d, g)
        along = np.sum(d_d * d, axis=1, keepdims=True)
        return d_c, (d_d - along * d) / np.linalg.norm(v, axis=1, keepdims=True)

    before = time.perf_counter()
    core_numbers, core_vectors = core_adjoint(numbers, vectors, g)
    core_seconds = time.perf_counter() - before
    off = max(np.abs(core_numbers - d_numbers).max(), np.abs(core_vectors - d_vectors).max())
    print(f"core: derivatives differ from yours by {off:.1e} at most, ", end="")
    print(f"{mine_seconds / core_seconds:.0f} times as fast")
    yours = mine.sh_color, mine.sh_color_adjoint
    mine.sh_color, mine.sh_color_adjoint = core_color, core_adjoint
    core_fine, _ = recover(coarse, levels)
    mine.sh_color, mine.sh_color_adjoint = yours
    print(
        f"core: {decibels(seen(core_fine, unseen), truth):.1f} dB on held-out views, its harmonics"
    )

# %% [markdown]
# ## Figures
# Glyphs: the change of the brightness of a cell by a step against your derivative, by direction
# within the slice (radii are roots); red brightens, blue darkens. The volume is still gray there.


# %%
def glyphs(axes, volume):
    """Draw the middle slice."""
    density, c = volume
    n = len(density)
    _, _, d_c = mine.loss_and_grad(density, c, mine.march(density.shape, rays), target)
    turn = np.linspace(0, 2 * np.pi, 49)
    ring = np.stack([np.cos(turn), 0 * turn, np.sin(turn)], axis=1)
    change = -d_c[:, n // 2].sum(axis=-1) @ mine.sh_basis(ring, degree).T
    axes.imshow(density[:, n // 2].T, cmap="gray_r", vmin=0, vmax=30, origin="lower")
    size = 0.8 * np.sqrt(np.abs(change) / max(np.abs(change).max(), 1e-30))
    for i, k in np.ndindex(n, n):
        for sign, color in ((1, "#b2182b"), (-1, "#2166ac")):
            r = np.where(sign * change[i, k] > 0, size[i, k], 0)
            axes.fill(i + r * ring[:, 0], k + r * ring[:, 2], color=color, linewidth=0.2)
    axes.set(xticks=[], yticks=[], title="a step: red brightens, blue darkens")


figure = Figure(figsize=(12, 7), layout="constrained")
volume = shiny_balls(12)[0]
glyphs(
    figure.add_subplot(2, 3, 4), (volume, np.full((12, 12, 12, K, 3), 0.3) * np.eye(K)[0][:, None])
)
large = photographs(3, 40, 0.5)[:, 1600:3200]
shown = [("truth", scene), ("coarse to fine", fine), ("fixed grid", fixed)]
if core_fine is not None:
    shown.append(("coarse to fine, core's harmonics", core_fine))
for place, (title, volume) in zip((1, 2, 3, 5), shown, strict=False):
    axes = figure.add_subplot(2, 3, place)
    axes.imshow(np.clip(seen(volume, large), 0, 1).reshape(40, 40, 3) ** (1 / 2.2))
    axes.set(xticks=[], yticks=[], title=title)
axes = figure.add_subplot(2, 3, 6)
density = fine[0]
axes.imshow(density[:, len(density) // 2].T, cmap="viridis", origin="lower")
axes.set(xticks=[], yticks=[], title="density, coarse to fine, middle slice")
figure.savefig("plenoxels.png", dpi=100)
print("plenoxels.png: held-out view, your derivative as glyphs, density")
