"""The figures of assignment 13, and the facts that their captions claim."""

from __future__ import annotations

from types import ModuleType

import figure_parts as parts
import numpy as np
from matplotlib.figure import Figure
from photograd_course.viz.handout import Array, Fact, Facts, figures_of, note, subplots
from photograd_course.viz.style import BLUE, GRAY, INK, ORANGE, plain_axes
from photograd_course.viz.style import RED as CRIMSON


def fig1_equal_time(module: ModuleType) -> tuple[Figure, Facts]:
    """A picture, a network and a hash grid after equal times."""
    size, steps, batch = 144, 160, parts.TRAINING.BATCH
    target = module.julia(module.pixels(size))
    resolutions = parts.TRAINING.resolutions(size)
    ours, parameters = parts.hash_grid(module, target, resolutions, 2**14, steps, batch)
    octaves = parts.TRAINING.OCTAVES
    plain, weights = parts.plain_network(module, target, parts.SLOWER * steps, batch, octaves)
    scores = parts.decibels(plain, target), parts.decibels(ours, target)
    facts: Facts = {
        "the hash grid is better by more than 7 dB": Fact(
            scores[1] - scores[0], 7.0, 20.0, red="train_table_fixed"
        ),
        "it has more than ten times the parameters": Fact(
            parameters / module.numbers_per_point(weights), 10.0, 30.0, held="a count"
        ),
    }
    figure, panels = subplots(7.0, 4.85, 2, 3)
    titles = ("picture", f"network, {scores[0]:.1f} dB", f"hash grid, {scores[1]:.1f} dB")
    detail = slice(40, 76), slice(48, 84)
    for column, (colors, title) in enumerate(zip((target, plain, ours), titles, strict=True)):
        picture = parts.as_picture(colors)
        for axes, shown in zip(panels[:, column], (picture, picture[detail]), strict=True):
            axes.imshow(shown, interpolation="nearest")
            axes.set(xticks=[], yticks=[])
        panels[0, column].set_title(title)
    return figure, facts


def fig2_leaves(module: ModuleType) -> tuple[Figure, Facts]:
    """A network, the leaves that tabulate it, and the leaves after fine-tuning."""
    size, n, octaves = 128, 64, 5
    points = module.pixels(size)
    target = module.julia(points)
    plain, weights = parts.plain_network(module, target, 400, 1024, octaves)

    def field(where: Array) -> Array:
        return module.network(weights, module.frequencies(where, octaves))

    offsets = (np.stack(np.indices((2, 2)), axis=-1).reshape(-1, 2) + 0.5) / 2
    leaf, values = module.tabulate(field, n, offsets, 0.15)
    tuned = module.finetune(leaf, values, points, target, 60, 0.02)
    shown = [plain, *(module.read_leaves(leaf, each, points) for each in (values, tuned))]
    scores = [parts.decibels(each, target) for each in shown]
    facts: Facts = {
        "fewer than half as many leaves as cells": Fact(
            len(values) / n**2, 0.1, 0.5, red="leaves_never_merged"
        ),
        "tabulating loses less than half a dB": Fact(
            scores[0] - scores[1], -0.5, 0.5, red="cells_y_first"
        ),
        "fine-tuned more than 1 dB better than the network": Fact(
            scores[2] - scores[0], 1.0, 20.0, red="adam_only_positive"
        ),
    }
    figure, panels = subplots(7.0, 2.75, 1, 3)
    titles = ("network", f"{len(values)} leaves", "fine-tuned")
    edges = parts.outlines(leaf, 4)
    for axes, colors, title, score in zip(panels, shown, titles, scores, strict=True):
        picture = parts.as_picture(colors)
        if title.endswith("leaves"):
            picture = picture.repeat(2, axis=0).repeat(2, axis=1)
            picture = np.where(edges[..., None], 0.6 * picture + 0.2, picture)
        axes.imshow(picture, interpolation="nearest")
        axes.set(xticks=[], yticks=[], title=f"{title}, {score:.1f} dB")
    return figure, facts


