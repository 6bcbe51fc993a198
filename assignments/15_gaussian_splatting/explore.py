# %% [markdown]
# # Photographs become Gaussians
# Fits Gaussians to a capture with your functions: fourteen photographs of bananas in `data/`, or
# your own. Two photographs are held out. Where the C++ core is installed, it renders in your place
# and is compared with you first, so that more pixels and more Gaussians are possible. Never graded.
# `python explore.py` takes `--capture DIR` (a folder with `transforms.json` and its images),
# `--pixels` (width of the photographs), `--steps`, `--max-count` (Gaussians), `--start` (Gaussians
# at the beginning), `--every` (steps between two changes of their number), `--seed`, `--frames` (of
# the turntable) and, for a capture without `points.npy`, `--box` (extent of the scene from the
# origin).

# %%
from importlib.util import find_spec

from photograd_course import explore

has_core = find_spec("photograd") is not None  # it renders more pixels and more Gaussians
given = explore.options(
    capture=explore.existing(),
    pixels=400 if has_core else 120,
    steps=1500 if has_core else 500,
    max_count=12000 if has_core else 1200,
    start=explore.at_least(4000 if has_core else 500, 4),
    every=100 if has_core else 50,
    seed=explore.at_least(0, 0),
    frames=72,
    box=explore.at_least(1.0, 1e-6),
)

import importlib
from pathlib import Path

import numpy as np
import splatting as mine
from matplotlib.figure import Figure
from photograd_course.captures import look_at_origin, read_capture
from PIL import Image

HARMONIC = 0.28209479177387814  # the constant spherical harmonic


def of_the_core():
    """(`picture` by the core, its writer of videos), or None if it is not installed."""
    try:
        splat = importlib.import_module("photograd.splats.splatting")
        lenses = importlib.import_module("photograd.capture.camera")
        video = importlib.import_module("photograd.images.video")
    except ImportError:
        return None

    def drawn(scene, camera, background):
        pose = np.eye(4)
        pose[:3] = camera["camera_from_world"]
        (fx, fy), (cx, cy) = camera["focal"].tolist(), camera["center"].tolist()
        size = {"width": camera["width"], "height": camera["height"]}
        where = np.linalg.inv(pose)
        lens = lenses.Camera(world_from_camera=where, **size, fx=fx, fy=fy, cx=cx, cy=cy)
        same = {key: scene[key] for key in ("means", "log_scales", "quats", "opacity_logits")}
        own = splat.Gaussians(**same, sh=((scene["colors"] - 0.5) / HARMONIC)[:, None])
        options = splat.SplatOptions(stop=0.0)
        shown, context = splat.render(own, lens, background=background, options=options)

        def back(d_shown):
            got = splat.render_backward(context, np.ascontiguousarray(d_shown))
            return {
                **{key: got.gaussians[key] for key in same},
                "colors": got.gaussians["sh"][:, 0] / HARMONIC,
                "absgrad": np.abs(got.screen),
                "background": got.background,
            }

        return np.asarray(shown.color), back

    return drawn, video.write_video


core = of_the_core() if has_core else None
folder = Path(given.capture or "data")
start_points = folder / "points.npy"
width, steps, most, begin = given.pixels, given.steps, given.max_count, given.start
every, seed, count = given.every, given.seed, given.frames

# %% [markdown]
# ## The capture


# %%
def camera_of(pose, focal, wide, tall):
    """A camera as `splatting.py` has it; `pose` is world from camera."""
    return {
        "camera_from_world": np.linalg.inv(pose)[:3],
        "focal": np.full(2, focal),
        "center": np.array([wide / 2, tall / 2]),
        "width": wide,
        "height": tall,
    }


