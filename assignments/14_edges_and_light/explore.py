# %% [markdown]
# # Edges, a material, and a caustic of your initials
# Recovers a silhouette, a stroke and the material of a table, and designs a lens that throws two
# letters on a screen: those that a checksum of your own `edges_and_light.py` decides. Never graded.
# `python explore.py` takes `--letters AB`, `--cells` (of the lens, along each axis), `--steps` (at
# each of three resolutions), `--samples` (of edge sampling, in each step), `--depth` (of the fit of
# the material) and `--fit` (its steps). Where the C++ core is installed, your edge sampling is
# compared with its exact derivative. `--figure 0` leaves out Figure 1 of the handout, at the end.

# %%
from photograd_course import explore

given = explore.options(
    letters="",
    cells=64,
    steps=60,
    samples=400,
    depth=explore.at_least(3, 2),
    fit=45,
    figure=explore.between(1, 0, 1),
)

import importlib
import sys
from pathlib import Path

import edges_and_light as mine
import numpy as np
from matplotlib.figure import Figure

own = Path(mine.__file__).read_text(encoding="utf-8")
letters = (given.letters or mine.initials_of(own)).upper()
cells, steps, samples, depth, fit = given.cells, given.steps, given.samples, given.depth, given.fit
if len(letters) != 2 or not (letters.isascii() and letters.isalpha()):
    sys.exit(f"explore.py: --letters: expected two of A to Z, got {letters!r}")

# %% [markdown]
# ## A silhouette and a stroke

# %%
angle = np.arange(80) * 2 * np.pi / 80
radius = 8 + 2.2 * np.sin(2 * angle + 0.6) + 1.1 * np.sin(3 * angle + 2)
outline = 14 + radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
start = 14 + 4.5 * np.stack([np.cos(angle[::4]), np.sin(angle[::4])], axis=1)
picture = mine.polygon_image(outline, 28, 28)
watch = explore.Stopwatch()
with explore.count_calls("silhouette", 90, mine, "edge_sampling_backward"):
    found, _ = mine.recover_polygon(picture, start, 90, 3, samples, 0.3)
shown = mine.polygon_image(found, 28, 28)
union = np.minimum(shown, picture).sum() / np.maximum(shown, picture).sum()
print(f"silhouette: intersection over union {union:.3f}, {watch}")
curve = np.array([[2.5, 4.0], [10.0, -1.0], [12.0, 12.0]])
stroke = mine.stroke_image(curve, 2.2, 15, 15)
fitted, width = mine.recover_stroke(
    stroke, curve - np.array([[1, -1.5], [1, -1], [1, 1]]), 1.5, 120
)
print(f"stroke:     width {width:.4f}, it is 2.2")

# %% [markdown]
# ## The core's exact derivative, where it is installed

# %%
d_image = np.random.default_rng(1).uniform(-1, 1, (28, 28))
name = "photograd.raster.coverage"
exact = explore.by_the_core(
    lambda: importlib.import_module(name).polygon_coverage_backward(start, d_image)
)
if exact is not None:
    u = (np.arange(100 * samples) + 0.5) / (100 * samples)
    got = mine.edge_sampling_backward(start, mine._white, mine._black, d_image[..., None], u)
    off = np.linalg.norm(got - exact) / np.linalg.norm(exact)
    print(f"core:       your edge sampling is {off:.1e} from its exact derivative")

# %% [markdown]
# ## The material of a table, by light of all bounces

# %%
rays = mine.niche_rays(8, 6)
many = [np.repeat(each, 500, axis=0) for each in rays]
photograph = np.mean(
    [mine.path_radiance(mine.demo_niche(), *many, 3, 90 + k) for k in range(6)], axis=0
)
photograph = photograph.reshape(-1, 500, 3).mean(axis=1)
watch, guess = explore.Stopwatch(), mine.demo_niche((0.5, 0.5, 0.5), 0.45)
with explore.count_calls("material", fit, mine, "replay_backward"):
    color, rough, track = mine.recover_material(guess, 0, *rays, photograph, depth, fit, 11)
print(
    f"material:   base color {color.round(3)}, roughness {rough:.3f} with paths of depth {depth}, "
    f"{watch}; it is 0.8, 0.5, 0.2 and 0.35"
)

# %% [markdown]
# ## The caustic

# %%
target = mine.letters_image(letters, 32)
watch = explore.Stopwatch()
with explore.count_calls("caustic", 3 * steps, mine, "landing_backward"):
    heights, losses = mine.design_caustic(target, cells, steps)
light = mine.splat(mine.landing_points(mine.finer(heights, 4)), 96)
coarse = light.reshape(32, 3, 32, 3).mean(axis=(1, 3))
likeness = np.corrcoef(coarse.ravel(), target.ravel())[0, 1]
print(
    f"caustic:    {letters}, correlation {likeness:.3f} with 16 times the rays, height "
    f"{np.ptp(heights):.3f} of the width, {watch}"
)

# %% [markdown]
# ## Figures

# %%
figure = Figure(figsize=(10, 6.5), layout="constrained")
axes = figure.subplots(2, 3)
axes[0, 0].imshow(np.clip(light / 6, 0, 1) ** (1 / 2.2), cmap="gray", vmin=0, vmax=1)
axes[0, 0].set(title=f"light behind the lens: {letters}")
axes[0, 1].imshow(heights, cmap="viridis")
axes[0, 1].set(title="the lens")
axes[0, 2].semilogy(losses)
axes[0, 2].set(title="loss", xlabel="step")
axes[1, 0].imshow(picture, cmap="Greys", vmax=1.6, extent=(0, 28, 28, 0))
axes[1, 0].plot(*np.concatenate([found, found[:1]]).T, "o-", markersize=3)
axes[1, 0].set(title=f"a silhouette, overlap {union:.3f}")
axes[1, 1].imshow(stroke, cmap="Greys", vmax=1.6, extent=(0, 15, 15, 0))
axes[1, 1].plot(*mine.bezier(fitted, np.linspace(0, 1, 60)).T)
axes[1, 1].set(title=f"a stroke, width {width:.3f}")
axes[1, 2].plot(track)
for k, goal in enumerate((0.8, 0.5, 0.2, 0.35)):
    axes[1, 2].axhline(goal, color=f"C{k}", linestyle=":")
axes[1, 2].set(title="base color and roughness", ylim=(0, 1), xlabel="step")
for axis in axes.flat[[0, 1, 3, 4]]:
    axis.set(xticks=[], yticks=[])
explore.keep_picture(figure, "edges_and_light.png", 110)
print("wrote edges_and_light.png")

# %% [markdown]
# ## Figure 1 of the handout
# By your functions, with what its caption claims.

# %%
if given.figure:
    explore.figure_1(importlib.import_module("data.figure_1").draw, mine)