def fig3_rows(module: ModuleType) -> tuple[Figure, Facts]:
    """The rows of the corners of a dense level and of a hashed one, and how many share each."""
    rows = 256
    dense = module.hash_index(parts.corner_list(16), 16, 17 * 17)
    hashed = module.hash_index(parts.corner_list(40), 40, rows)
    often = np.bincount(hashed, minlength=rows)
    shared = int(hashed[40 * 20 + 8])
    same = parts.corner_list(40)[hashed == shared]
    apart = np.abs(same[:, None] - same).max(axis=2)
    facts: Facts = {
        "dense: each corner has a row of its own": Fact(
            len(np.unique(dense)) == 17 * 17, red="hash_always"
        ),
        "hashed: they lie far apart": Fact(
            apart[apart > 0].min(initial=99), 3, 40, held="what a hash is for"
        ),
        "no row has more than three times the mean": Fact(
            often.max() / often.mean(), 1.0, 3.0, held="what a hash is for"
        ),
    }
    figure, (left, center, right) = subplots(7.0, 2.6, 1, 3)
    for axes, index, n in ((left, dense, 17), (center, hashed, 41)):
        axes.imshow(index.reshape(n, n), cmap="viridis", vmin=0, vmax=index.max())
        axes.set(xticks=[], yticks=[])
    left.set_title("dense: 17 x 17 corners")
    center.set_title("hashed: 41 x 41 corners")
    center.plot(*same.T, "s", markerfacecolor="none", markeredgecolor=CRIMSON, markersize=6)
    right.bar(np.arange(often.max() + 1), np.bincount(often), color=BLUE)
    right.set(xlabel="corners in a row", ylabel="rows", title="hashed: corners by row")
    plain_axes(right)
    right.set_axisbelow(True)
    return figure, facts


def fig4_interpolation(module: ModuleType) -> tuple[Figure, Facts]:
    """A level's feature by the nearest corner and interpolated, and its derivative along a line."""
    n, size, rows = 12, 120, 40
    levels = module.make_levels([n], 2, rows)
    table = np.random.default_rng(3).uniform(-1, 1, (rows, 1))
    points = module.pixels(size)
    blended = module.encode(points, table, levels)[:, 0]
    corner = np.floor(points * n + 0.5).astype(np.int64)
    nearest = table[module.hash_index(corner, n, rows), 0]
    x = (np.arange(601) + 0.5) / 601 * 0.5 + 0.2
    line = np.stack([x, np.full(len(x), 0.43)], axis=1)
    f = module.encode(line, table, levels)[:, 0]
    _, d = module.encode_backward(line, table, levels, np.ones((len(x), 1)))
    step = np.array([1e-6, 0])
    apart = (module.encode(line + step, table, levels) - module.encode(line - step, table, levels))[
        :, 0
    ]
    smooth = np.abs(x * n - np.round(x * n)) > 0.02
    jumps = np.abs(np.diff(d[:, 0])) > 1e-6
    facts: Facts = {
        "the feature is continuous": Fact(
            np.abs(np.diff(f)).max(), 1e-4, 0.05, red="encode_nearest"
        ),
        "the derivative is that of finite differences": Fact(
            np.abs(d[:, 0] - apart / 2e-6)[smooth].max(), 0, 1e-6, red="backward_points_unscaled"
        ),
        "it jumps at the faces and nowhere else": Fact(
            jumps.sum() == 6 and not jumps[smooth[1:] & smooth[:-1]].any(),
            red="encode_one_cell_less",
        ),
    }
    figure, panels = subplots(7.0, 2.55, 1, 3, width_ratios=(1, 1, 1.5))
    for axes, values, title in zip(
        panels, (nearest, blended), ("nearest", "interpolated"), strict=False
    ):
        axes.imshow(
            values.reshape(size, size), cmap="viridis", vmin=-1, vmax=1, extent=(0, 1, 1, 0)
        )
        axes.set(xticks=[], yticks=[], title=title)
    panels[1].plot([0.2, 0.7], [0.43, 0.43], "--", color="white", linewidth=1)
    right = panels[2]
    for face in np.arange(np.ceil(0.2 * n), 0.7 * n) / n:
        right.axvline(face, color=GRAY, linewidth=0.6)
    right.plot(x, f * n, color=BLUE)
    right.plot(x, d[:, 0], color=ORANGE, linewidth=1)
    right.plot(x[smooth][::18], (apart / 2e-6)[smooth][::18], ".", color=INK, markersize=3)
    note(right, "12 x feature", (0.7, f[-1] * n), (3, -2), color=BLUE)
    note(right, "∂/∂x", (0.7, d[-1, 0]), (3, -2), color=ORANGE)
    right.set(xlabel="x", xlim=(0.2, 0.86))
    plain_axes(right)
    return figure, facts


