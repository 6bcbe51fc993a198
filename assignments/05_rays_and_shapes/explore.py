# %% [markdown]
# # Rays and their closest hits
# Renders three images with your functions: a ring of triangles and the cost of each pixel; a ball
# of glass over a floor; a sphere-traced ball and its derivative with respect to the radius. Where
# the C++ core is installed, Embree's results stand beside yours. Never graded. `python explore.py`
# takes `--triangles` (of the ring), `--size` (pixels across), `--eta` (of the glass) and `--rays`
# (to compare with the core). `--figure 0` leaves out Figure 1 of the handout, at the end.

# %%
from photograd_course import explore

given = explore.options(
    triangles=256,
    size=explore.at_least(64, 4),
    eta=explore.between(1.5, 0.1, 10),
    rays=2000,
    figure=explore.between(1, 0, 1),
)

import importlib

import numpy as np
import rays as mine
from matplotlib.figure import Figure

triangles, size, eta, count = given.triangles, given.size, given.eta, given.rays

# %% [markdown]
# ## A camera
# It is above the scene and looks down a little: its own y points down, its z forward.

# %%
width, height = size, size * 5 // 8
pose = np.array([[1, 0, 0, 0], [0, -0.8, -0.6, 3.3], [0, 0.6, -0.8, 4.4]])
focal = 0.6 * width
origins, ways = mine.camera_rays(width, height, focal, focal, width / 2, height / 2, pose)

# %% [markdown]
# ## A ring of triangles
# Two counters: tests of boxes and tests of triangles.


# %%
def look(corners, origins, ways):
    """(t, triangle, tested boxes, tested triangles), each (R,), of rays."""
    boxes, first, many, order = mine.build_bvh(corners.min(axis=1), corners.max(axis=1))
    t, number = np.zeros(len(origins)), np.zeros(len(origins), int)
    cost = np.zeros((2, len(origins)), int)
    progress = explore.Progress("rays", len(origins))
    for r, (o, d) in enumerate(zip(origins, ways, strict=True)):

        def box(node, r=r):
            cost[0, r] += 1
            return boxes[node]

        def intersect(primitives, r=r, o=o, d=d):
            cost[1, r] += len(primitives)
            return mine.hit_triangle(o, d, corners[primitives])[0]

        t[r], number[r] = mine.traverse(first, many, order, box, intersect, o, d)
        progress.step()
    return t, number, *cost