def centered(poses):
    """Poses moved and scaled: the cameras look at the origin, 3.2 m away on average."""
    eyes, ahead = poses[:, :3, 3], poses[:, :3, 2]
    across = np.eye(3) - ahead[:, :, None] * ahead[:, None]
    aim = np.linalg.solve(across.sum(axis=0), np.einsum("nij,nj->i", across, eyes))
    poses = poses.copy()
    poses[:, :3, 3] = 3.2 * (eyes - aim) / np.linalg.norm(eyes - aim, axis=1).mean()
    return poses


def taken():
    """(camera, photograph) of each view; colors as a display shows them, not linear."""
    photos = list(read_capture(folder, width, 1000))
    poses = np.stack([photo.world_from_camera for photo in photos])
    poses = poses if start_points.exists() else centered(poses)
    views = []
    for photo, pose in zip(photos, poses, strict=True):
        tall, wide = photo.colors.shape[:2]
        views.append((camera_of(pose, photo.focal, wide, tall), photo.colors ** (1 / 2.2)))
    return views


def cloud(rng):
    """The initial scene: a small ball at each of some points of the capture, or anywhere."""
    if start_points.exists():
        points = np.load(start_points).astype(np.float64)
        points = points[rng.permutation(len(points))[:begin]]
    else:
        places = given.box * rng.uniform(-1, 1, (begin, 3))
        points = np.concatenate([places, np.full((begin, 3), 0.5)], axis=1)
    means = points[:, :3]
    near = [np.sort(np.sum((means - each) ** 2, axis=1))[1:4] for each in means]
    apart = np.sqrt(np.mean(near, axis=1))  # root mean squared distance of three neighbors
    return {
        "means": means,
        "quats": np.eye(4)[[0] * len(means)],
        "log_scales": np.log(np.clip(apart, 0.01, 0.3))[:, None] + np.zeros((1, 3)),
        "colors": points[:, 3:],
        "opacity_logits": np.zeros(len(means)),
    }


def decibels(one, other):
    """PSNR."""
    return -10 * np.log10(max(float(np.mean((one - other) ** 2)), 1e-30))


everything = taken()
held_out = range(3, len(everything), 7) or range(len(everything) - 1, len(everything))
unseen = [everything[k] for k in held_out]
views = [view for k, view in enumerate(everything) if k not in held_out]
background = np.mean([truth.mean(axis=(0, 1)) for _, truth in views], axis=0)
scene = cloud(np.random.default_rng(seed))
camera, truth = unseen[0]
print(
    f"capture: {len(views)} photographs of {camera['width']} x {camera['height']}, "
    f"{len(unseen)} held out; {len(scene['means'])} Gaussians to begin with"
)

# %% [markdown]
# ## Your image and your derivatives, beside the core's

# %%
if core:
    draws = np.random.default_rng(3)
    tilted = {key: each + 0.1 * draws.uniform(0, 1, each.shape) for key, each in scene.items()}
    small = {**camera, "width": 32, "height": 21, "center": np.array([16, 10.5])}
    small["focal"] = camera["focal"] * 32 / camera["width"]
    d_shown = draws.uniform(-1, 1, (21, 32, 3))
    (a, a_back), (b, b_back) = (draw(tilted, small, background) for draw in (mine.picture, core[0]))
    a_d, b_d = a_back(d_shown), b_back(d_shown)
    off = [
        np.linalg.norm(a_d[key] - b_d[key]) / np.linalg.norm(b_d[key])
        for key in (*mine.RATES, "background")
    ]
    print(f"core:    images differ by {np.abs(a - b).max():.0e}, derivatives by {max(off):.0e}")
    # The core sums signed contributions, so its statistics are smaller.
    smaller = {"THRESHOLD": mine.THRESHOLD / 10, "SMALL": mine.SMALL / 3}
    explore.set_constants(mine, picture=core[0], **smaller)

# %% [markdown]
# ## The fit
# In three parts, each with smaller learning rates than the one before.

# %%
frames, done, watch_time = [], 0, explore.Stopwatch()


