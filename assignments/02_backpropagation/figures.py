"""Figures of the handout, each with the facts that its caption claims, computed by the engine.

`python figures.py` draws all of them into figures/.
"""

import figure_parts as parts
import numpy as np
from figure_parts import SMALL
from photograd_course.viz.handout import Fact, figures_of
from photograd_course.viz.style import GRAY, INK, ORANGE, new_figure, place_axes

WIDTH = parts.FIGURE_1.WIDTH


def fig1_engine(module):
    """(x + y) z with values, local derivatives and gradients; the gradient of an image."""
    figure, found = parts.FIGURE_1.draw(module)
    facts = {
        "the value is 35": Fact(found["the value is 35"], 35.0, 35.0),
        "the sum is 7 and its gradient 5": Fact(found["the sum is 7 and its gradient 5"]),
        "x and y get 5": Fact(found["x and y get 5"]),
        "z gets 7": Fact(found["z gets 7"], 7.0, 7.0),
        "negative where the image is too dark": Fact(found["negative where the image is too dark"]),
        "positive where it is too bright": Fact(found["positive where it is too bright"]),
        "with respect to pixels there are two values": Fact(
            found["with respect to pixels there are two values"]
        ),
        "with respect to texels there are more": Fact(
            found["with respect to texels there are more"]
        ),
        "their sums agree": Fact(found["their sums agree"], 1 - 1e-9, 1 + 1e-9),
        "it agrees with finite differences": Fact(
            found["it agrees with finite differences"], 1 - 1e-6, 1 + 1e-6
        ),
        "a step against it lowers the loss": Fact(
            found["a step against it lowers the loss"], 0.0, 0.9
        ),
    }
    return figure, facts


def fig2_cost(module):
    """Work for one gradient: against the number of inputs, and against the number of paths."""
    counts, backward, forward = [1, 4, 16, 64, 256], [], []
    for n in counts:
        root = sum((module.Value(0.1 * k) * 0.5 + 0.3) ** 2 for k in range(n))
        uses, gates = parts.recorded_uses(module, root)
        backward.append(uses)
        forward.append(gates)
    ladder, paths, rungs = [], [], [1, 2, 4, 6, 8, 10, 12]
    for k in rungs:
        bottom = module.Value(1.0)
        for _ in range(k):
            bottom = bottom**0.5 + bottom**0.25
        ladder.append(parts.recorded_uses(module, bottom)[0])
        paths.append(2**k)
    share = np.array(backward) / np.array(forward)
    figure = new_figure(WIDTH, 2.9)
    left = place_axes(figure, 0.65, 0.4, 2.45, 1.95)
    left.loglog(counts, 2.0 * np.array(counts), "s--", color=GRAY, ms=5, label="finite differences")
    left.loglog(counts, share, "o-", color=ORANGE, ms=5, label="backward")
    left.set(
        title="work for a gradient",
        xlabel="inputs",
        ylabel="operations per value",
        ylim=(0.3, 2000),
    )
    right = place_axes(figure, 3.95, 0.4, 2.45, 1.95)
    right.semilogy(rungs, paths, "s--", color=GRAY, ms=5, label="paths")
    right.semilogy(rungs, ladder, "o-", color=ORANGE, ms=5, label="contributions added")
    right.set(title="diamonds in a row", xlabel="diamonds", ylim=(1, 3e4), xticks=rungs)
    for axes in (left, right):
        axes.legend(loc="upper left", fontsize=SMALL)
        axes.tick_params(labelsize=SMALL)
        axes.grid(True, axis="y")
    facts = {
        "backward adds less than two contributions for each value": Fact(share.max() < 2.0),
        "and the number of inputs has little effect": Fact(share[-1] / share[1], 0.8, 1.25),
        "a diamond adds four contributions": Fact(np.allclose(ladder, 4 * np.array(rungs))),
        "twelve diamonds have over 50 times as many paths": Fact(paths[-1] > 50 * ladder[-1]),
    }
    return figure, facts