turns = max(4, round(triangles**0.5 / 2) * 2)
corners = mine.ring(turns, max(3, triangles // (2 * turns)))
watch = explore.Stopwatch()
t, number, asked, met = look(corners, origins, ways)
print(
    f"{len(corners)} triangles, {len(ways)} pixels: {asked.mean():.1f} boxes and "
    f"{met.mean():.1f} triangles for each, {watch}"
)
a, b, c = np.moveaxis(corners, 1, 0)
normals = np.cross(b - a, c - a)
normals /= np.linalg.norm(normals, axis=1, keepdims=True)
towards = -np.sum(normals[number] * ways, axis=1)
seen = np.where(number >= 0, 0.15 + 0.85 * np.abs(towards), 1.0)

# %% [markdown]
# ## A ball of glass over a floor
# A ray enters and leaves, after any number of internal reflections, and then hits the floor or the
# sky. Reflection outside is left out. This camera is horizontal: the horizon is behind the ball.


# %%
center, radius = np.array([0.0, 0.3, 0.0]), 1.2
level = np.array([[1, 0, 0, 0], [0, -1, 0, 0.3], [0, 0, -1, 3.6]])
place, way = mine.camera_rays(width, height, focal, focal, width / 2, height / 2, level)
inside = np.zeros(len(way), bool)
for bounce in range(8):
    t_ball = mine.hit_sphere(place, way, center, radius)
    on = np.isfinite(t_ball) & (inside | (bounce == 0))
    place[on] += t_ball[on, None] * way[on]
    way[on], through = mine.refract(way[on], (place[on] - center) / radius, eta)
    inside[on] ^= through
glass = mine.floor_and_sky(place, way)
print(f"glass with eta {eta}: {inside.sum()} rays are still inside")

# %% [markdown]
# ## Sphere tracing and its derivative
# A smooth union of two balls; the derivative of t is with respect to the radius of the left one.


# %%
def melted(radius=1.0, blend=0.5):
    """The distance to two balls, blended smoothly; p is the radius of the first."""

    def shape(x):
        parts = [x - np.array(each) for each in ((-0.7, 0.0, 0.0), (0.9, 0.3, 0.2))]
        away = [np.linalg.norm(part, axis=1) for part in parts]
        one, two = away[0] - radius, away[1] - 0.8
        share = np.clip(0.5 + 0.5 * (two - one) / blend, 0, 1)
        value = share * one + (1 - share) * two - blend * share * (1 - share)
        slopes = [part / far[:, None] for part, far in zip(parts, away, strict=True)]
        # The derivative with respect to the share is zero wherever it is not clipped.
        return value, share[:, None] * slopes[0] + (1 - share)[:, None] * slopes[1], -share

    return shape


t_march, d_t = mine.march_sdf(melted(), origins, ways, 20.0, 500)
eps = 1e-4
more, less = (mine.march_sdf(melted(1 + e), origins, ways, 20.0, 500)[0] for e in (eps, -eps))
kept = np.isfinite(t_march) & np.isfinite(more) & np.isfinite(less) & (np.abs(d_t) < 5)
apart = (more[kept] - less[kept]) / (2 * eps)
worst = np.abs(apart - d_t[kept]).max() if kept.any() else np.inf
print(f"sphere tracing: your derivative is {worst:.1e} from finite differences of your t")

# %% [markdown]
# ## Embree, by the C++ core
# Random rays through the ring. Rays within 1e-7 of an edge may hit in one and miss in the other:
# the core's triangles are in float32.

# %%
rng = np.random.default_rng(7)
meshes = explore.by_the_core(lambda: importlib.import_module("photograd.geometry.mesh"))
if meshes is not None:
    faces = np.arange(3 * len(corners)).reshape(-1, 3)
    tree = meshes.Bvh(meshes.Mesh(corners.reshape(-1, 3).astype(np.float32), faces))
    start = rng.normal(size=(count, 3)) * 2.5
    to = rng.normal(size=(count, 3)) * [1.5, 0.4, 1.5] - start
    hits = tree.trace(start, to)
    its = tree.surface_points(start, to, hits).t
    t_mine, number_mine, _, _ = look(corners, start, to)
    near = np.isfinite(its) & np.isfinite(t_mine)
    differ = int((np.isfinite(its) != np.isfinite(t_mine)).sum())
    off = np.abs(t_mine[near] / its[near] - 1).max()
    print(
        f"core: {near.sum()} of {count} rays hit the ring, {differ} in one of the two only, "
        f"t is {off:.1e} from yours"
    )

# %% [markdown]
# ## Figures

# %%
figure = Figure(figsize=(9, 6), layout="constrained")
axes = figure.subplots(2, 2)
shape = (height, width)
axes[0, 0].imshow(seen.reshape(shape), cmap="gray", vmin=0, vmax=1)
axes[0, 0].set(title=f"{len(corners)} triangles")
drawn = axes[0, 1].imshow(asked.reshape(shape), vmin=0)
figure.colorbar(drawn, ax=axes[0, 1], label="tested boxes", shrink=0.8)
axes[1, 0].imshow(np.clip(glass, 0, 1).reshape(*shape, 3))
axes[1, 0].set(title=f"glass, eta = {eta}")
drawn = axes[1, 1].imshow(d_t.reshape(shape), cmap="RdBu", vmin=-4, vmax=4)
figure.colorbar(drawn, ax=axes[1, 1], label="∂t / ∂ left radius", shrink=0.8)
for each in axes.flat:
    each.set(xticks=[], yticks=[])
explore.keep_picture(figure, "seen.png", 110)
print("wrote seen.png")

# %% [markdown]
# ## Figure 1 of the handout
# By your functions, with what its caption claims.

# %%
if given.figure:
    explore.figure_1(importlib.import_module("data.figure_1").draw, mine)
