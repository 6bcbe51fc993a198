# %% [markdown]
# # A frame, and the same frame traced
# Renders a small frame with your passes, traces it with your rays and tunes the ambient occlusion
# (`compared.png`); then renders the frame of Figure 1 with what was found (`frame.png`). Never
# graded. `python explore.py` takes `--width` (pixels across) and `--side` (samples of a pixel along
# each axis) of that frame, `--small` (pixels across the compared one), `--angle` (degrees around
# the scene), `--sun` (its elevation, in degrees), `--bias` (texels), `--size` (of the shadow map),
# `--reach` (meters), `--samples` (of the occlusion, in a pixel), `--steps` (of descent) and
# `--exposure` (stops). Where the C++ core is installed, its rasterizer and its tone curve stand
# beside yours.
#
# Do not compare the two times: your rasterizer loops over triangles in Python, and rays run as
# whole arrays in NumPy.

# %%
from photograd_course import explore

given = explore.options(
    width=explore.at_least(528, 16),
    side=2,
    small=explore.at_least(192, 16),
    angle=0.0,
    sun=explore.between(31.3, 0, 90),
    bias=explore.at_least(2.2, 0),
    size=explore.at_least(512, 8),
    reach=explore.at_least(0.8, 1e-6),
    samples=16,
    steps=60,
    exposure=0.2,
)

import importlib

import numpy as np
import real_time_frame as mine
from matplotlib.figure import Figure

final = importlib.import_module("data.frame")
width, height = given.small, given.small * 5 // 8
texels, size, samples, steps = given.bias, given.size, given.samples, given.steps
tones = np.array([given.exposure, 2.5])
explore.set_constants(mine, REACH=given.reach)

# %% [markdown]
# ## Where the camera and the sun are

# %%
turn, lift = np.radians(given.angle), np.radians(given.sun)
eye = np.array([0.3 + 6.4 * np.sin(turn), 1.9, 6.4 * np.cos(turn)])
explore.set_constants(mine, POSE=mine.look_at(eye, (0.3, 0.92, 0.0)))
level = np.array([-0.843, 0.0, 0.538])
to_sun = np.cos(lift) * level / np.linalg.norm(level) + [0, np.sin(lift), 0]
explore.set_constants(mine, LIGHTS={**mine.LIGHTS, "to_sun": to_sun})

# %% [markdown]
# ## Both frames, and descent
# The ground of the first view goes on to the horizon. From other sides it would reach behind the
# camera, where `project` is not defined: with `--angle` a terrace replaces it.

# %%
start = np.array([0.5, 1.0, 1.0])
if given.angle:
    terrace = ((0.0, -0.25, 0.0), (3.8, 0.25, 3.8), 0.0, 0)
    explore.set_constants(mine, BOXES=(terrace, *mine.BOXES[1:]))
drawn = explore.Stopwatch()
frame = mine.render(height, width, start, size=size, samples=samples, texels=texels)
drawn.stop()
traced = explore.Stopwatch()
truth = mine.trace(height, width)
print(f"{width} x {height}: drawn in {drawn}, traced in {traced}")
print("(loops over triangles in Python, rays in whole arrays: compare pictures, not times)")
settings, losses = mine.tune_occlusion(
    frame["depth"], frame["normal"], mine.ZOOM * width, truth["open_sky"], start, steps
)
tuned = mine.render(height, width, settings, size=size, samples=samples, texels=texels)
errors = np.sqrt(losses[[0, -1]])
print(f"occlusion: settings {np.round(settings, 2)}")
print(f"           error {errors[0]:.3f} before, {errors[1]:.3f} after {steps} steps")
pictures = [mine.develop(each["radiance"], tones) for each in (frame, tuned, truth)]
for name, picture in zip(("start", "tuned"), pictures, strict=False):
    off = np.sqrt(np.mean((picture - pictures[2]) ** 2))
    print(f"{name}: {off:.4f} from the traced frame")
faces_sun = truth["normal"] @ (mine.LIGHTS["to_sun"] @ mine.POSE[:, :3]) > 0.1
wrong = np.mean((np.abs(frame["lit"] - truth["lit"]) > 0.5)[faces_sun])
print(f"shadows: {100 * wrong:.1f} % of pixels that face the sun differ by more than one half")

# %% [markdown]
# ## The core's rasterizer and tone curve

# %%
raster = explore.by_the_core(lambda: importlib.import_module("photograd.raster"))
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
    mine_shown = mine.tone_map(gray, tones, 0 * gray)[0]
    shown = core.tone_map(gray, "reinhard", exposure=given.exposure, params={"white": 2.5})
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
explore.keep_picture(figure, "compared.png")

# %% [markdown]
# ## The frame of Figure 1
# Your tuned occlusion, with a quarter of its samples in each of 2 x 2 samples of a pixel.

# %%
across, down, watch = given.width, given.width * 5 // 8, explore.Stopwatch()
few = max(1, samples // given.side**2)
look = {"samples": few, "size": size, "texels": texels}
picture = final.large(mine, down, across, given.side, settings, tones, **look)
print(f"frame: {across} x {down}, {given.side} x {given.side} samples a pixel, {watch}")
figure = Figure(figsize=(across / 100, down / 100))
axes = figure.add_axes((0, 0, 1, 1))
axes.imshow(picture, interpolation="nearest", aspect="auto")
axes.set_axis_off()
explore.keep_picture(figure, "frame.png")
print("wrote frame.png, and compared.png: your small frame beside the traced one")
