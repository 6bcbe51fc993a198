"""What the figures of assignment 12 draw: its scene, a training, pieces of diagrams."""

import functools

import numpy as np
from matplotlib.patches import FancyBboxPatch
from photograd_course.build.kit_module import kit_module

SCENE = kit_module("12_nerf", "scene")
photographs, decibels, nearest, places = (
    SCENE.photographs,
    SCENE.decibels,
    SCENE.nearest,
    SCENE.places,
)
MARKS = SCENE.MARKS


@functools.cache
def trained(module):
    """(networks after the marked steps, held-out views) of the training of `explore.py`."""
    views, unseen = SCENE.both_views()
    start = module.make_network(64, 16, np.random.default_rng(SCENE.SEED))
    _, losses = module.train_nerf(views, start, 60, np.random.default_rng(SCENE.SEED))
    if not losses[-20:].mean() < 0.5 * losses[:20].mean():
        return [start] * len(MARKS), unseen  # not worth the wait
    networks, _ = SCENE.trained(module, views, 64, MARKS)
    return networks, unseen


def box(axes, x, y, width, text, color):
    """A labeled box of a diagram, its left edge at x, its middle at y."""
    axes.add_patch(
        FancyBboxPatch(
            (x, y - 0.35), width, 0.7, boxstyle="round,pad=0.02", facecolor=color, edgecolor="none"
        )
    )
    axes.text(x + width / 2, y, text, ha="center", va="center", fontsize=7.5)


def arrow(axes, start, end):
    axes.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "linewidth": 0.9})


def fit_points(module, p, colors, known, bands, steps):
    """Colors (N, 3) at all points of a network that was trained at the known ones."""
    encoded, _ = module.positional_encoding(p, bands)
    rng = np.random.default_rng(1)
    network = {"picture": module.make_layers([encoded.shape[1], 48, 48, 3], rng)}
    adam, chosen = module.Adam(), np.flatnonzero(known)
    for _ in range(steps):
        batch = rng.choice(chosen, min(1024, len(chosen)), replace=False)
        activations = module.mlp_forward(network["picture"], encoded[batch])
        got = module.sigmoid(activations[-1])
        back = 2 * (got - colors[batch]) / got.size * got * (1 - got)
        d_layers, _ = module.mlp_backward(network["picture"], activations, back)
        network = adam.step(network, {"picture": d_layers})
    return module.sigmoid(module.mlp_forward(network["picture"], encoded)[-1])
