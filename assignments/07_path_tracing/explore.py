# %% [markdown]
# # A room with all bounces, and a material recovered from an image
# Renders a room with your path tracer, and a table with your direct light, your gradient, and the
# result of `recover`. Beside them stand the results of the C++ core; where the core is installed
# they are computed anew. Never graded. `python explore.py` takes `--size` (pixels across),
# `--depth`, `--samples` (per pixel, of the room), `--steps` (of the fit) and `--roughness` (of the
# table; the stored results are for 0.35, and with another value your own image is fitted).
# `--figure 0` leaves out Figure 1 of the handout, at the end.

# %%
from photograd_course import explore

given = explore.options(
    size=48,
    depth=5,
    samples=16,
    steps=45,
    roughness=explore.between(0.35, 0.045, 1),
    figure=explore.between(1, 0, 1),
)

import importlib

import numpy as np
import path_tracing as mine
from matplotlib.figure import Figure
from photograd_course.core_light import core_light

size, depth, samples = given.size, given.depth, given.samples
steps, roughness = given.steps, given.roughness
rng = np.random.default_rng(0)

# %% [markdown]
# ## The room

# %%
width, height = size, size * 5 // 6
room = mine.demo_room()
origins, directions = mine.camera_rays(width, height, [0, 1, 3.4], [0, 1, 0], 38)
watch, progress = explore.Stopwatch(), explore.Progress("room", samples)
total, squares = np.zeros((height * width, 3)), np.zeros((height * width, 3))
for _ in range(samples):
    seen = mine.trace_paths(room, origins, directions, depth, rng)
    total += seen
    squares += seen**2
    progress.step()
picture = total / samples
# The variance of the samples of a pixel estimates the noise of their mean; it takes two samples.
spread = (squares - samples * picture**2).mean() / max(samples - 1, 1)
noise = np.sqrt(max(spread, 0) / samples) / max(picture.mean(), 1e-9)
said = f"noise {noise:.0%}" if samples > 1 else "noise unknown (take 2 samples or more)"
print(
    f"room:  depth {depth}, {samples} samples a pixel, mean {picture.mean():.3f}, {said}, {watch}"
)

# %% [markdown]
# ## The table
# Direct light alone, many samples, and the derivative of each pixel with respect to roughness.

# %%
rays, truth = mine.table_rays(), mine.demo_table(roughness=roughness)
hit = mine.closest_hit(truth, *rays)
on = hit["primitive"] == 0
many, each = mine.repeated(mine.take(hit, on), mine.SIDE**2), mine.SIDE**2
table = np.zeros((70, 3))
for _ in range(16):
    u = mine.strata(rng, on.sum()), mine.strata(rng, on.sum())
    table[on] += mine.direct_light(truth, many, *u).reshape(-1, each, 3).mean(axis=1) / 16
slope = mine.by_roughness(truth, 0, *rays, rng, side=24)
theirs, their_slope, found = mine.core_answers()

# %% [markdown]
# ## The C++ core, where it is installed


# %%
def apart(a, b):
    """Relative difference by norm."""
    return float(np.linalg.norm(a - b) / np.linalg.norm(b))


target, whose = table, "your own"
core, like_stored = explore.by_the_core(lambda: core_light(truth, *rays, on)), roughness == 0.35
if core is not None:
    target, whose, their_slope = core[0], "the core's", core[1].reshape(7, 10)
    told = (
        f", {apart(target, theirs.reshape(70, 3)):.1%} from its stored image" if like_stored else ""
    )
    print(f"core:  computed anew{told}")
elif like_stored:
    target, whose = theirs.reshape(70, 3), "the core's"
    print("core:  its stored results are shown")
else:
    print("core:  its stored results are for 0.35: not compared")
if whose == "the core's":
    print(
        f"table: your image is {apart(table, target):.1%} from the core's, your gradient "
        f"{apart(slope, their_slope.ravel()):.1%}"
    )

# %% [markdown]
# ## The recovered material
# From gray and roughness 0.6, to the image of the core, or to yours where the core has none.

# %%
start = mine.demo_table((0.5, 0.5, 0.5), 0.6)
watch = explore.Stopwatch()
with explore.count_calls("fit", steps, mine, "direct_light_backward"):
    color, rough, track = mine.recover(start, 0, *rays, target, steps, rng)
goal = np.array([0.8, 0.5, 0.2, roughness])
told = f"; the core found {found[:3].round(3)}, {found[3]:.3f}" if like_stored else ""
print(
    f"fit:   to {whose} image, base color {color.round(3)}, roughness {rough:.3f} in {steps} "
    f"steps, {watch}{told}; it is 0.8, 0.5, 0.2 and {roughness:g}"
)

# %% [markdown]
# ## Figures

# %%
figure = Figure(figsize=(10, 6), layout="constrained")
compared = whose == "the core's"
axes = figure.subplots(2, 3 if compared else 2)
images = [(picture.reshape(height, width, 3), f"room, depth {depth}")]
images.append((table.reshape(7, 10, 3) / 2, "table, yours"))
slopes = [(slope.reshape(7, 10), "∂ / ∂ roughness, yours")]
if compared:
    images.append((target.reshape(7, 10, 3) / 2, "table, the core's"))
    slopes.append((their_slope, "∂ / ∂ roughness, the core's"))
for axis, (shown, title) in zip(axes[0], images, strict=True):
    axis.imshow(np.clip(shown, 0, 1) ** (1 / 2.2))
    axis.set(title=title, xticks=[], yticks=[])
for axis, (shown, title) in zip(axes[1, 1:], slopes, strict=True):
    axis.imshow(shown, cmap="RdBu_r", vmin=-3, vmax=3)
    axis.set(title=title, xticks=[], yticks=[])
axes[1, 0].plot(track)
for k in range(4):
    axes[1, 0].axhline(goal[k], color=f"C{k}", linestyle=":")
axes[1, 0].set(title="fit; dotted: the truth", ylim=(0, 1), xlabel="step")
explore.keep_picture(figure, "traced.png", 110)
print("wrote traced.png")

# %% [markdown]
# ## Figure 1 of the handout
# By your functions, with what its caption claims.

# %%
if given.figure:
    explore.figure_1(importlib.import_module("data.figure_1").draw, mine)
