"""What the figures of assignment 02 draw: scenes, measurements, pieces of pictures."""

from photograd_course.build.kit_module import kit_module
from photograd_course.viz.style import FRAME
from photograd_course.viz.style import RED as DARK_RED

FIGURE_1 = kit_module("02_backpropagation", "figure_1")
TEXT = FIGURE_1.TEXT
SMALL = FIGURE_1.SMALL
graph_axes = FIGURE_1.graph_axes
circle = FIGURE_1.circle
arrow = FIGURE_1.arrow
slopes_of = FIGURE_1.slopes_of


def recorded_uses(module, root):
    """The number of contributions that `backward` adds, and the number of values."""
    order = module.topo_order(root)
    return sum(len(node.inputs) for node in order), len(order)


def levels(root):
    """Level by level from the root: the order that fails, root last."""
    order, seen = [root], {root}
    for node in order:
        for source, _ in node.inputs:
            if source not in seen:
                seen.add(source)
                order.append(source)
    return order[::-1]


def draw_order(axes, name, uses, ranks, gradients):
    at = {"x": (0.4, 1.55), "a": (1.02, 1.55), "c": (1.65, 0.9), "b": (2.27, 0.9), "f": (2.9, 1.55)}
    made = {"x": "x = 2", "a": "a = x²", "c": "c = a²", "b": "b = c²", "f": "b + a"}
    rank = ranks[name]
    axes.text(1.65, 0.2, name, ha="center", fontsize=TEXT + 1)
    for start, end in uses:
        late = rank[end] > rank[start]
        arrow(axes, at[start], at[end], color=DARK_RED if late else FRAME)
        if late:
            axes.text(1.16, 1.12, "late", ha="right", fontsize=SMALL, color=DARK_RED)
    for key_, place in at.items():
        circle(axes, place, f"{rank[key_]}", "", f"{gradients[name][key_]:g}")
        axes.text(place[0], place[1] - 0.27, made[key_], ha="center", fontsize=SMALL)
