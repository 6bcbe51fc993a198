"""Figure 1 of the handout, by your functions: a picture, and what its caption claims."""

import math

import numpy as np
from matplotlib.patches import FancyArrowPatch
from photograd_course.viz.style import (
    BLUE,
    FRAME,
    INK,
    ORANGE,
    new_figure,
    place_axes,
    signed_color_map,
)

TEXT = 9.0  # points: 11 pixels where the figure is shown 600 pixels wide


SMALL = 8.5


def graph_axes(figure, left, top, width, height):
    """Axes without frame; one unit is one inch, y downwards."""
    axes = place_axes(figure, left, top, width, height)
    axes.set(xlim=(0, width), ylim=(height, 0))
    axes.axis("off")
    return axes


def circle(axes, at, label, value="", gradient=""):
    """A node: its label inside, its value above and its gradient below."""
    box = {"boxstyle": "circle,pad=0.35", "fc": "white", "ec": INK, "lw": 1.4}
    axes.text(*at, label, ha="center", va="center", fontsize=TEXT + 1.5, zorder=4, bbox=box)
    bold = {"ha": "center", "fontsize": TEXT, "fontweight": "bold"}
    axes.text(at[0], at[1] - 0.27, value, va="bottom", color=BLUE, **bold)
    axes.text(at[0], at[1] + 0.27, gradient, va="top", color=ORANGE, **bold)


def arrow(axes, start, end, label="", bend=0.0, color=FRAME, where=0.5, lift=-0.1):
    """An arrow from an input to its user, with a label beside it."""
    axes.add_patch(
        FancyArrowPatch(
            start,
            end,
            connectionstyle=f"arc3,rad={bend}",
            arrowstyle="-|>",
            mutation_scale=10,
            shrinkA=13,
            shrinkB=13,
            lw=1.1,
            color=color,
            zorder=1,
        )
    )
    if label:
        x = start[0] + where * (end[0] - start[0])
        # The middle of an arc lies half its bend to the side of the chord (y points down).
        y = start[1] + where * (end[1] - start[1]) - bend * 0.5 * (end[0] - start[0]) + lift
        axes.text(
            x,
            y,
            label,
            ha="center",
            va="center",
            fontsize=SMALL,
            color=color,
            bbox={"fc": "white", "ec": "none", "pad": 0.6},
            zorder=2,
        )


def key(axes, x, y):
    """Which number is which."""
    axes.text(x, y, "value", color=BLUE, fontsize=TEXT, fontweight="bold")
    axes.text(x, y + 0.22, "gradient", color=ORANGE, fontsize=TEXT, fontweight="bold")
    axes.text(x, y + 0.44, "× local derivative", color=FRAME, fontsize=TEXT)


def first_slope(user, source):
    found = slopes_of(user, source)
    return found[0] if found else math.nan


def slopes_of(user, source):
    """Local derivatives stored by `user` for each of its uses of `source`."""
    return [slope for node, slope in user.inputs if node is source]


def draw_worked_graph(axes, nodes):
    """(x + y) z, with values, gradients and local derivatives."""
    at = {"x": (0.9, 0.45), "y": (0.9, 1.65), "+": (2.6, 1.05), "z": (2.6, 2.15), "×": (4.3, 1.55)}
    for start, end in (("x", "+"), ("y", "+"), ("+", "×"), ("z", "×")):
        slope = first_slope(nodes[end], nodes[start])
        arrow(axes, at[start], at[end], f"× {slope:g}", lift=0.0)
    for name, node in nodes.items():
        circle(axes, at[name], name, f"{node.data:g}", f"{node.grad:g}")
    key(axes, 5.0, 0.35)


def picture_and_gradients(module):
    """A gray image, its target, the derivatives of its error, and the image after a step."""
    row, column = np.mgrid[0:24, 0:32]
    dark = (row - 11.5) ** 2 + (column - 15.5) ** 2 < 68
    target = 0.2 + 0.6 * dark
    start = np.full(target.shape, 0.45)

    def loss_of(numbers):
        leaves = np.array([module.Value(t) for t in numbers.flat]).reshape(numbers.shape)
        padded = np.pad(leaves, ((0, 0), (1, 1)), "edge")
        seen = 0.25 * padded[:, :-2] + 0.5 * padded[:, 1:-1] + 0.25 * padded[:, 2:]
        return np.sum((seen - target) ** 2), leaves, seen

    loss, leaves, seen = loss_of(start)
    module.backward(loss)
    by_pixel, by_texel = (np.vectorize(lambda v: v.grad)(each) for each in (seen, leaves))
    after = start - 0.2 * by_texel
    step = np.zeros(start.shape)
    step[11, 8] = 1e-5
    slope = (loss_of(start + step)[0].data - loss_of(start - step)[0].data) / 2e-5
    return {
        "start": start,
        "target": target,
        "dark": dark,
        "by_pixel": by_pixel,
        "by_texel": by_texel,
        "after": after,
        "checked": by_texel[11, 8] / slope,
        "fall": loss_of(after)[0].data / loss.data,
    }


WIDTH = 7.0  # inches


def draw(module):
    """(x + y) z with values, local derivatives and gradients; the gradient of an image."""
    x, y, z = module.Value(3.0), module.Value(4.0), module.Value(5.0)
    a = x + y
    f = a * z
    module.backward(f)
    picture = picture_and_gradients(module)
    by_pixel, by_texel, dark = picture["by_pixel"], picture["by_texel"], picture["dark"]
    figure = new_figure(WIDTH, 4.3)
    axes = graph_axes(figure, 0.4, 0, 6.0, 2.6)
    draw_worked_graph(axes, {"x": x, "y": y, "z": z, "+": a, "×": f})
    top = float(np.abs(by_pixel).max()) or 1.0
    signed = {"cmap": signed_color_map(), "vmin": -top, "vmax": top}
    gray = {"cmap": "gray", "vmin": 0, "vmax": 1}
    shown = (
        ("texels", picture["start"], gray),
        ("target", picture["target"], gray),
        ("∂L / ∂ pixels", by_pixel, signed),
        ("∂L / ∂ texels", by_texel, signed),
        ("after one step", picture["after"], gray),
    )
    for k, (name, values, colors) in enumerate(shown):
        axes = place_axes(figure, 0.05 + 1.39 * k, 2.9, 1.34, 1.005)
        image = axes.imshow(values, interpolation="nearest", **colors)
        axes.set(xticks=[], yticks=[], title=name)
        if name == "∂L / ∂ texels":
            bar = place_axes(figure, 3.2, 4.0, 2.0, 0.08)
            figure.colorbar(image, cax=bar, orientation="horizontal", ticks=[-0.5, 0, 0.5])
    claims = {
        "the value is 35": f.data,
        "the sum is 7 and its gradient 5": a.data == 7.0 and a.grad == 5.0,
        "x and y get 5": x.grad == 5.0 and y.grad == 5.0,
        "z gets 7": z.grad,
        "negative where the image is too dark": (by_texel[dark] < 0).all(),
        "positive where it is too bright": (by_texel[[0, -1]] > 0).all(),
        "with respect to pixels there are two values": len(np.unique(by_pixel.round(12))) == 2,
        "with respect to texels there are more": len(np.unique(by_texel.round(12))) > 2,
        "their sums agree": by_texel.sum() / by_pixel.sum(),
        "it agrees with finite differences": picture["checked"],
        "a step against it lowers the loss": picture["fall"],
    }
    return figure, claims