def fig5_shared(module: ModuleType) -> tuple[Figure, Facts]:
    """Where the terms of one row's derivative come from."""
    size, n, rows = 96, 48, 256
    points = module.pixels(size)
    target = module.julia(points)
    levels = module.make_levels([n], 2, rows)
    table = np.random.default_rng(4).uniform(-0.5, 0.5, (rows, 1))
    # The feature stands for the red channel: no decoder.
    g = 2 * (0.5 + module.encode(points, table, levels) - target[:, :1]) / len(points)
    d_table, _ = module.encode_backward(points, table, levels, g)
    # One point after the other: what it contributes to each row.
    mine = np.array(
        [
            module.encode_backward(points[k : k + 1], table, levels, g[k : k + 1])[0][:, 0]
            for k in range(len(points))
        ]
    )
    total = np.abs(mine).sum(axis=0)
    row = int(
        np.argmin(np.abs(d_table[:, 0]) / np.maximum(total, 1e-300) + (total < np.median(total)))
    )
    terms = mine[:, row]
    used = np.abs(terms) > 0
    corners = parts.corner_list(n)[module.hash_index(parts.corner_list(n), n, rows) == row]
    closest = np.abs(points[:, None] * n - corners).max(axis=2).argmin(axis=1)
    by_corner = np.bincount(closest, terms, len(corners))
    facts: Facts = {
        "the row gets the sum of its terms": Fact(
            abs(d_table[row, 0] - terms.sum()) / total[row],
            0,
            1e-12,
            red="backward_last_point_counts",
        ),
        "less than half of the sum of their absolute values": Fact(
            abs(d_table[row, 0]) / total[row], 0.0, 0.5, red="hash_never"
        ),
        "they come from several places": Fact(
            np.count_nonzero(by_corner), 4, 20, held="what sharing a row means"
        ),
    }
    figure, (left, right) = subplots(7.0, 3.3, 1, 2, width_ratios=(1, 1.2))
    left.imshow(0.5 + 0.5 * parts.as_picture(target), extent=(0, 1, 1, 0))
    color = np.where(terms[used] < 0, BLUE, CRIMSON)
    largest = np.abs(terms).max()
    left.scatter(*points[used].T, s=24 * np.abs(terms[used]) / largest + 1, c=color)
    left.set(xticks=[], yticks=[], title=f"{used.sum()} pixels read row {row}")
    ordered = np.sort(by_corner)
    right.bar(np.arange(len(ordered)), ordered, color=np.where(ordered < 0, BLUE, CRIMSON))
    right.bar(len(ordered) + 1, d_table[row, 0], color=INK)
    right.set_xticks([(len(ordered) - 1) / 2, len(ordered) + 1], ["one corner each", "sum"])
    right.set(ylabel="contribution to ∂L/∂row")
    plain_axes(right)
    right.set_axisbelow(True)
    return figure, facts


def fig6_size(module: ModuleType) -> tuple[Figure, Facts]:
    """PSNR by number of parameters, for a picture with detail everywhere and for a smooth one."""
    size, steps, batch, tables = 64, 100, 1024, (2**8, 2**10, 2**12)
    points = module.pixels(size)
    figure, panels = subplots(7.0, 2.9, 1, 2)
    drops, gains, ahead = [], [], []
    for axes, picture, name in zip(
        panels, (module.julia, parts.smooth), ("detail everywhere", "smooth"), strict=True
    ):
        target = picture(points)
        runs = [
            parts.hash_grid(module, target, (8, 16, 32, 64), most, steps, batch) for most in tables
        ]
        scores = np.array([parts.decibels(colors, target) for colors, _ in runs])
        counts = [count for _, count in runs]
        plain = [
            parts.plain_network(module, target, each * steps, batch)
            for each in (parts.SLOWER, 4 * parts.SLOWER)
        ]
        others = [parts.decibels(colors, target) for colors, _ in plain]
        parameters = module.numbers_per_point(plain[0][1])
        drops.append(np.diff(scores).max())
        gains.append(scores[-1] - others[0])
        ahead.append(others[1] - np.interp(np.log(parameters), np.log(counts), scores))
        axes.semilogx(counts, scores, color=BLUE, marker="o", markersize=4)
        note(axes, "hash grid", (counts[-1], scores[-1]), (-8, 2), ha="right", color=BLUE)
        for y, fill, text in zip(
            others, (ORANGE, "none"), ("network", "4 times the steps"), strict=True
        ):
            axes.semilogx(parameters, y, "s", color=ORANGE, markerfacecolor=fill, markersize=6)
            note(axes, text, (parameters, y), (-6, 5), ha="right", color=ORANGE)
        axes.set(title=name, xlabel="parameters", ylabel="PSNR  [dB]", xlim=(1500, 16000))
        axes.set_xticks([2000, 4000, 8000], ["2,000", "4,000", "8,000"])
        axes.minorticks_off()
        plain_axes(axes)
    facts: Facts = {
        "a fourth of the rows costs less than 6 dB": Fact(
            max(drops), 1.0, 6.0, red="train_table_fixed"
        ),
        "at equal time better by more than 6 dB": Fact(
            min(gains), 6.0, 30.0, red="train_table_fixed"
        ),
        "at equal size the network is better after four times the time, by less than 3 dB": Fact(
            max(ahead), 0.0, 3.0, red="train_table_fixed"
        ),
    }
    return figure, facts


FIGURES = figures_of(
    fig1_equal_time, fig2_leaves, fig3_rows, fig4_interpolation, fig5_shared, fig6_size
)
