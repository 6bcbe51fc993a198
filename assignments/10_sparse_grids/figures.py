"""The figures of assignment 10, and the facts that their captions claim."""

from __future__ import annotations

from types import ModuleType

import figure_parts as parts
import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from photograd_course.viz.handout import Array, Fact, Facts, figures_of, note, subplots
from photograd_course.viz.style import BLUE, GRAY, INK, ORANGE, plain_axes, signed_color_map
from photograd_course.viz.style import RED as CRIMSON


def fig1_absent(module: ModuleType) -> tuple[Figure, Facts]:
    """Derivative of a loss with respect to the extinction of an absent step, over its color."""
    colors = np.linspace(0, 1, 21)
    slopes = np.array([parts.gap(module, 0.0, c)[1][3] for c in colors])
    by_color = np.array([np.abs(parts.gap(module, 0.0, c)[1][:3]).max() for c in colors])
    apart = [(parts.gap(module, 1e-6, c)[0] - parts.gap(module, 0.0, c)[0]) / 1e-6 for c in colors]
    behind = 0.8 * -np.expm1(-1.0)
    sigma = np.linspace(0, 6, 61)
    curves = {c: np.array([parts.gap(module, s, c)[0] for s in sigma]) for c in (0.9, 0.3)}
    crossing = float(np.interp(0, slopes[::-1], colors[::-1]))
    facts: Facts = {
        "the derivative changes its sign at the color seen behind": Fact(
            crossing - behind, -0.01, 0.01, red="back_first_channel"
        ),
        "finite differences agree": Fact(
            np.abs(slopes - apart).max(), 0, 1e-5, red="back_without_g"
        ),
        "the derivative with respect to color is zero": Fact(
            by_color.max(), 0, 0, red="back_without_g"
        ),
        "bright: the loss falls at first": Fact(
            curves[0.9][1] < curves[0.9][0], held="what the figure was given"
        ),
        "dim: it rises": Fact((np.diff(curves[0.3]) > 0).all(), held="what the figure was given"),
    }
    figure, (left, right) = subplots(7.0, 2.8, 1, 2)
    left.axhline(0, color=GRAY, linewidth=0.8)
    left.axvline(behind, color=GRAY, linewidth=0.8, linestyle="--")
    left.plot(colors, slopes, color=BLUE)
    left.plot(colors[::2], apart[::2], "o", color=INK, markersize=3)
    note(left, "color behind", (behind, slopes.min()), (4, 0))
    left.set(xlabel="color of the step", ylabel="∂L/∂σ at σ = 0")
    for c, color in ((0.9, BLUE), (0.3, ORANGE)):
        right.plot(sigma, curves[c], color=color)
        note(
            right, f"color {c}", (sigma[40], curves[c][40]), (0, 6 if c > 0.5 else -14), color=color
        )
    right.set(xlabel="σ of the new step  [1/m]", ylabel="loss")
    for axes in (left, right):
        plain_axes(axes)
    return figure, facts


