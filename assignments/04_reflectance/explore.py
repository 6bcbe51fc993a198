# %% [markdown]
# # Your material
# Renders a chart of your material, its lobe and the derivative with respect to roughness; recovers
# the roughness and the color of a ball from its image. Where the C++ core is installed, it says by
# how much the core's image differs from yours. Never graded. Run it as `python explore.py`;
# `--roughness` and `--metalness` change the ball, `--start` the initial roughness of the fit,
# `--pixels` and `--steps` the amount of work. The metalness is known, unless `--start-metalness`
# says from where the fit starts to look for it. `--figure 0` leaves out Figure 1 of the handout, at
# the end.

# %%
from photograd_course import explore

given = explore.options(
    pixels=explore.at_least(64, 4),
    steps=60,
    roughness=explore.between(0.35, 0.045, 1),
    metalness=explore.between(0.0, 0, 1),
    start=explore.between(0.7, 0.045, 1),
    start_metalness=explore.same_as("metalness", 0.0, 1),
    figure=explore.between(1, 0, 1),
)

import importlib

import numpy as np
import reflectance as mine
from matplotlib.figure import Figure

pixels, steps, rough, start = given.pixels, given.steps, given.roughness, given.start
metal_share, start_metal = given.metalness, given.start_metalness
COLOR = np.array([0.75, 0.3, 0.1])
LIGHTS = (((-0.5, 0.6, 0.62), 1.0), ((0.8, 0.1, 0.35), 0.35))

# %% [markdown]
# ## A ball


# %%
def ball(size):
    """Mask (size, size) of the ball's pixels; for these wo (N, 3), and wi for each light."""
    seen, frame = mine.ball(size)
    lights = [frame @ (np.array(place) / np.linalg.norm(place)) for place, _ in LIGHTS]
    return seen, frame[:, :, 2], lights


def picture(scene, color, m, r, material):
    """Radiance (N, 3) of the pixels of the ball."""
    _, wo, lights = scene
    n = len(wo)
    total = np.zeros((n, 3))
    for wi, (_, strength) in zip(lights, LIGHTS, strict=True):
        f = material(wo, wi, np.tile(color, (n, 1)), np.full(n, m), np.full(n, r))
        total += np.pi * strength * np.maximum(wi[:, 2:], 0) * f
    return total


def pulled(scene, color, m, r, d_picture):
    """Gradient of a loss: color (3,), metalness, roughness, and the last per pixel (N,)."""
    _, wo, lights = scene
    n = len(wo)
    of_color, of_metal, of_rough = np.zeros((n, 3)), np.zeros(n), np.zeros(n)
    for wi, (_, strength) in zip(lights, LIGHTS, strict=True):
        g = np.pi * strength * np.maximum(wi[:, 2:], 0) * d_picture
        parts = mine.gltf_backward(wo, wi, np.tile(color, (n, 1)), np.full(n, m), np.full(n, r), g)
        of_color, of_metal, of_rough = (
            a + b for a, b in zip((of_color, of_metal, of_rough), parts, strict=True)
        )
    return of_color.sum(axis=0), of_metal.sum(), of_rough.sum(), of_rough


scene = ball(pixels)
print(f"ball: {scene[0].sum()} pixels, roughness {rough:g}, metalness {metal_share:g}")

# %% [markdown]
# ## A fit
# Mean squared error against the image; Adam as in assignment 01. Roughness is clamped to 0.045 to
# 1, colors and metalness to 0 to 1. A metalness that starts from the truth is left there.

# %%
target = picture(scene, COLOR, metal_share, rough, mine.gltf)
x = np.array([0.5, 0.5, 0.5, start, start_metal])
first, second = np.zeros(5), np.zeros(5)
trail, progress = [x], explore.Progress("fit", steps)
for k in range(1, steps + 1):
    error = picture(scene, x[:3], x[4], x[3], mine.gltf) - target
    d_color, slope_metal, slope_rough, _ = pulled(scene, x[:3], x[4], x[3], 2 * error / error.size)
    slope = np.array([*d_color, slope_rough, 0 if start_metal == metal_share else slope_metal])
    first, second = 0.9 * first + 0.1 * slope, 0.99 * second + 0.01 * slope**2
    x = x - 0.03 * first / (1 - 0.9**k) / (np.sqrt(second / (1 - 0.99**k)) + 1e-12)
    x = np.clip(x, [0, 0, 0, 0.045, 0], 1)
    trail.append(x)
    progress.step()
