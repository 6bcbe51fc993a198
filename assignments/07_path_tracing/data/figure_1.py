"""Figure 1 of the handout, by your functions: a picture, and what its caption claims."""

import numpy as np
from matplotlib.figure import Figure


def room(module, width, height, depth, samples):
    """The image (height, width, 3) of `demo_room` by so many paths for each pixel."""
    rays = module.camera_rays(width, height, [0, 1, 3.4], [0, 1, 0], 38)
    total, rng = np.zeros((height * width, 3)), np.random.default_rng(4)
    for _ in range(samples):
        total += module.trace_paths(module.demo_room(), *rays, depth, rng)
    return (total / samples).reshape(height, width, 3)


def table_rays(module, width, height):
    """The rays of `module.table_rays()`, for an image of other sizes."""
    return module.camera_rays(width, height, [0, 0.9, 1.2], [0, 0, -0.3], 45)


def table(module, scene, size, rng, times=1):
    """Direct light on the table, an image of `size` = (width, height), black beside the table."""
    hit = module.closest_hit(scene, *table_rays(module, *size))
    on, each = hit["primitive"] == 0, module.SIDE**2
    many, seen = module.repeated(module.take(hit, on), each), np.zeros((len(on), 3))
    for _ in range(times):
        u = module.strata(rng, on.sum()), module.strata(rng, on.sum())
        seen[on] += module.direct_light(scene, many, *u).reshape(-1, each, 3).mean(axis=1) / times
    return seen.reshape(*size[::-1], 3)


def apart(a, b):
    return float(np.linalg.norm(a - b) / np.linalg.norm(b))


GAMMA = 1 / 2.2


def draw(module):
    """A room with all bounces and with direct light; a table, and what was recovered of it."""
    full, direct = room(module, 132, 110, 5, 40), room(module, 96, 80, 2, 16)
    target = module.core_answers()[0].reshape(70, 3)
    start = module.demo_table((0.5, 0.5, 0.5), 0.6)
    rng = np.random.default_rng(7)
    color, rough, _ = module.recover(start, 0, *module.table_rays(), target, 45, rng)
    tables = [
        table(module, scene, (60, 42), rng, 6)
        for scene in (module.demo_table(), start, module.demo_table(color, rough))
    ]
    off = np.abs(np.append(color, rough) - (0.8, 0.5, 0.2, 0.35))
    claims = {
        "direct light leaves the ceiling black": direct[0, 32:64].mean(),
        "bounces light it": full[0, 44:88].mean(),
        "the recovered table looks like the truth": apart(tables[2], tables[0]),
        "and has its numbers within 0.02": off.max(),
    }
    figure = Figure(figsize=(7.0, 4.3), layout="constrained")
    grid = figure.add_gridspec(2, 4, width_ratios=(1.45, 1.45, 1, 1), height_ratios=(1.45, 1))
    places = (grid[:, :2], grid[0, 2:], grid[1, 2], grid[1, 3])
    names = ("a room, by your path tracer", "direct light alone", "a table: first guess", "found")
    for place, name, picture in zip(places, names, (full, direct, *tables[1:]), strict=True):
        axes = figure.add_subplot(place)
        top = 1.0 if picture is full or picture is direct else 2.0
        axes.imshow(np.clip(picture / top, 0, 1) ** GAMMA, interpolation="nearest")
        axes.set(xticks=[], yticks=[], title=name)
    return figure, claims
