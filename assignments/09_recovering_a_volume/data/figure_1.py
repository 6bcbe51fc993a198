"""Figure 1 of the handout, by your functions: a picture, and what its caption claims."""

import numpy as np
from matplotlib.figure import Figure
from photograd_course.captures import all_around, look_at_origin

BACKGROUND = np.array([0.04, 0.05, 0.08])


LOW, HIGH = np.full(3, -1.0), np.full(3, 1.0)


LARGE = 80  # pixels of the views that are shown


def views_of(pictures, poses, zoom=1.2):
    return {
        "pictures": pictures,
        "world_from_camera": poses,
        "focal": zoom * pictures.shape[2],
        "low": LOW,
        "high": HIGH,
        "background": BACKGROUND,
    }


def snowman(n):
    """A snowman of n^3 voxels, with a hat, a scarf and a carrot, lit from the upper left."""
    x = (np.stack(np.indices((n, n, n)), axis=-1) + 0.5) / n * 2 - 1
    grid = np.full((n, n, n, 4), 0.5)
    grid[..., 3] = 0.0
    light = np.array([-0.5, 0.7, 0.5])

    def add(inside, paint, middle, size):
        """Where `inside`, in voxels, is positive; shaded as a ball around `middle`."""
        solid = np.clip(inside * n / 2 + 0.5, 0, 1)
        here = solid > 0.3
        lit = np.clip((x[here] - middle) @ light / size, -0.3, 1)
        grid[here, :3] = (0.5 + 0.45 * lit)[:, None] * paint
        grid[..., 3] = np.maximum(grid[..., 3], 14 * solid)

    for height, radius in ((-0.5, 0.45), (0.1, 0.32), (0.53, 0.23)):
        away = np.linalg.norm(x - [0, height, 0], axis=-1)
        add(radius - away, (1.0, 1.0, 1.0), (0, height, 0), radius)
    axis = np.hypot(x[..., 0], x[..., 2])
    scarf = 0.085 - np.hypot(axis - 0.22, x[..., 1] - 0.34)
    add(scarf, (0.95, 0.12, 0.1), (0, 0.3, 0), 0.3)
    tail = 0.09 - np.max(np.abs((x - [0.17, 0.16, 0.27]) / [0.9, 2.2, 0.9]), axis=-1)
    add(tail, (0.95, 0.12, 0.1), (0, 0.1, 0), 0.4)
    for radius, half, height in ((0.33, 0.05, 0.72), (0.2, 0.14, 0.83)):
        hat = np.minimum(radius - axis, half - np.abs(x[..., 1] - height))
        add(hat, (0.2, 0.25, 0.5), (0, 0.6, 0), 0.3)
    nose = x - [0, 0.53, 0.2]
    cone = 0.075 * (1 - nose[..., 2] / 0.4) - np.hypot(nose[..., 0], nose[..., 1])
    cone = np.minimum(cone, np.minimum(nose[..., 2], 0.4 - nose[..., 2]))
    add(cone, (1.0, 0.5, 0.1), (0, 0.45, 0.2), 0.1)
    for place in ((-0.09, 0.6, 0.22), (0.09, 0.6, 0.22), (0, 0.2, 0.33), (0, 0.02, 0.33)):
        add(0.055 - np.linalg.norm(x - place, axis=-1), (0.05, 0.05, 0.08), place, 0.1)
    return grid


def renderings(module, grid, views):
    chosen = np.arange(np.asarray(views["pictures"])[..., 0].size)
    origins, directions, _ = module.ray_batch(views, chosen)
    return module.render_rays(grid, LOW, HIGH, origins, directions, 32, BACKGROUND)


def photographs(module, grid, count, size, turn=0.0, zoom=1.2):
    poses = np.stack([look_at_origin(3.2 * p) for p in all_around(count, turn, up=1)])
    views = views_of(np.zeros((count, size, size, 3)), poses, zoom)
    views["pictures"] = renderings(module, grid, views).reshape(count, size, size, 3)
    return views


def large_view(module, grid, views, which):
    """One of the views, with LARGE x LARGE pixels."""
    pose = np.asarray(views["world_from_camera"])[which : which + 1]
    zoom = float(views["focal"]) / np.asarray(views["pictures"]).shape[2]
    large = views_of(np.zeros((1, LARGE, LARGE, 3)), pose, zoom)
    large["pictures"] = renderings(module, grid, large).reshape(1, LARGE, LARGE, 3)
    return large


def score(module, grid, views):
    error = renderings(module, grid, views) - np.asarray(views["pictures"]).reshape(-1, 3)
    return float(-10 * np.log10(np.mean(error**2)))


def watched(module, views, n, marks):
    """The volumes after the marked numbers of steps of one fit.

    A volume is noted where `fit_volume` asks `tv_loss_adjoint` about it.
    """
    passed, asked = [], module.tv_loss_adjoint

    def noted(grid, eps):
        passed.append(grid.copy())
        return asked(grid, eps)

    module.tv_loss_adjoint = noted
    try:
        start = module.fog((n, n, n))
        last, _ = module.fit_volume(views, start, marks[-1], np.random.default_rng(9))
    finally:
        module.tv_loss_adjoint = asked
    return [[*passed, last][k] for k in marks]


def show(axes, picture, title):
    axes.imshow(np.clip(picture, 0, 1) ** (1 / 2.2), interpolation="nearest")
    axes.set(xticks=[], yticks=[])
    axes.set_title(title)


def draw(module):
    """A snowman from its photographs: a held-out view, and the view during the fit."""
    kept = module.SAMPLES, module.RAYS
    module.SAMPLES, module.RAYS = 40, 640
    scene, marks = snowman(36), (1, 6, 15, 35, 90)
    views = photographs(module, scene, 20, 48, 0.0, 1.5)
    unseen = photographs(module, scene, 4, 48, 1.0, 1.5)
    found = watched(module, views, 36, marks)
    module.SAMPLES, module.RAYS = kept
    scores = [score(module, grid, unseen) for grid in found]
    claims = {
        "the fit passes 27 dB on held-out views": scores[-1],
        "it gets better from picture to picture": (np.diff(scores[:4]) > 0).all(),
    }
    poses = np.asarray(views["world_from_camera"])
    front = {**views, "world_from_camera": look_at_origin(np.array([1.2, 0.9, 2.8]))[None]}
    front["focal"] = 64.0  # wider, so that the hat is in the picture
    large = large_view(module, scene, front, 0)
    pictures = [renderings(module, grid, large).reshape(LARGE, -1, 3) for grid in found]
    figure = Figure(figsize=(7.0, 4.5), layout="constrained")
    grid = figure.add_gridspec(2, 15, height_ratios=(1.7, 1))
    top = (
        ("one of 20 photographs", np.asarray(views["pictures"])[poses[:, 2, 3].argmax()]),
        ("held out", np.asarray(large["pictures"])[0]),
        (f"your volume, {scores[-1]:.1f} dB", pictures[-1]),
    )
    for k, (title, picture) in enumerate(top):
        show(figure.add_subplot(grid[0, 5 * k : 5 * k + 5]), picture, title)
    for k, (steps, picture) in enumerate(zip(marks, pictures, strict=True)):
        title = f"{steps} step{'s' * (steps > 1)}"
        show(figure.add_subplot(grid[1, 3 * k : 3 * k + 3]), picture, title)
    return figure, claims
