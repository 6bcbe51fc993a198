# %% [markdown]
# # A frame, and the same frame traced
# Renders the scene with your passes, traces it with your rays, tunes the ambient occlusion, and
# writes `frame.png`. Never graded. `python explore.py` takes `--width` (pixels across), `--angle`
# (degrees around the scene), `--sun` (its elevation, in degrees), `--bias` (texels), `--size` (of
# the shadow map), `--reach` (meters), `--samples` (of the occlusion), `--steps` (of descent) and
# `--exposure` (stops). Where the C++ core is installed, its rasterizer and its tone curve stand
# beside yours.
#
# Do not compare the two times: your rasterizer loops over triangles in Python, and rays run as
# whole arrays in NumPy.

# %%
import importlib
import time

import numpy as np
import real_time_frame as mine
from matplotlib.figure import Figure
from photograd_course.explore import by_the_core, option

width, angle, elevation = option("width", 192), option("angle", 0.0), option("sun", 31.3)
texels, size, samples = option("bias", 2.2), option("size", 512), option("samples", 16)
steps, exposure = option("steps", 60), option("exposure", 0.2)
mine.REACH = option("reach", mine.REACH)
height = width * 5 // 8

# %% [markdown]
# ## Where the camera and the sun are

# %%
turn, lift = np.radians(angle), np.radians(elevation)
eye = np.array([0.3 + 6.4 * np.sin(turn), 1.9, 6.4 * np.cos(turn)])
mine.POSE = mine.look_at(eye, (0.3, 0.92, 0.0))
level = np.array([-0.843, 0.0, 0.538])
mine.LIGHTS["to_sun"] = np.cos(lift) * level / np.linalg.norm(level) + [0, np.sin(lift), 0]

# %% [markdown]
# ## Both frames, and descent
# The ground of the first view goes on to the horizon. From other sides it would reach behind the
# camera, where `project` is not defined: with `--angle` a terrace replaces it.

# %%
start = np.array([0.5, 1.0, 1.0])
if angle:
    mine.BOXES = (((0.0, -0.25, 0.0), (3.8, 0.25, 3.8), 0.0, 0), *mine.BOXES[1:])
before = time.perf_counter()
frame = mine.render(height, width, start, size=size, samples=samples, texels=texels)
drawn = time.perf_counter() - before
before = time.perf_counter()
truth = mine.trace(height, width)
print(f"{width} x {height}: drawn in {drawn:.1f} s, traced in {time.perf_counter() - before:.1f} s")
print("(loops over triangles in Python, rays in whole arrays: compare pictures, not times)")
settings, losses = mine.tune_occlusion(
    frame["depth"], frame["normal"], mine.ZOOM * width, truth["open_sky"], start, steps
)
tuned = mine.render(height, width, settings, size=size, samples=samples, texels=texels)
errors = np.sqrt(losses[[0, -1]])
print(f"occlusion: settings {np.round(settings, 2)}")
print(f"           error {errors[0]:.3f} before, {errors[1]:.3f} after {steps} steps")
pictures = [mine.develop(each["radiance"], (exposure, 2.5)) for each in (frame, tuned, truth)]
for name, picture in zip(("start", "tuned"), pictures, strict=False):
    off = np.sqrt(np.mean((picture - pictures[2]) ** 2))
    print(f"{name}: {off:.4f} from the traced frame")
faces_sun = truth["normal"] @ (mine.LIGHTS["to_sun"] @ mine.POSE[:, :3]) > 0.1
wrong = np.mean((np.abs(frame["lit"] - truth["lit"]) > 0.5)[faces_sun])
print(f"shadows: {100 * wrong:.1f} % of pixels that face the sun differ by more than one half")

# %% [markdown]
# ## The core's rasterizer and tone curve

# %%
raster = by_the_core(lambda: importlib.import_module("photograd.raster"))
if raster is not None:
    core = importlib.import_module("photograd.frame")
    corners = mine.joined(mine.meshes(10))[0].reshape(-1, 3)
    flat = mine.project(corners, mine.ZOOM * width, mine.POSE, height, width)
    flat[:, :2] = np.round(256 * flat[:, :2]) / 256
    face, _, depth = mine.rasterize(flat.reshape(-1, 3, 3), height, width)
    homogeneous = np.concatenate([flat[:, :2] * flat[:, 2:], flat[:, 2:]], axis=1)
    order = np.arange(len(flat)).reshape(-1, 3)
    seen = raster.rasterize(homogeneous, order.astype(np.uint32), (height, width))
    alike, both = np.mean(seen.face == face), (seen.face == face) & (face >= 0)
    off = np.abs(seen.depth[both] / depth[both] - 1).max()
    print(f"core: {100 * alike:.2f} % of pixels see the same triangle, depths differ by {off:.1e}")
    gray = np.linspace(0, 8, 50)[None, :, None] * np.ones(3)
    mine_shown = mine.tone_map(gray, np.array([exposure, 2.5]), 0 * gray)[0]
    shown = core.tone_map(gray, "reinhard", exposure=exposure, params={"white": 2.5})
    print(f"core: grays are shown alike to {np.abs(shown - mine_shown).max():.1e}")

# %% [markdown]
# ## Figures

# %%
figure = Figure(figsize=(12, 8), layout="constrained")
panels = figure.subplots(3, 3)
skies = (frame["open_sky"], tuned["open_sky"], truth["open_sky"])
rows = (
    ("yours, start", pictures[0], skies[0]),
    ("yours, tuned", pictures[1], skies[1]),
    ("traced", pictures[2], skies[2]),
)
for k, (title, picture, sky) in enumerate(rows):
    panels[0, k].imshow(picture)
    panels[0, k].set(title=title)
    panels[1, k].imshow(np.clip(sky, 0, 1), cmap="gray", vmin=0, vmax=1)
    panels[1, k].set(title="open sky")
panels[2, 0].imshow(frame["lit"], cmap="gray", vmin=0, vmax=1)
panels[2, 0].set(title="sun, by your shadow map")
panels[2, 1].imshow(truth["lit"], cmap="gray", vmin=0, vmax=1)
panels[2, 1].set(title="sun, traced")
panels[2, 2].imshow(np.clip(0.5 + 2 * (pictures[1] - pictures[2]), 0, 1))
panels[2, 2].set(title="tuned minus traced")
for each in panels.flat:
    each.set(xticks=[], yticks=[])
figure.savefig("frame.png", dpi=100)
print("wrote frame.png")
