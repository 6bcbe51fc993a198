"""The scene of Figure 1 by formulas, its photographs, a training, and the normals of a density."""

import numpy as np

LIGHT = np.array([0.5, 0.8, 0.35]) / np.linalg.norm([0.5, 0.8, 0.35])
# Center, radius, color.
BALLS = (
    ((-0.33, -0.08, 0.05), 0.42, (0.9, 0.25, 0.15)),
    ((0.38, -0.25, 0.25), 0.25, (0.12, 0.4, 0.85)),
    ((0.28, -0.3, -0.42), 0.2, (0.95, 0.72, 0.15)),
)
FLOOR, DISK = -0.5, 0.95  # its height, and its radius
WHITE = np.ones(3)


def unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def nearest(origins, directions):
    """(distance, which): of the first ball, 3 for the floor, -1 for none."""
    distance, which = np.full(len(origins), np.inf), np.full(len(origins), -1)
    for k, (center, radius, _) in enumerate(BALLS):
        away = origins - np.array(center)
        b = np.sum(away * directions, axis=1)
        root = b * b - np.sum(away**2, axis=1) + radius**2
        found = -b - np.sqrt(np.maximum(root, 0.0))
        hit = (root > 0) & (found > 1e-6) & (found < distance)
        distance[hit], which[hit] = found[hit], k
    with np.errstate(divide="ignore", invalid="ignore"):
        found = (FLOOR - origins[:, 1]) / directions[:, 1]
    found = np.where(np.isfinite(found), found, -1.0)
    place = origins + found[:, None] * directions
    hit = (found > 1e-6) & (np.hypot(place[:, 0], place[:, 2]) < DISK) & (found < distance)
    distance[hit], which[hit] = found[hit], 3
    return distance, which


def seen(origins, directions):
    """Linear colors (P, 3): shiny balls on a checkered disk, with shadows, before white."""
    colors = np.ones((len(origins), 3))
    distance, which = nearest(origins, directions)
    hit = which >= 0
    place, kind = origins[hit] + distance[hit, None] * directions[hit], which[hit]
    normal, paint = np.tile([0.0, 1.0, 0.0], (len(place), 1)), np.zeros((len(place), 3))
    for k, (center, radius, color) in enumerate(BALLS):
        normal[kind == k] = (place[kind == k] - np.array(center)) / radius
        paint[kind == k] = color
    squares = np.floor(3.0 * place[:, 0] + 0.5) + np.floor(3.0 * place[:, 2] + 0.5)
    paint[kind == 3] = np.where(squares[kind == 3, None] % 2 == 0, 0.7, 0.2)
    below = np.sum(normal * directions[hit], axis=1) > 0
    normal[below] *= -1
    lit = nearest(place + 1e-4 * normal, np.tile(LIGHT, (len(place), 1)))[1] < 0
    half = unit(LIGHT - directions[hit])
    gloss = np.where(kind < 3, 0.5, 0.0) * np.maximum(np.sum(normal * half, axis=1), 0) ** 40
    shade = 0.35 + 0.1 * normal[:, 1] + 0.75 * np.maximum(normal @ LIGHT, 0) * lit
    colors[hit] = np.clip(paint * shade[:, None] + (gloss * lit)[:, None], 0, 1)
    return colors


def camera_rays(place, size, shift=(0.5, 0.5)):
    """Rays through size^2 pixels of a camera at a place that looks at the origin."""
    forward = -unit(place)
    side = unit(np.cross(forward, [0.0, 1.0, 0.0]))
    down = np.cross(forward, side)
    x, y = ((np.arange(size) + each) / size - 0.5 for each in shift)
    d = forward + (x[None, :, None] * side + y[:, None, None] * down) / 1.4
    return np.tile(place, (size * size, 1)), unit(d.reshape(-1, 3))


def places(count, turn=0.0):
    """Positions of cameras on the upper half of a sphere of 3 m."""
    height = 0.12 + (np.arange(count) + 0.5) / count * 0.75
    phi = np.arange(count) * 2.399963 + turn
    circle = np.sqrt(1 - height * height)[:, None] * np.stack([np.cos(phi), np.sin(phi)], axis=1)
    return 3.0 * np.insert(circle, 1, height, axis=1)


def photographs(cameras, size, fine=3):
    """Views of all pixels, colors averaged over fine^2 points of each pixel."""
    parts = []
    for place in cameras:
        origins, directions = camera_rays(place, size)
        shifts = (np.arange(fine) + 0.5) / fine
        colors = np.mean(
            [seen(*camera_rays(place, size, (x, y))) for x in shifts for y in shifts], 0
        )
        parts.append((origins, directions, colors))
    names = ("origins", "directions", "colors")
    taken = dict(zip(names, map(np.concatenate, zip(*parts, strict=True)), strict=True))
    return {**taken, "background": WHITE, "near": 1.9, "far": 4.1}


def decibels(got, truth):
    return float(-10 * np.log10(np.mean((got - truth) ** 2)))


def views_of(photos, background, near, far):
    """Views of all pixels of photographs of a capture."""
    origins, directions = (
        np.concatenate(each) for each in zip(*[photo.rays() for photo in photos], strict=True)
    )
    colors = np.concatenate([photo.colors.reshape(-1, 3) for photo in photos])
    taken = {"origins": origins, "directions": unit(directions), "colors": colors}
    return {**taken, "background": background, "near": near, "far": far}


MARKS = (30, 100, 300, 1000, 2500)  # steps after which the training is looked at
SEED = 12


def both_views(count=40, size=40):
    """(photographs of training, three that are held out), as views of all their pixels."""
    return photographs(places(count), size), photographs(places(3, turn=1.7), size)


def trained(module, views, width, marks):
    """(networks after the marked steps, losses) of one training from the start.

    A network is noted where `train_nerf` asks `loss_and_grad` about it.
    """
    passed, kept = [], module.loss_and_grad

    def noted(network, batch, t):
        passed.append(network)
        return kept(network, batch, t)

    rng = np.random.default_rng(SEED)
    start = module.make_network(width, 16, rng)
    module.loss_and_grad = noted
    try:
        last, losses = module.train_nerf(views, start, marks[-1], rng)
    finally:
        module.loss_and_grad = kept
    passed.append(last)
    return [passed[min(k, len(passed) - 1)] for k in marks], losses


def normals(module, network, views, samples=64):
    """Normals (P, 3) of what each ray sees, and its opacity (P,): weighted sums over samples."""
    ends = views["near"], views["far"]
    middles = ends[0] + (np.arange(samples) + 0.5) / samples * (ends[1] - ends[0])
    t = np.tile(middles, (len(views["origins"]), 1))
    dt = np.diff(module.edges_between(t, *ends), axis=1)
    found, opacity = np.zeros((len(t), 3)), np.zeros(len(t))
    for first in range(0, len(t), 1024):
        part = slice(first, first + 1024)
        p, d = module.points_on(module.take(views, part), t[part])
        sigma = module.radiance_field(network, p, d)[0].reshape(t[part].shape)
        weights = module.ray_weights(sigma, dt[part])
        outward = -module.density_gradient(network, p).reshape(*weights.shape, 3)
        found[part] = np.einsum("rs,rsc->rc", weights, outward)
        opacity[part] = weights.sum(axis=1)
    return found / np.maximum(np.linalg.norm(found, axis=1, keepdims=True), 1e-9), opacity
