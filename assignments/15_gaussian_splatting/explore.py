# %% [markdown]
# # Photographs become Gaussians
# Photographs three balls defined by formulas, fits Gaussians to them with your functions, and plots
# their gradients; then two formulas of public code are tested by finite differences of your own
# functions, and everything is compared with the C++ core where that is installed. Never graded.
# `python explore.py` takes `--steps`, `--pixels`, `--views`, `--max-count` (Gaussians),
# `--every` (steps between two changes of their number), `--seed`, and `--core-pixels`.

# %%
import importlib
import time

import numpy as np
import splatting as mine
from matplotlib.figure import Figure
from photograd_course.captures import all_around, look_at_origin, striped_balls
from photograd_course.explore import option
from PIL import Image

steps, size, count = option("steps", 600), option("pixels", 64), option("views", 12)
max_count, every, seed = option("max-count", 500), option("every", 40), option("seed", 0)
BACKGROUND = np.array([0.05, 0.06, 0.09])

# %% [markdown]
# ## A scene, and its photographs


# %%
def camera_at(place, width):
    """A camera at a place that looks at the origin, x to the right, y down, z forward."""
    W = look_at_origin(place)[:3, :3].T
    pose = np.concatenate([W, -(W @ place)[:, None]], axis=1)
    middle = np.full(2, width / 2)
    return {
        "camera_from_world": pose,
        "focal": np.full(2, 1.2 * width),
        "center": middle,
        "width": width,
        "height": width,
    }


def around(number, width, turn=0.0):
    """Cameras on a sphere of 3.2 m around the origin."""
    places = 3.2 * all_around(number, turn, up=1, top=0.8, span=1.2)
    return [camera_at(place, width) for place in places]


def photograph(camera):
    """Three lit and striped balls by ray tracing, nine rays per pixel."""
    n, fine = camera["width"], 3
    W, b = camera["camera_from_world"][:, :3], camera["camera_from_world"][:, 3]
    v, u = (np.mgrid[0 : fine * n, 0 : fine * n] + 0.5) / fine
    d = np.stack([u, v, 0 * u], axis=-1) - [*camera["center"], 0]
    d = d / [*camera["focal"], 1] + [0, 0, 1]
    d = d / np.linalg.norm(d, axis=-1, keepdims=True) @ W
    image = striped_balls(-b @ W, d, BACKGROUND)
    return image.reshape(n, fine, n, fine, 3).mean(axis=(1, 3))


def decibels(one, other):
    """PSNR."""
    return -10 * np.log10(max(float(np.mean((one - other) ** 2)), 1e-30))


def cloud(number, rng):
    """The initial scene of a fit: gray balls at random positions."""
    return {
        "means": rng.uniform(-0.8, 0.8, (number, 3)),
        "quats": np.eye(4)[[0] * number],
        "log_scales": np.full((number, 3), np.log(0.1)),
        "colors": np.full((number, 3), 0.5),
        "opacity_logits": np.full(number, -1.0),
    }


views = [(camera, photograph(camera)) for camera in around(count, size)]
unseen = [(camera, photograph(camera)) for camera in around(3, size, 1.0)]
start = cloud(min(120, max_count), np.random.default_rng(seed))

# %% [markdown]
# ## The fit

# %%
frames, began = [], time.perf_counter()