def watch(step, now, _):
    """Prints the progress of the fit, and keeps frames of a held-out view."""
    if (done + step) % max(1, steps // 40) == 0:
        shown, _ = mine.picture(now, camera, background)
        frames.append(shown)
        print(
            f"\rfit:     step {done + step} of {steps}, {len(now['means'])} Gaussians, "
            f"{decibels(shown, truth):.1f} dB on a held-out view, "
            f"{watch_time} ",
            end="",
            flush=True,
        )


rng, rates = np.random.default_rng(seed), dict(mine.RATES)
for share, slower in ((0.6, 1.0), (0.25, 0.3), (0.15, 0.1)):
    explore.set_constants(mine, RATES={key: slower * rate for key, rate in rates.items()})
    some, limit = max(1, round(share * steps)), most if slower == 1.0 else 0
    scene, _ = mine.fit(scene, views, some, rng, background, limit, every, watch)
    done += some
shown = [mine.picture(scene, each, background)[0] for each, _ in unseen]
scores = [decibels(got, photo) for got, (_, photo) in zip(shown, unseen, strict=True)]
plain = [decibels(background, photo) for _, photo in unseen]
print(
    f"\nfit:     {done} steps in {watch_time}, {len(scene['means'])} "
    f"Gaussians, {np.mean(scores):.1f} dB over all held-out views "
    f"(one color has {np.mean(plain):.1f} dB)"
)
np.savez_compressed("scene.npz", background=background, **scene)

# %% [markdown]
# ## Pictures, and a turntable


# %%
def byte(image):
    """An image in 8 bits, with even sizes, as videos want them."""
    tall, wide = (2 * (n // 2) for n in image.shape[:2])
    return (255 * np.clip(image[:tall, :wide], 0, 1) + 0.5).astype(np.uint8)


def write_gif(name, images, milliseconds):
    """An animation of some images, which begins anew at its end."""
    large = [Image.fromarray(byte(image)) for image in images]
    if camera["width"] < 300:
        large = [each.resize((3 * each.width, 3 * each.height)) for each in large]
    large[0].save(name, save_all=True, append_images=large[1:], duration=milliseconds, loop=0)
    print(f"{name}: {len(large)} images")
    explore.show_file(name)


write_gif("fit.gif", frames, 120)
poses = [np.linalg.inv(np.vstack([each["camera_from_world"], [0, 0, 0, 1]])) for each, _ in views]
eyes = np.stack([pose[:3, 3] for pose in poses])
up = -np.mean([pose[:3, 1] for pose in poses], axis=0)
up /= np.linalg.norm(up)
height = np.mean(eyes @ up)
ring = np.median(np.linalg.norm(eyes - np.outer(eyes @ up, up), axis=1))
right = np.cross(up, eyes[0])
right /= np.linalg.norm(right)
turn = []
for angle in 2 * np.pi * np.arange(count) / count:
    eye = height * up + ring * (np.cos(angle) * np.cross(right, up) + np.sin(angle) * right)
    lens = camera_of(look_at_origin(eye, up), camera["focal"][0], camera["width"], camera["height"])
    turn.append(mine.picture(scene, lens, background)[0])
try:
    video = Path("turntable.mp4")
    core[1](video, [byte(each) / 255 for each in turn], frames_per_second=24)
    print(f"{video}: {len(turn)} images")
except (TypeError, OSError):  # no core, or no encoder
    write_gif("turntable.gif", turn, 60)

figure = Figure(figsize=(5 * len(unseen), 7), layout="constrained")
panels = figure.subplots(2, len(unseen), squeeze=False)
for k, (got, (_, photo)) in enumerate(zip(shown, unseen, strict=True)):
    for axes, image, title in (
        (panels[0, k], photo, "held-out photograph"),
        (panels[1, k], got, f"your Gaussians: {scores[k]:.1f} dB"),
    ):
        axes.imshow(np.clip(image, 0, 1))
        axes.set(title=title, xticks=[], yticks=[])
explore.keep_picture(figure, "banana.png")
print("banana.png: photographs that the fit did not see, and the same views of your Gaussians")
