"""The figures of assignment 12, and the facts that their captions claim."""

import figure_parts as parts
import numpy as np
from matplotlib.figure import Figure
from photograd_course.viz.handout import Fact, figures_of, note, subplots
from photograd_course.viz.style import BLUE, GRAY, INK, ORANGE, plain_axes
from photograd_course.viz.style import RED as CRIMSON

LARGE = 110  # pixels of the view of Figure 1


def fig1_view(module):
    """A held-out photograph, the same view from the network, normals; below, the training."""
    networks, unseen = parts.trained(module)
    place = parts.places(3, turn=1.7)[2]
    large, small = parts.photographs([place], LARGE), parts.photographs([place], 44)
    got = module.render(networks[-1], large)
    scores = [parts.decibels(module.render(each, unseen), unseen["colors"]) for each in networks]
    count = sum(array.size for layers in networks[-1].values() for array in layers)
    normals, opacity = parts.SCENE.normals(module, networks[-1], large)
    which = parts.nearest(large["origins"], large["directions"])[1]
    floor, fog = which == 3, (which == -1) & (opacity > 0.5)
    facts = {
        "above 25 dB": Fact(scores[-1], 25, 60),
        "8180 numbers": Fact(count, 8180, 8180),
        "normals of the floor point up": Fact(
            np.median(normals[floor & (opacity > 0.9)][:, 1]), 0.7, 1
        ),
        "there is fog before the background": Fact(np.sum(fog), 40, 5000),
        "it is white": Fact(np.abs(got[fog] - 1).mean(), 0, 0.06),
        "it gets better all the time": Fact(bool(np.all(np.diff(scores) > 0))),
        "the last 1500 steps gain more than 2 dB": Fact(scores[-1] - scores[-2], 2, 10),
    }
    shade = 1 - opacity[:, None] + opacity[:, None] * (0.5 + 0.5 * normals)
    figure = Figure(figsize=(7.0, 4.0), layout="constrained")
    grid = figure.add_gridspec(2, 15, height_ratios=(5, 3))
    shown = (
        ("held-out photograph", large["colors"] ** (1 / 2.2)),
        ("your network", np.clip(got, 0, 1) ** (1 / 2.2)),
        ("normals of its density", np.clip(shade, 0, 1)),
    )
    for k, (title, colors) in enumerate(shown):
        axes = figure.add_subplot(grid[0, 5 * k : 5 * k + 5])
        show(axes, colors.reshape(LARGE, LARGE, 3), title)
    for k, (mark, network) in enumerate(zip(parts.MARKS, networks, strict=True)):
        colors = np.clip(module.render(network, small), 0, 1) ** (1 / 2.2)
        title = f"{mark} steps: {scores[k]:.1f} dB"
        axes = figure.add_subplot(grid[1, 3 * k : 3 * k + 3])
        show(axes, colors.reshape(44, 44, 3), title)
        axes.set_title(title, fontsize=7.5)
    return figure, facts


def fig2_encoding(module):
    """A picture, and networks trained on its points with several numbers of bands."""
    n, bands = 64, (0, 2, 4, 6)
    picture = parts.photographs([np.array([1.5, 1.6, 2.2])], n)["colors"]
    fitted = [
        module.fit_picture(picture.reshape(n, n, 3), each, 300, np.random.default_rng(2), width=64)[
            0
        ]
        for each in bands
    ]
    scores = [parts.decibels(each.reshape(-1, 3), picture) for each in fitted]
    y, x = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
    p = np.stack([x.ravel() + 0.5, y.ravel() + 0.5], axis=1) / n * 2 - 1
    known, many = (x % 2 == 0).ravel(), (0, 2, 4, 6, 8, 10)
    errors = []
    for each in many:
        got = parts.fit_points(module, p, picture, known, each, 400)
        errors.append([parts.decibels(got[pick], picture[pick]) for pick in (known, ~known)])
    inside, between = np.array(errors).T
    facts = {
        "four bands are more than 8 dB better than none": Fact(
            scores[2] - scores[0], 8, 40, red="backward_no_relu"
        ),
        "at pixels in training up to six bands are better than fewer": Fact(
            inside[0] < inside[1] < inside[2] < inside[3], red="backward_no_relu"
        ),
        "between them ten bands are more than 5 dB worse than four": Fact(
            between[2] - between[5], 5, 40, red="encoding_bands_linear"
        ),
    }
    figure = Figure(figsize=(7.0, 3.9), layout="constrained")
    grid = figure.add_gridspec(2, 5, height_ratios=(1, 1.15))
    titles = ["truth"] + [f"L = {k}: {s:.1f} dB" for k, s in zip(bands, scores, strict=True)]
    for k, (title, colors) in enumerate(zip(titles, [picture, *fitted], strict=True)):
        light = np.clip(colors, 0, 1).reshape(n, n, 3) ** (1 / 2.2)
        show(figure.add_subplot(grid[0, k]), light, title)
    axes = figure.add_subplot(grid[1, :])
    axes.plot(many, inside, "o--", color=BLUE, markersize=4)
    axes.plot(many, between, "o-", color=ORANGE, markersize=4)
    note(axes, "pixels in training", (many[-1], inside[-1]), (-4, -14), color=BLUE, ha="right")
    note(axes, "pixels between them", (many[-1], between[-1]), (-4, 8), color=ORANGE, ha="right")
    axes.set(xlabel="bands L", ylabel="PSNR [dB]", xticks=many)
    plain_axes(axes)
    return figure, facts