trail = np.array(trail)
for name, (*color, r, m) in {"fit": x, "truth": [*COLOR, rough, metal_share]}.items():
    print(f"{name}: roughness {r:.3f}, color {np.round(color, 3)}, metalness {m:.3f}")

# %% [markdown]
# ## The furnace test, and the C++ core

# %%
views = np.array([0.3, 0.6, 1.0])
for r in (0.5, 0.75, 1.0):
    mirrors = mine.furnace(
        lambda wo, wi, r=r: mine.ggx_lobe(wo, wi, np.full(len(wo), r))[:, None], views
    )
    print(
        f"GGX with F = 1, roughness {r:g}: albedo {np.round(mirrors[:, 0], 4)} at cosines {views}"
    )
core = explore.by_the_core(lambda: importlib.import_module("photograd.bsdf").registry()["gltf"])
if core is not None:

    def core_gltf(wo, wi, base_color, metalness, roughness):
        given = {"base_color": base_color, "metalness": metalness, "roughness": roughness}
        return core.f(given, wo, np.ascontiguousarray(wi))

    off = np.abs(picture(scene, COLOR, metal_share, rough, core_gltf) - target).max()
    print(f"core: its image differs from yours by {off:.1e} at most")

# %% [markdown]
# ## Figures


# %%
def screen(values, seen):
    image = np.ones((*seen.shape, 3))
    image[seen] = np.clip(values, 0, 1) ** (1 / 2.2)
    return image


figure = Figure(figsize=(11, 8.2), layout="constrained")
grid = figure.add_gridspec(3, 5)
small = ball(min(pixels, 90))
for row, m in enumerate((0.0, 1.0)):
    for column, r in enumerate((0.15, 0.3, 0.45, 0.65, 1.0)):
        axes = figure.add_subplot(grid[row, column])
        axes.imshow(screen(picture(small, COLOR, m, r, mine.gltf), small[0]))
        axes.set(xticks=[], yticks=[])
        axes.set_title(f"roughness {r:g}" if row == 0 else "", fontsize=9)
        axes.set_ylabel(f"metalness {m:g}" if column == 0 else "")
field = np.full(scene[0].shape, np.nan)
field[scene[0]] = pulled(scene, COLOR, metal_share, rough, np.ones_like(target) / 3)[3]
top = np.nanquantile(np.abs(field), 0.99)
for k, (image, title) in enumerate(
    ((screen(target, scene[0]), "the ball"), (field, "∂ / ∂ roughness"))
):
    axes = figure.add_subplot(grid[2, k])
    axes.imshow(image, cmap="RdBu_r", vmin=-top, vmax=top)
    axes.set(xticks=[], yticks=[], title=title)
axes = figure.add_subplot(grid[2, 2:4])
for k, name in enumerate(("red", "green", "blue")):
    axes.plot(trail[:, k], color=name, linewidth=1, label=name)
    axes.axhline(COLOR[k], color=name, linewidth=0.5, linestyle=":")
axes.plot(trail[:, 3], color="black", label="roughness")
axes.axhline(rough, color="black", linewidth=0.5, linestyle=":")
axes.set(xlabel="step", title="fit; dotted: the truth", ylim=(0, 1.2))
axes.legend(loc="upper right", ncols=4, fontsize=8)
axes = figure.add_subplot(grid[2, 4])
angle = np.radians(np.linspace(-89, 89, 179))
wo = np.stack([np.sin(angle), 0 * angle, np.cos(angle)], axis=1)
wi = np.tile([-np.sqrt(0.5), 0.0, np.sqrt(0.5)], (len(wo), 1))
axes.semilogy(np.degrees(angle), mine.ggx_lobe(wo, wi, np.full(len(wo), rough)))
axes.set(xlabel="viewer, degrees", title="lobe, light from −45°")
explore.keep_picture(figure, "reflectance.png")
print("reflectance.png: chart, derivative with respect to roughness, fit, lobe")

# %% [markdown]
# ## Figure 1 of the handout
# By your functions, with what its caption claims.

# %%
if given.figure:
    explore.figure_1(importlib.import_module("data.figure_1").draw, mine)