def watch(step, scene, _):
    """Prints the progress of the fit, and stores frames of it."""
    if step % max(1, steps // 40) == 0:
        shown, _ = mine.picture(scene, unseen[0][0], BACKGROUND)
        frames.append(shown)
        print(
            f"\rfit:    step {step} of {steps}, {len(scene['means'])} Gaussians, "
            f"{decibels(shown, unseen[0][1]):.1f} dB on a held-out view, "
            f"{time.perf_counter() - began:.0f} s ",
            end="",
            flush=True,
        )


found, losses = mine.fit(
    start, views, steps, np.random.default_rng(seed), BACKGROUND, max_count, every, watch
)
seconds = time.perf_counter() - began
scores = [decibels(mine.picture(found, camera, BACKGROUND)[0], truth) for camera, truth in unseen]
empty = [decibels(np.broadcast_to(BACKGROUND, truth.shape), truth) for _, truth in unseen]
print(
    f"\rfit:    {steps} steps in {seconds:.0f} s, {len(found['means'])} Gaussians, "
    f"{np.mean(scores):.1f} dB on held-out views "
    f"(an empty scene has {np.mean(empty):.1f} dB)  "
)


def byte(shown):
    """An image in 8 bits."""
    return (255 * np.clip(shown, 0, 1) + 0.5).astype(np.uint8)


large = [
    Image.fromarray(byte(each)).resize((256, 256), Image.Resampling.NEAREST) for each in frames
]
large[0].save("fit.gif", save_all=True, append_images=large[1:], duration=120, loop=0)
print("fit.gif: a held-out view during the fit")

# %% [markdown]
# ## The gradient of each Gaussian
# Arrows: where gradient descent moves each mean on the screen. Circles: the absolute gradient, the
# criterion of `densify`.

# %%
camera, truth = views[0]
shown, back = mine.picture(found, camera, BACKGROUND)
gradient = back(2 * (shown - truth) / shown[..., 0].size)
cov, _ = mine.covariance(found["quats"], found["log_scales"])
places, *_ = mine.project(found["means"], cov, camera)
# The gradient with respect to the means, per pixel on the screen.
W = camera["camera_from_world"][:2, :3]
depth = mine.depths(found["means"], camera)
arrows = -(gradient["means"] @ W.T) * (depth / camera["focal"][0])[:, None]
absgrad = np.linalg.norm(gradient["absgrad"], axis=1)
figure = Figure(figsize=(13, 4.4), layout="constrained")
panels = figure.subplots(1, 3)
for axes, image, title in (
    (panels[0], truth, "a photograph"),
    (panels[1], shown, "your Gaussians"),
    (panels[2], shown, "arrows: −gradient; circles: absolute gradient"),
):
    axes.imshow(np.clip(image, 0, 1), extent=(0, size, size, 0))
    axes.set(title=title, xticks=[], yticks=[], xlim=(0, size), ylim=(size, 0))
panels[2].scatter(
    *places.T, s=300 * absgrad / absgrad.max(), facecolors="none", edgecolors="w", lw=0.7
)
long = np.linalg.norm(arrows, axis=1).max()
panels[2].quiver(*places.T, *(arrows.T / long), angles="xy", scale_units="xy", scale=0.2, color="r")
figure.savefig("absgrad.png", dpi=100)
print("absgrad.png: a photograph, your image, and the gradients")

# %% [markdown]
# ## A test of two formulas of public code
# The reference is finite differences of *your* functions.


# %%
def differences(function, x, g, eps=1e-5):
    """Central differences of <function(x), g> with respect to each number of x."""
    slope = np.zeros_like(x)
    for k in np.ndindex(x.shape):
        ends = []
        for sign in (1, -1):
            moved = x.copy()
            moved[k] += sign * eps
            ends.append(np.sum(function(moved) * g))
        slope[k] = (ends[0] - ends[1]) / (2 * eps)
    return slope


def off(told, right):
    """Relative error of a derivative."""
    return np.linalg.norm(told - right) / np.linalg.norm(right)


draws = np.random.default_rng(3)
m, S = np.array([[3.0, 2.0]]), np.array([[6.0, 2.5, 4.0]])
grid = np.stack(np.meshgrid(np.arange(6) + 0.5, np.arange(5) + 0.5), axis=-1).reshape(-1, 2)
g = draws.uniform(-1.0, 1.0, (1, len(grid)))
right = differences(lambda x: mine.screen_alpha(m, x, np.zeros(1), grid)[0], S, g)
alpha, _ = mine.screen_alpha(m, S, np.zeros(1), grid)
full = S[0, [0, 1, 1, 2]].reshape(2, 2) + mine.LOW_PASS * np.eye(2)
Q, d = np.linalg.inv(full), m - grid
s = -(g * alpha)[0]  # the derivative with respect to sigma
kept = np.array([0.5 * s @ d[:, 0] ** 2, 0.5 * s @ (d[:, 0] * d[:, 1]), 0.5 * s @ d[:, 1] ** 2])


def by_covariance(of_conic, factor):
    """From derivatives of A, B, C to those of xx, xy, yy, that of B times `factor`."""
    H = np.array([[of_conic[0], factor / 2 * of_conic[1]], [factor / 2 * of_conic[1], of_conic[2]]])
    D = -Q @ H @ Q
    return np.array([[D[0, 0], 2 * D[0, 1], D[1, 1]]])


halved, patched = (off(by_covariance(kept * [1, whole, 1], 2), right) for whole in (1, 2))
print(
    f"conic:  the derivative of B stored halved and doubled later has an error of {halved:.0e}; "
    f"the patch (stored whole, still doubled) of {patched:.0%}"
)

lens = around(1, 64)[0]
high = mine.limits(lens)[1][0]
point = np.array([[1.4 * high, 0.1, 1.0]]) * 2.5
world = (point - lens["camera_from_world"][:, 3]) @ lens["camera_from_world"][:, :3]
wide = np.array([[[0.09, 0.02, 0.01], [0.02, 0.06, 0.0], [0.01, 0.0, 0.04]]])
g = np.array([[0.3, -0.7, 0.5]])
by_mean = differences(lambda x: mine.project(x, wide, lens)[1], world, g)
by_depth = by_mean[0] @ lens["camera_from_world"][2, :3]
A = (
    np.array([[1, 0, -high], [0, 1, -point[0, 1] / point[0, 2]]])
    * lens["focal"][:, None]
    / point[0, 2]
)
V = lens["camera_from_world"][:, :3] @ wide[0] @ lens["camera_from_world"][:, :3].T
G = np.array([[g[0, 0], g[0, 1] / 2], [g[0, 1] / 2, g[0, 2]]])
slopes = 2 * G @ A @ V
f, z = lens["focal"][0], point[0, 2]
told = -np.sum(slopes[:, :2] * A[:, :2]) / z
told += slopes[0, 2] * 2 * f * high / z**2  # as in public code
told += slopes[1, 2] * 2 * f * (point[0, 1] / z) / z**2
mended = told - slopes[0, 2] * f * high / z**2
print(
    f"clamp:  d / d t_z, outside: finite differences {by_depth:.4f}, "
    f"the formula of public code {told:.4f}, "
    f"with a separate clamped branch {mended:.4f}"
)

# %% [markdown]
# ## The C++ core
# Its image and derivatives beside yours; then the same fit, with your `densify`, on photographs of
# `--core-pixels`, rendered by the core.

# %%
Y0 = 0.28209479177387814


def of_the_core():
    """`picture` by the core; raises if it is not installed."""
    splat = importlib.import_module("photograd.splats.splatting")
    cameras = importlib.import_module("photograd.capture.camera")

    def drawn(scene, camera, background):
        pose = np.eye(4)
        pose[:3] = camera["camera_from_world"]
        (fx, fy), (cx, cy) = camera["focal"].tolist(), camera["center"].tolist()
        lens = cameras.Camera(
            world_from_camera=np.linalg.inv(pose),
            width=camera["width"],
            height=camera["height"],
            fx=fx,
            fy=fy,
            cx=cx,
            cy=cy,
        )
        told = {key: scene[key] for key in ("means", "log_scales", "quats", "opacity_logits")}
        own = splat.Gaussians(**told, sh=((scene["colors"] - 0.5) / Y0)[:, None])
        options = splat.SplatOptions(stop=0.0)
        shown, context = splat.render(own, lens, background=background, options=options)

        def back(d_shown):
            got = splat.render_backward(context, np.ascontiguousarray(d_shown))
            rest = {"colors": got.gaussians["sh"][:, 0] / Y0, "absgrad": np.abs(got.screen)}
            return {
                **{key: got.gaussians[key] for key in told},
                **rest,
                "background": got.background,
            }

        return np.asarray(shown.color), back

    drawn(start, views[0][0], BACKGROUND)
    return drawn


try:
    core = of_the_core()
except (ImportError, AttributeError, TypeError):  # none, or another than this was written for
    print("core not installed")
else:
    scene = {
        **found,
        "colors": np.maximum(found["colors"], 0.01),
    }  # those of the core are not negative
    (mine_shown, mine_back), (core_shown, core_back) = (
        draw(scene, camera, BACKGROUND) for draw in (mine.picture, core)
    )
    d_shown = draws.uniform(-1.0, 1.0, mine_shown.shape)
    mine_d, core_d = mine_back(d_shown), core_back(d_shown)
    worst = max(off(mine_d[key], core_d[key]) for key in (*mine.RATES, "background"))
    shown = off(mine_shown, core_shown)
    print(f"core:   images differ by {shown:.0e}, derivatives differ by {worst:.0e}")
    wider, kept_back = option("core-pixels", 200), mine.picture
    sharp = [(each, photograph(each)) for each in around(2 * count, wider)]
    mine.picture, before = core, time.perf_counter()
    # The core sums signed contributions first, so its statistics are smaller.
    mine.THRESHOLD, limit = mine.THRESHOLD / 4, mine.SMALL
    mine.SMALL = limit / 2
    many, _ = mine.fit(
        cloud(500, np.random.default_rng(seed)),
        sharp,
        2 * steps,
        np.random.default_rng(seed),
        BACKGROUND,
        8 * max_count,
        every,
    )
    mine.picture = kept_back
    tests = [(each, photograph(each)) for each in around(3, wider, 1.0)]
    pairs = [(core(many, each, BACKGROUND)[0], truth) for each, truth in tests]
    Image.fromarray(byte(np.concatenate([pairs[0][1], pairs[0][0]], axis=1))).save("core.png")
    score, took = np.mean([decibels(*pair) for pair in pairs]), time.perf_counter() - before
    print(
        f"core:   {2 * steps} steps of {wider} x {wider} in {took:.0f} s, "
        f"{len(many['means'])} Gaussians, {score:.1f} dB; core.png"
    )