def fig3_distances(module):
    """Density, weights and the distances of both passes on one ray."""
    near, far, rng = 2.0, 4.0, np.random.default_rng(5)

    def density(t):
        walls = ((t > 2.75) & (t < 2.95)) | ((t > 3.35) & (t < 3.6))
        return 0.05 + 25.0 * walls

    whole = np.array([[near, far]])
    coarse = module.sample_distances(whole, np.ones((1, 1)), rng.random((1, 16)))
    edges = module.edges_between(coarse, near, far)
    weights = module.ray_weights(density(coarse), np.diff(edges, axis=1))
    fine = module.sample_distances(edges, weights + module.PADDING, rng.random((1, 16)))
    largest = np.argsort(weights[0])[-2:]
    heads, tails = edges[0, largest], edges[0, largest + 1]
    around = np.sum((fine >= heads[:, None]) & (fine < tails[:, None]))
    parts_hit = np.floor((coarse[0] - near) / (far - near) * 16)
    behind = int(np.sum((fine > 3.35) & (fine < 3.6)))
    facts = {
        "one coarse distance in each of 16 parts": Fact(
            sorted(parts_hit.tolist()) == list(range(16)), red="distances_continuous"
        ),
        "more than half of the fine ones are in two intervals": Fact(
            around, 9, 16, red="distances_uniform"
        ),
        "the second wall gets none": Fact(behind, 0, 0, red="distances_uniform"),
    }
    figure, panels = subplots(7.0, 3.6, 3, 1, height_ratios=(1, 1, 0.7), sharex=True)
    t = np.linspace(near, far, 800)
    panels[0].fill_between(t, density(t), color=GRAY, linewidth=0)
    panels[0].set(ylabel="σ [1/m]")
    panels[1].bar(
        edges[0, :-1], weights[0], np.diff(edges[0]), align="edge", color=BLUE, edgecolor="white"
    )
    panels[1].set(ylabel="T α")
    for y, found, color in ((1, coarse, INK), (0, fine, ORANGE)):
        panels[2].plot(found[0], np.full(16, y), "|", color=color, markersize=13)
    panels[2].set(yticks=[0, 1], yticklabels=["fine", "coarse"], ylim=(-0.6, 1.6), xlabel="t [m]")
    panels[2].set_xlim(near, far)
    for axes in panels:
        plain_axes(axes)
        axes.set_axisbelow(True)
    return figure, facts


def fig4_field(module):
    """The two MLPs; density and color of one point as the direction turns."""
    network = module.make_network(64, 16, np.random.default_rng(4))
    angle = np.linspace(0, 2 * np.pi, 181)
    d = np.stack([np.cos(angle), 0 * angle, np.sin(angle)], axis=1)
    p = np.tile([[0.2, -0.1, 0.4]], (len(d), 1))
    sigma, color, trunk, head = module.radiance_field(network, p, d)
    widths = [each.shape[1] for each in (*trunk, *head)]
    facts = {
        "the density is the same in all directions": Fact(
            np.ptp(sigma), 0, 1e-12, red="field_density_sees_direction"
        ),
        "all colors change": Fact(
            np.ptp(color, axis=0).min(), 0.02, 1, red="field_direction_ignored"
        ),
        "the numbers are those of the drawing": Fact(
            widths == [27, 64, 64, 17, 31, 32, 3], held="widths are given"
        ),
    }
    figure, panels = subplots(7.0, 2.7, 1, 2, width_ratios=(1.45, 1))
    axes = panels[0]
    parts.box(axes, 0.0, 2.6, 1.6, "γ(p)\n27", "#dfe7f2")
    parts.box(axes, 2.4, 2.6, 2.4, "trunk\n64, 64", "#c6d6ea")
    parts.box(axes, 6.0, 2.6, 1.6, "σ\n1", "#f3dcc4")
    parts.box(axes, 2.9, 1.3, 1.4, "features\n16", "#dfe7f2")
    parts.box(axes, 0.0, 0.0, 1.6, "γ(d)\n15", "#dfe7f2")
    parts.box(axes, 2.4, 0.0, 2.4, "head\n32", "#c6d6ea")
    parts.box(axes, 6.0, 0.0, 1.6, "color\n3", "#f3dcc4")
    for start, end in (
        ((1.65, 2.6), (2.35, 2.6)),
        ((4.85, 2.6), (5.95, 2.6)),
        ((3.6, 2.2), (3.6, 1.7)),
        ((3.6, 0.9), (3.6, 0.4)),
        ((1.65, 0.0), (2.35, 0.0)),
        ((4.85, 0.0), (5.95, 0.0)),
    ):
        parts.arrow(axes, start, end)
    axes.set(xlim=(-0.2, 7.8), ylim=(-0.6, 3.2))
    axes.set_axis_off()
    turns = np.degrees(angle)
    for channel, paint in enumerate((CRIMSON, "#3a8f4a", BLUE)):
        panels[1].plot(turns, color[:, channel], color=paint)
    panels[1].plot(turns, sigma, color=INK, linewidth=2)
    note(panels[1], "σ [1/m]", (180, sigma[0]), (0, 5), color=INK, ha="center")
    panels[1].set(xlabel="direction [degrees]", xticks=(0, 90, 180, 270, 360))
    plain_axes(panels[1])
    return figure, facts


def show(axes, picture, title):
    axes.imshow(picture, interpolation="nearest")
    axes.set(xticks=[], yticks=[])
    axes.set_title(title)


FIGURES = figures_of(fig1_view, fig2_encoding, fig3_distances, fig4_field)
RED = {"fig1_view": "train_uphill"}
