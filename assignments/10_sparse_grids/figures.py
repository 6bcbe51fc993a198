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

DPI = 220  # 7 inches wide gives 1540 pixels


def fig1_result(module: ModuleType) -> tuple[Figure, Facts]:
    """A held-out photograph; a sparse grid recovered from others; the same without dilation."""
    figure, found = parts.FIGURE_1.draw(module, parts.PHOTOGRAPHS)
    facts: Facts = {
        "with dilation more than 1 dB better": Fact(
            found["with dilation more than 1 dB better"], 1.0, 20.0, red="fit_never_grows"
        )
    }
    return figure, facts


def fig2_absent(module: ModuleType) -> tuple[Figure, Facts]:
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
    right.set(xlabel="σ of the new step, per unit of length", ylabel="loss")
    for axes in (left, right):
        plain_axes(axes)
    return figure, facts


def fig3_skip(module: ModuleType) -> tuple[Figure, Facts]:
    """Rays through the leaves of a slice, with samples and lookups; nodes by resolution."""
    n, count = 32, 64
    full = parts.shell(n)
    tree = module.octree_from_dense(full)
    first, stride = parts.rays_in_slice(n)
    asked = []

    def leaf(points: Array) -> tuple[Array, Array, Array]:
        asked.append(points)
        return module.octree_leaf(tree, n, points)

    wanted = module.skip_empty(leaf, first, stride, count)
    points = first[:, None] + np.arange(count)[:, None] * stride[:, None]
    right = full[tuple(np.moveaxis(np.floor(points).astype(int), 2, 0))]
    lookups = np.concatenate(asked)
    sizes = np.array([4, 8, 16, 32])
    shells = np.array([len(module.octree_from_dense(parts.shell(k))) for k in sizes])
    ones = np.array([len(module.octree_from_dense(parts.one_cell(k))) for k in sizes])
    facts: Facts = {
        "exactly the samples in full cells": Fact((wanted == right).all(), red="skip_one_too_far"),
        "fewer lookups than a third of the samples": Fact(
            len(lookups) / right.size, 0.01, 1 / 3, red="skip_each_sample"
        ),
        "one full cell costs 8 nodes per level": Fact(
            (ones == 1 + 8 * np.log2(sizes)).all(), red="octree_empty_cut"
        ),
        "a shell about four times as many with each doubling": Fact(
            shells[-1] / shells[-2], 3.4, 4.6, red="octree_never_merged"
        ),
    }
    figure, (left, axes) = subplots(7.0, 3.6, 1, 2, width_ratios=(1.25, 1))
    for low, side, is_full in parts.leaves_in_slice(module, tree, n, n // 2):
        color = "#f6dcc3" if is_full else "white"
        left.add_patch(Rectangle(low, side, side, facecolor=color, edgecolor=GRAY, linewidth=0.4))
    for ray, inside in zip(points, wanted, strict=True):
        left.plot(*ray[:, :2].T, ".", color=GRAY, markersize=2)
        left.plot(*ray[inside, :2].T, "o", color=CRIMSON, markersize=2.5)
    ring = {"markerfacecolor": "none", "markeredgecolor": BLUE, "linestyle": "none"}
    left.plot(*lookups[:, :2].T, "o", markersize=5.5, **ring)
    left.set(xlim=(0, n), ylim=(0, n), aspect="equal", xlabel="x  [cells]", ylabel="y  [cells]")
    for y, text, color, marker in (
        (sizes**3.0, "cells", INK, "^"),
        (shells, "nodes, shell", ORANGE, "o"),
        (ones, "nodes, one cell", BLUE, "s"),
    ):
        axes.loglog(sizes, y, color=color, marker=marker, markersize=4)
        note(axes, text, (n, y[-1]), (5, 0), va="center", color=color)
    axes.set(xlabel="cells along a side", xlim=(3.5, 220))
    axes.set_xticks(sizes, [str(k) for k in sizes])
    axes.minorticks_off()
    plain_axes(axes)
    return figure, facts


def fig4_lost(module: ModuleType) -> tuple[Figure, Facts]:
    """The derivative with respect to extinction of existing voxels, and of absent ones."""
    n = 16
    voxels, values = parts.ball_and_ring(n)
    rays = parts.cameras(12, 10)
    target = module.render(values, module.march(n, voxels, rays))
    # The guess lacks the ring: it has only the ball.
    ball = values[:, 0] > 0.6
    some, kept = voxels[ball], values[ball]
    samples = module.march(n, some, rays)
    before = module.render(kept, samples)
    _, d_kept = module.loss_and_grad(kept, samples, target)
    every = np.argwhere(np.ones((n, n, n), bool))
    at = some @ np.array([n * n, n, 1])
    # Next to existing voxels a new color would change samples: those new voxels are black.
    beside = module.prune_and_dilate(n, some, np.arange(len(some)), np.ones(len(some)), 0.0, 1)
    far = np.ones(n**3, bool)
    far[beside @ np.array([n * n, n, 1])] = False
    maps, pictures = [], []
    whole = module.march(n, every, rays)
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
    for axes in panels:
        parts.outlines(axes, n, [voxels[(values[:, 3] > 4) & each] for each in (ball, ~ball)])
    return figure, facts


def fig5_topology(module: ModuleType) -> tuple[Figure, Facts]:
    """PSNR of held-out photographs by the time of pruning, with and without dilation."""
    n, total, after = 16, 24, (3, 6, 12)
    rays, target = parts.training(n, 2)
    held_out = parts.PHOTOGRAPHS.read(parts.PHOTOGRAPHS.HELD_OUT)
    unseen, truth = parts.rays_of(parts.PHOTOGRAPHS.smaller(held_out, 32))
    every = np.argwhere(np.ones((n, n, n), bool))
    start = np.tile(module.START, (len(every), 1))

    def recovered(rounds: int, grow: int) -> float:
        """PSNR after all steps."""
        with parts.faster(module):
            voxels, values, _ = module.fit_sparse(
                n, every, start, rays, target, rounds, total // rounds, 0.05, grow
            )
        seen = module.render(values, module.march(n, voxels, unseen))
        return parts.decibels(seen, truth)

    scores = np.array([[recovered(total // steps, grow) for steps in after] for grow in (0, 1)])
    dense = recovered(1, 0)
    gap = scores[1] - scores[0]
    facts: Facts = {
        "pruned every 3 steps it loses more than 2 dB": Fact(
            gap[0], 2.0, 30.0, red="fit_never_prunes"
        ),
        "pruned later it loses less": Fact(gap[1:].max() < gap[0], red="fit_never_grows"),
        "dilated, it is better than all voxels": Fact(
            scores[1].min() - dense, 1.0, 10.0, red="fit_never_grows"
        ),
    }
    figure, axes = subplots(7.0, 2.6)
    axes.axhline(dense, color=GRAY, linestyle="--", linewidth=1)
    note(axes, "all voxels, never pruned", (after[1], dense), (0, -12))
    for values, color, name in zip(
        scores, (CRIMSON, BLUE), ("pruned", "pruned and dilated"), strict=True
    ):
        axes.plot(after, values, color=color, marker="o", markersize=4)
        note(axes, name, (after[-1], values[-1]), (8, -3), color=color)
    axes.set(
        xscale="log",
        xlabel="steps before each pruning (24 in all)",
        ylabel="PSNR of held-out\nphotographs [dB]",
        xlim=(2.7, 22),
    )
    axes.set_xticks(after, [str(k) for k in after])
    axes.minorticks_off()
    plain_axes(axes)
    return figure, facts


FIGURES = figures_of(fig1_result, fig2_absent, fig3_skip, fig4_lost, fig5_topology)