def fig3_order(module):
    """One graph, visited level by level and in the engine's order."""
    x = module.Value(2.0)
    a = x * x
    c = a * a
    b = c * c
    f = b + a
    nodes = {"x": x, "a": a, "c": c, "b": b, "f": f}
    own, gradients, ranks = module.topo_order, {}, {}
    for name, order in (("level by level", parts.levels), ("every user first", own)):
        module.topo_order = order
        try:
            module.backward(f)
        finally:
            module.topo_order = own
        place = {id(node): k + 1 for k, node in enumerate(order(f)[::-1])}
        ranks[name] = {key: place.get(id(node), 0) for key, node in nodes.items()}
        gradients[name] = {key: node.grad for key, node in nodes.items()}
    uses = (("x", "a"), ("a", "c"), ("c", "b"), ("b", "f"), ("a", "f"))
    h = 1e-5
    right = ((2 + h) ** 8 + (2 + h) ** 2 - (2 - h) ** 8 - (2 - h) ** 2) / (2 * h)
    figure = new_figure(WIDTH, 2.25)
    for left, name in ((0.0, "level by level"), (3.3, "every user first")):
        parts.draw_order(parts.graph_axes(figure, left, 0, 3.3, 2.25), name, uses, ranks, gradients)
    theirs, mine = ranks["level by level"], ranks["every user first"]
    facts = {
        "the engine's gradient agrees with finite differences": Fact(
            gradients["every user first"]["x"] / right, 1 - 1e-6, 1 + 1e-6
        ),
        "in the engine's order users come first": Fact(
            all(mine[end] < mine[at] for at, end in uses)
        ),
        "level by level a is visited before c, which uses it": Fact(theirs["a"] < theirs["c"]),
        "and x gets 4 only": Fact(gradients["level by level"]["x"], 4.0, 4.0),
        "a ends with 257 all the same": Fact(gradients["level by level"]["a"] == 257.0),
        "every user first x gets 1028": Fact(gradients["every user first"]["x"] == 1028.0),
    }
    return figure, facts


def fig4_uses_add_up(module):
    """(x + y) + x x: three uses of x, and the tangents of their sums."""
    x, y = module.Value(5.0), module.Value(4.0)
    total, square = x + y, x * x
    f = total + square
    module.backward(f)
    by_sum = sum(parts.slopes_of(total, x)) * total.grad
    by_square = [slope * square.grad for slope in parts.slopes_of(square, x)]
    figure = new_figure(WIDTH, 2.7)
    axes = parts.graph_axes(figure, 0, 0, 3.5, 2.7)
    places = {
        "x": (0.55, 0.95),
        "y": (0.55, 2.2),
        "+": (1.75, 1.75),
        "×": (1.75, 0.6),
        "f": (3.0, 1.2),
    }
    parts.arrow(axes, places["y"], places["+"])
    parts.arrow(axes, places["+"], places["f"])
    parts.arrow(axes, places["×"], places["f"])
    parts.arrow(axes, places["x"], places["+"], f"{by_sum:g}", color=ORANGE, lift=0.0)
    for bend, amount in zip((-0.35, 0.35), by_square, strict=True):
        parts.arrow(
            axes, places["x"], places["×"], f"{amount:g}", bend=-bend, color=ORANGE, lift=0.0
        )
    for name, node in (("x", x), ("y", y), ("+", total), ("×", square), ("f", f)):
        label = "+" if name == "f" else name
        parts.circle(axes, places[name], label, f"{node.data:g}", f"{node.grad:g}")
    plot = place_axes(figure, 4.15, 0.3, 2.3, 1.85)
    h = np.linspace(-2.0, 2.0, 41)
    plot.plot(5 + h, (5 + h + 4) + (5 + h) ** 2, color=INK, lw=2.2, label="f")
    for slope, color, style, name in (
        (x.grad, ORANGE, "--", f"slope {x.grad:g}, all uses"),
        (by_sum, GRAY, ":", f"slope {by_sum:g}, the sum alone"),
    ):
        plot.plot(5 + h, 34 + slope * h, style, color=color, lw=1.8, label=name)
    plot.set(xlabel="x, with y = 4", ylabel="f", xticks=[3, 4, 5, 6, 7], ylim=(8, 72))
    plot.legend(loc="upper left", fontsize=8, handlelength=1.6, borderaxespad=0.1)
    bend = max(abs((9 + s) + (5 + s) ** 2 - 34 - x.grad * s) for s in (-0.01, 0.01))
    facts = {
        "the value is 34": Fact(f.data, 34.0, 34.0),
        "the uses contribute 1, 5 and 5": Fact(by_sum == 1.0 and by_square == [5.0, 5.0]),
        "x gets 11": Fact(x.grad, 11.0, 11.0),
        "the tangent of slope 11 touches": Fact(bend < 2e-4),
        "a line of slope 1 cuts through": (
            Fact(34 - 0.1 * by_sum > 8.9 + 4.9**2 and 34 + 0.1 * by_sum < 9.1 + 5.1**2)
        ),
        "y gets 1": Fact(y.grad, 1.0, 1.0),
    }
    return figure, facts


FIGURES = figures_of(fig1_engine, fig2_cost, fig3_order, fig4_uses_add_up)
RED = {
    "fig1_engine": "product_no_swap",
    "fig2_cost": "order_with_repeats",
    "fig3_order": "order_breadth_first",
    "fig4_uses_add_up": "overwrite",
}