def fig2_octree(module: ModuleType) -> tuple[Figure, Facts]:
    """The leaves of an octree in a slice; nodes by resolution."""
    n = 32
    tree = module.octree_from_dense(parts.shell(n))
    sizes = np.array([4, 8, 16, 32])
    shells = np.array([len(module.octree_from_dense(parts.shell(k))) for k in sizes])
    ones = []
    for k in sizes:
        one = np.zeros((k, k, k), bool)
        one[1, 2, 0] = True
        ones.append(len(module.octree_from_dense(one)))
    growth = shells[-1] / shells[-2]
    half = len(module.octree_from_dense(np.indices((n, n, n))[0] < n // 2))
    facts: Facts = {
        "one full cell costs 8 nodes per level": Fact(
            (np.array(ones) == 1 + 8 * np.log2(sizes)).all(), red="octree_empty_cut"
        ),
        "a shell about four times as many with each doubling": Fact(
            growth, 3.4, 4.6, red="octree_never_merged"
        ),
        "at 32 less than a fifth of the cells": Fact(
            shells[-1] / n**3, 0.01, 0.2, red="octree_never_merged"
        ),
        "two halves are eight leaves": Fact(half == 9, red="octree_full_cut"),
    }
    figure, (left, right) = subplots(7.0, 3.3, 1, 2)
    for low, side, full in parts.leaves_in_slice(module, tree, n, n // 2):
        left.add_patch(
            Rectangle(
                low, side, side, facecolor=ORANGE if full else "white", edgecolor=INK, linewidth=0.4
            )
        )
    left.set(xlim=(0, n), ylim=(0, n), aspect="equal", xlabel="x  [cells]", ylabel="y  [cells]")
    right.loglog(sizes, sizes**3.0, color=GRAY, marker="^", markersize=4)
    right.loglog(sizes, shells, color=ORANGE, marker="o", markersize=4)
    right.loglog(sizes, ones, color=BLUE, marker="s", markersize=4)
    for y, text, color in (
        (n**3.0, "cells", INK),
        (shells[-1], "nodes, shell", ORANGE),
        (ones[-1], "nodes, one cell", BLUE),
    ):
        note(right, text, (n, y), (5, 0), va="center", color=color)
    right.set(xlabel="cells along a side", xlim=(3.5, 170))
    right.set_xticks(sizes, [str(k) for k in sizes])
    right.minorticks_off()
    plain_axes(right)
    return figure, facts


def fig3_skip(module: ModuleType) -> tuple[Figure, Facts]:
    """Rays through a slice of the tree: evaluated samples, and lookups of leaves."""
    n, count = 32, 64
    full = parts.shell(n)
    tree = module.octree_from_dense(full)
    height = np.array([3.3, 9.7, 16.4, 24.1])
    first = np.stack([np.full(4, 0.27), height, np.full(4, n / 2 + 0.5)], axis=1)
    tilt = np.array([0.05, 0.03, -0.02, -0.04])
    stride = np.stack([np.full(4, 0.493), 0.493 * tilt, np.zeros(4)], axis=1)
    asked = []

    def leaf(points: Array) -> tuple[Array, Array, Array]:
        asked.append(points)
        return module.octree_leaf(tree, n, points)

    wanted = module.skip_empty(leaf, first, stride, count)
    points = first[:, None] + np.arange(count)[:, None] * stride[:, None]
    right = full[tuple(np.moveaxis(np.floor(points).astype(int), 2, 0))]
    questions = np.concatenate(asked)
    fine = first[:, None] + np.linspace(-0.5, count - 0.5, 6400)[:, None] * stride[:, None]
    inside = full[tuple(np.moveaxis(np.clip(np.floor(fine), 0, n - 1).astype(int), 2, 0))]
    occupied = inside.mean() * count * len(first)
    facts: Facts = {
        "exactly the samples in full cells": Fact((wanted == right).all(), red="skip_one_too_far"),
        "evaluated samples cover at most 1.3 times the occupied length": Fact(
            wanted.sum() / occupied, 0.7, 1.3, red="skip_nothing"
        ),
        "fewer lookups than a third of the samples": Fact(
            len(questions) / right.size, 0.01, 1 / 3, red="skip_each_sample"
        ),
    }
    figure, axes = subplots(7.0, 4.1)
    for low, side, is_full in parts.leaves_in_slice(module, tree, n, n // 2):
        axes.add_patch(
            Rectangle(
                low,
                side,
                side,
                facecolor="#f6dcc3" if is_full else "white",
                edgecolor=GRAY,
                linewidth=0.4,
            )
        )
    for r in range(4):
        axes.plot(*points[r, :, :2].T, ".", color=GRAY, markersize=2.5)
        axes.plot(*points[r, wanted[r], :2].T, "o", color=CRIMSON, markersize=3)
    axes.plot(
        *questions[:, :2].T,
        "o",
        markerfacecolor="none",
        markeredgecolor=BLUE,
        markersize=7,
        linestyle="none",
    )
    axes.set(xlim=(0, n), ylim=(0, n), aspect="equal", xlabel="x  [cells]", ylabel="y  [cells]")
    return figure, facts


def fig4_hash(module: ModuleType) -> tuple[Figure, Facts]:
    """Slots that a search visits, by the load factor."""
    rng = np.random.default_rng(5)
    slots = 1009
    loads = np.array([0.1, 0.3, 0.5, 0.7, 0.8, 0.9])
    found, missing = [], []
    for load in loads:
        looks = [parts.looks(module, rng, slots, int(load * slots)) for _ in range(3)]
        found.append(np.mean([each[0] for each in looks]))
        missing.append(np.mean([each[1] for each in looks]))
    theory = (1 + 1 / (1 - loads)) / 2, (1 + 1 / (1 - loads) ** 2) / 2
    two_thirds = loads <= 0.7
    facts: Facts = {
        "hits follow the formula to 15 % up to 0.7": Fact(
            np.abs(np.array(found) / theory[0] - 1)[two_thirds].max(), 0, 0.15, red="hash_backwards"
        ),
        "misses to 25 %": Fact(
            np.abs(np.array(missing) / theory[1] - 1)[two_thirds].max(),
            0,
            0.25,
            red="hash_from_zero",
        ),
        "half full: a miss visits fewer than 3": Fact(missing[2], 1.0, 3.0, red="hash_from_zero"),
        "nine tenths full: more than 40": Fact(missing[5], 40.0, 200.0, red="hash_from_zero"),
    }
    figure, axes = subplots(7.0, 2.9)
    x = np.linspace(0.02, 0.92, 90)
    axes.semilogy(x, (1 + 1 / (1 - x) ** 2) / 2, color=ORANGE, linewidth=1)
    axes.semilogy(x, (1 + 1 / (1 - x)) / 2, color=BLUE, linewidth=1)
    axes.semilogy(loads, missing, "s", color=ORANGE, markersize=5)
    axes.semilogy(loads, found, "o", color=BLUE, markersize=5)
    note(axes, "not in the table", (0.9, missing[-1]), (-8, 8), ha="right", color=ORANGE)
    note(axes, "in the table", (0.9, found[-1]), (8, -3), color=BLUE)
    axes.set(xlabel="load factor", ylabel="slots visited", xlim=(0, 1.05))
    axes.set_yticks([1, 3, 10, 30], ["1", "3", "10", "30"])
    axes.minorticks_off()
    plain_axes(axes)
    return figure, facts


def fig5_lost(module: ModuleType) -> tuple[Figure, Facts]:
    """The derivative with respect to extinction of existing voxels, and of absent ones."""
    n = 16
    voxels, values = parts.ball_and_ring(n)
    rays = parts.cameras(12, 10)
    target = module.render(values, parts.samples_of(module, n, voxels, rays))
    # The guess lacks the ring: it has only the ball.
    ball = values[:, 0] > 0.6
    some, kept = voxels[ball], values[ball]
    samples = parts.samples_of(module, n, some, rays)
    before = module.render(kept, samples)
    _, d_kept = module.loss_and_grad(kept, samples, target)
    every = np.argwhere(np.ones((n, n, n), bool))
    at = some @ np.array([n * n, n, 1])
    # Next to existing voxels a new color would change samples: those new voxels are black.
    beside = module.prune_and_dilate(n, some, np.arange(len(some)), np.ones(len(some)), 0.0, 1)
    far = np.ones(n**3, bool)
    far[beside @ np.array([n * n, n, 1])] = False
    maps, pictures = [], []
    whole = parts.samples_of(module, n, every, rays)
    for gray in (0.9, 0.0):
        dense = np.zeros((n**3, 4))
        dense[far, :3] = gray
        dense[at] = kept
        pictures.append(module.render(dense, whole))
        maps.append(module.loss_and_grad(dense, whole, target)[1][:, 3])
    ring = np.zeros(n**3, bool)
    ring[voxels[~ball] @ np.array([n * n, n, 1])] = True
    ring &= far
    facts: Facts = {
        "voxels without extinction change no pixel": Fact(
            max(np.abs(each - before).max() for each in pictures),
            0,
            1e-12,
            red="skip_stops_at_full",
        ),
        "those that exist get the same derivative": Fact(
            np.abs(np.array(maps)[:, at] - d_kept[:, 3]).max(), 0, 1e-12, red="back_to_the_last"
        ),
        "bright: negative in over 90 % of the missing ring": Fact(
            (maps[0][ring] < 0).mean(), 0.9, 1.0, red="back_without_g"
        ),
        "black: in less than half of it": Fact(
            (maps[1][ring] < 0).mean(), 0.0, 0.5, red="skip_stops_at_full"
        ),
    }
    figure, panels = subplots(7.0, 2.6, 1, 3)
    own = np.zeros(n**3)
    own[at] = d_kept[:, 3]
    # Roots, so that small values show as well.
    ends = [np.sign(each) * np.sqrt(np.abs(each)) for each in (own, *maps)]
    end = max(float(np.abs(ends[1][far]).max()), 1e-300)
    titles = ("voxels that exist", "all, the new ones bright", "all, the new ones black")
    for axes, flat, title in zip(panels, ends, titles, strict=True):
        slab = flat.reshape(n, n, n)[:, :, n // 2]
        axes.imshow(slab.T, origin="lower", cmap=signed_color_map(), vmin=-end, vmax=end)
        axes.set(xticks=[], yticks=[], title=title)
    absent = np.ones((n, n, n), bool)
    absent[tuple(some.T)] = False
    nothing = np.ma.masked_where(~absent[:, :, n // 2].T, np.ones((n, n)))
    panels[0].imshow(nothing, origin="lower", cmap="Greys", vmin=0, vmax=6)
    return figure, facts


def fig6_topology(module: ModuleType) -> tuple[Figure, Facts]:
    """Voxels pruned too early are lost; dilation restores them."""
    n, total, threshold = 8, 24, 0.06
    voxels, values = parts.rods_of(16)
    rays, unseen, shown = parts.cameras(10, 6), parts.cameras(6, 8, 1.0), parts.cameras(3, 40, 0.5)
    target, truth = (
        module.render(values, parts.samples_of(module, 16, voxels, each)) for each in (rays, unseen)
    )
    every = np.argwhere(np.ones((n, n, n), bool))
    start = np.tile(module.START, (len(every), 1))
    after = (3, 6, 12)
    scores: dict[int, list[float]] = {0: [], 1: []}
    kept = {}
    for grow in (0, 1):
        for steps in after:
            found = module.fit_sparse(
                n, every, start, rays, target, total // steps, steps, threshold, grow
            )
            kept[grow, steps] = found
            scores[grow].append(parts.decibels(parts.picture(module, n, found, unseen), truth))
    full = module.fit_sparse(n, every, start, rays, target, 1, total, threshold, 0)
    dense = parts.decibels(parts.picture(module, n, full, unseen), truth)
    gap = np.array(scores[1]) - scores[0]
    facts: Facts = {
        "pruned every 3 steps it loses more than 5 dB": Fact(
            gap[0], 5.0, 30.0, red="fit_never_prunes"
        ),
        "dilated, it is never below all voxels": Fact(
            min(scores[1]) - dense, 0.0, 10.0, red="fit_never_grows"
        ),
        "with less than three quarters of the voxels": Fact(
            len(kept[1, 3][0]) / n**3, 0.05, 0.75, red="fit_never_prunes"
        ),
        "the later it is pruned, the less is lost": Fact(
            (np.diff(gap) < 0).all(), red="fit_never_grows"
        ),
    }
    one = slice(1600, 3200)
    figure = Figure(figsize=(7.0, 4.6), layout="constrained")
    grid = figure.add_gridspec(2, 3, height_ratios=(1.1, 1))
    view = shown[:, one]
    pictures = (
        ("truth", module.render(values, parts.samples_of(module, 16, voxels, view))),
        ("pruned every 3 steps", parts.picture(module, n, kept[0, 3], view)),
        ("pruned and dilated", parts.picture(module, n, kept[1, 3], view)),
    )
    for k, (title, colors) in enumerate(pictures):
        axes = figure.add_subplot(grid[0, k])
        axes.imshow(np.clip(colors, 0, 1).reshape(40, 40, 3) ** (1 / 2.2))
        axes.set(xticks=[], yticks=[], title=title)
    axes = figure.add_subplot(grid[1, :])
    axes.axhline(dense, color=GRAY, linestyle="--", linewidth=1)
    note(axes, "all voxels, never pruned", (after[0], dense), (30, -12))
    for grow, color, name in ((0, CRIMSON, "pruned"), (1, BLUE, "pruned and dilated")):
        axes.plot(after, scores[grow], color=color, marker="o", markersize=4)
        note(axes, name, (after[-1], scores[grow][-1]), (8, -3), color=color)
    axes.set(
        xscale="log",
        xlabel="steps before each pruning (24 in all)",
        ylabel="PSNR of held-out views [dB]",
        xlim=(2.7, 22),
    )
    axes.set_xticks(after, [str(k) for k in after])
    axes.minorticks_off()
    plain_axes(axes)
    return figure, facts


FIGURES = figures_of(fig1_absent, fig2_octree, fig3_skip, fig4_hash, fig5_lost, fig6_topology)
